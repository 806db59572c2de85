#pragma once

#include "modules/scene/nodes.h"

#include <glm/glm.hpp>

#include <map>
#include <vector>

namespace gnomon {

/// World transforms of the nodes that have a file index: by Node3D::file_index, the first in tree
/// order.
using WorldTransforms = std::map<int, glm::dmat4>;
WorldTransforms compute_world_transforms(const Node3D &p_root);

/// Where a skin puts a mesh: the frame that moves it as a whole, and a matrix per joint within that
/// frame. A skinned mesh follows its joints, wherever its node is (glTF 2.0, 3.7.3.3).
struct SkinTransforms {
	glm::dmat4 world_from_mesh = glm::dmat4(1.0);
	std::vector<glm::dmat4> joints; // see deform_vertices
};
/// Computes the transforms. If the frame was removed or has no inverse, the world replaces it; a
/// removed joint stays at rest in the frame.
SkinTransforms compute_skin_transforms(
		const Skin &p_skin, const WorldTransforms &p_world_from_nodes);

/// Transforms of a surface of the node: those of its skin if it has joints; otherwise the node's
/// own, without joints.
SkinTransforms compute_surface_transforms(const MeshInstance3D &p_node, const Mesh &p_mesh,
		const glm::dmat4 &p_world_from_node, const WorldTransforms &p_world_from_nodes);

} // namespace gnomon
