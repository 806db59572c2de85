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

/// The node hierarchy of a file.
struct GltfTree {
	static constexpr size_t NONE = SIZE_MAX;
	std::vector<size_t> parents; // by node; NONE for a root
	std::vector<std::vector<size_t>> children;
	std::vector<size_t> roots;
};

/// Builds the tree. A node with two parents, a cycle or too deep a nesting is an Error, even
/// outside the scene that is loaded.
GltfTree build_gltf_tree(const tinygltf::Model &p_model, const GltfMessages &p_messages);

/// Reads a node's translation, rotation and scale; missing ones are 0, identity and 1.
NodeTransform read_parts(const tinygltf::Node &p_node);
/// Reads a node's matrix, or composes its translation, rotation and scale.
glm::dmat4 read_transform(const tinygltf::Node &p_node);

/// Writes a node's changed transform. It stays translation, rotation and scale if they can express
/// it (animations and people need them); otherwise it becomes a matrix. Not finite: an Error.
void write_transform(const Node3D &p_node, const glm::dmat4 &p_before, tinygltf::Node &r_written);

constexpr char BLENDER_ORIENTATION[] = "_Orientation";

/// Finds the node that has the properties of a Blender light. Blender's older exporters put the
/// light of an object "Lamp" into a child "Lamp_Orientation", because glTF's lights point along
/// another axis, and leave the object's properties on "Lamp". Returns that node if p_index is such
/// a child.
std::optional<size_t> find_blender_owner(
		size_t p_index, const GltfTree &p_tree, const tinygltf::Model &p_model);

} // namespace gnomon
