#pragma once

#include "modules/scene/nodes.h"

#include <glm/glm.hpp>

#include <map>
#include <vector>

namespace gnomon {

/// Of each node that has an index in its file: by Node3D::file_index, the first in tree order.
using WorldTransforms = std::map<int, glm::dmat4>;
WorldTransforms compute_world_transforms(const Node3D &p_root);

/// Where a skin puts a mesh: in the frame that moves it whole, with a matrix for each joint there.
/// A skin's mesh is where its joints are, wherever its node is (glTF 2.0, 3.7.3.3).
struct SkinTransforms {
	glm::dmat4 world_from_mesh = glm::dmat4(1.0);
	std::vector<glm::dmat4> joints; // see deform_vertices
};
/// A frame that is not there any more, or has no inverse, is the world; a joint that is not there
/// any more rests in the frame.
SkinTransforms compute_skin_transforms(
		const Skin &p_skin, const WorldTransforms &p_world_from_nodes);

/// Where a surface of the node is: with its skin where it has joints, else where the node is, with
/// no joints.
SkinTransforms compute_surface_transforms(const MeshInstance3D &p_node, const Mesh &p_mesh,
		const glm::dmat4 &p_world_from_node, const WorldTransforms &p_world_from_nodes);

} // namespace gnomon
