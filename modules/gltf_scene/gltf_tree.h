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

/// The node hierarchy of a file. All values are node indices.
struct GltfTree {
	static constexpr size_t NONE = SIZE_MAX;
	std::vector<size_t> parents;			   // by node; NONE for a root
	std::vector<std::vector<size_t>> children; // by node
	std::vector<size_t> roots;
};

/// Builds the tree. Throws an Error if a node has two parents, if there is a cycle or if nodes are
/// nested too deep (GLTF_MAX_NODE_DEPTH), also for nodes that are not in the loaded scene.
GltfTree build_gltf_tree(const tinygltf::Model &p_model, const GltfMessages &p_messages);

/// Reads a node's translation, rotation and scale; missing ones are 0, identity and 1.
NodeTransform read_node_transform(const tinygltf::Node &p_node);
/// Reads a node's matrix, whose last row is taken as 0 0 0 1, or composes its translation, rotation
/// and scale.
glm::dmat4 read_transform(const tinygltf::Node &p_node);

/// Writes a node's changed transform. Unless the node had a matrix, it is written as translation,
/// rotation and scale if these can represent it, because animations need them and people can read
/// them; otherwise as a matrix. p_before: the transform as loaded. Throws an Error if the transform
/// is not finite.
void write_transform(const Node3D &p_node, const glm::dmat4 &p_before, Json &r_target);

/// Suffix that older Blender exporters give the child node of a light; see find_blender_owner.
constexpr char BLENDER_ORIENTATION[] = "_Orientation";

/// Returns the node whose extras hold the properties of a light from Blender. Older exporters store
/// the light of an object "Lamp" in a child node "Lamp_Orientation", because glTF's lights point
/// along another axis, and the object's properties in the node "Lamp". Returns the parent if
/// p_index is such a child, otherwise nothing.
std::optional<size_t> find_blender_owner(
		size_t p_index, const GltfTree &p_tree, const tinygltf::Model &p_model);

} // namespace gnomon
