#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/scene/node_transform.h"
#include "modules/scene/nodes.h"

#include <glm/glm.hpp>
#include <tiny_gltf.h>

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

/// A node with two parents, a cycle or too deep a nesting, also where no scene looks: an Error.
GltfTree build_gltf_tree(const tinygltf::Model &p_model, const GltfMessages &p_messages);

/// A node's translation, rotation and scale; those that it does not have are 0, none and 1.
NodeTransform read_parts(const tinygltf::Node &p_node);
/// Its matrix, or those parts.
glm::dmat4 read_transform(const tinygltf::Node &p_node);

/// Writes a node's changed transform. Translation, rotation and scale stay apart where they can
/// express it (animations and people need them), else it becomes a matrix. Not finite: an Error.
void write_transform(const Node3D &p_node, const glm::dmat4 &p_before, tinygltf::Node &r_written);

constexpr char BLENDER_ORIENTATION[] = "_Orientation";

/// Blender's older exporters hang the light of an object "Lamp" below it as "Lamp_Orientation", as
/// glTF's lights look elsewhere than Blender's, and leave the object's properties on "Lamp". That
/// node, if p_index is such a child.
std::optional<size_t> find_blender_owner(
		size_t p_index, const GltfTree &p_tree, const tinygltf::Model &p_model);

} // namespace gnomon
