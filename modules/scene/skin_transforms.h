#pragma once

#include "modules/scene/nodes.h"

#include <glm/glm.hpp>

#include <map>
#include <vector>

namespace gnomon {

/// World transforms of the nodes that have a Node3D::file_index, by that index. If several nodes
/// have the same one, the first in tree order counts.
using WorldTransforms = std::map<int, glm::dmat4>;
/// Computes the transforms of all nodes below the root, as posed.
WorldTransforms compute_world_transforms(const Node3D &p_root);

/// The transforms of a skinned mesh: that of the node that moves it as a whole (Skin::frame), and a
/// matrix per joint relative to that node. The mesh follows its joints, wherever its own node is
/// (glTF 2.0, 3.7.3.3).
struct SkinTransforms {
	glm::dmat4 world_from_mesh = glm::dmat4(1.0);
	std::vector<glm::dmat4> joints; // see deform_vertices
};
/// Computes the transforms of a skin. If that node was removed or has no inverse, the world
/// replaces it; vertices of a removed joint stay at rest.
SkinTransforms compute_skin_transforms(
		const Skin &p_skin, const WorldTransforms &p_world_from_nodes);

/// Computes the transforms of a surface of a node: those of the skin if the mesh has joints;
/// otherwise the node's own, without joints.
SkinTransforms compute_surface_transforms(const MeshInstance3D &p_node, const Mesh &p_mesh,
		const glm::dmat4 &p_world_from_node, const WorldTransforms &p_world_from_nodes);

} // namespace gnomon
