#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/scene/nodes.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace gnomon {

/// How a file's nodes hang together.
struct GltfTree {
	static constexpr size_t NONE = SIZE_MAX;
	std::vector<size_t> parents; // by node; NONE at a root
	std::vector<std::vector<size_t>> children;
	std::vector<size_t> roots;
};

/// Fails on an index that does not exist, a node with two parents, a cycle and too deep a nesting,
/// also where no scene looks.
GltfTree build_gltf_tree(const GltfObject &p_root);

/// A node's matrix, or its translation, rotation and scale. Not finite: fails.
glm::dmat4 read_transform(const GltfObject &p_node);

/// Writes a node's changed transform. Translation, rotation and scale are kept apart where they can
/// say it (animations and people need them), else it becomes a matrix. Not finite: an Error.
void write_transform(const Node3D &p_node, const glm::dmat4 &p_before, Json &r_json);

constexpr char BLENDER_ORIENTATION[] = "_Orientation";

/// Blender's older exporters hang the light of an object "Lamp" below it as "Lamp_Orientation", as
/// glTF's lights look elsewhere than Blender's, and leave the object's properties on "Lamp". That
/// node, if p_index is such a child.
std::optional<size_t> find_blender_owner(
		size_t p_index, const GltfTree &p_tree, const GltfObject &p_root);

} // namespace gnomon
