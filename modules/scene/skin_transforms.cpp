#include "modules/scene/skin_transforms.h"

#include "modules/scene/mesh_rig.h"

#include <cmath>

namespace gnomon {

namespace {

void add_transforms(const Node3D &p_node, const glm::dmat4 &p_world_from_parent,
		WorldTransforms &r_transforms) {
	const glm::dmat4 world_from_node = p_world_from_parent * p_node.get_parent_from_node();
	if (p_node.file_index >= 0) {
		r_transforms.emplace(p_node.file_index, world_from_node);
	}
	for (const std::unique_ptr<Node3D> &child : p_node.children) {
		add_transforms(*child, world_from_node, r_transforms);
	}
}

bool has_inverse(const glm::dmat4 &p_matrix) {
	const double volume = glm::determinant(glm::dmat3(p_matrix));
	return volume != 0 && std::isfinite(1.0 / volume);
}

} // namespace

WorldTransforms compute_world_transforms(const Node3D &p_root) {
	WorldTransforms transforms;
	add_transforms(p_root, glm::dmat4(1.0), transforms);
	return transforms;
}

SkinTransforms compute_skin_transforms(
		const Skin &p_skin, const WorldTransforms &p_world_from_nodes) {
	SkinTransforms transforms;
	const auto frame = p_world_from_nodes.find(p_skin.frame);
	if (frame != p_world_from_nodes.end() && has_inverse(frame->second)) {
		transforms.world_from_mesh = frame->second;
	}
	const glm::dmat4 mesh_from_world = glm::inverse(transforms.world_from_mesh);
	transforms.joints.reserve(p_skin.joints.size());
	for (size_t index = 0; index < p_skin.joints.size(); ++index) {
		const auto joint = p_world_from_nodes.find(p_skin.joints[index]);
		// Vertices of a removed joint stay at rest.
		transforms.joints.push_back(joint == p_world_from_nodes.end()
						? glm::dmat4(1.0)
						: mesh_from_world * joint->second * p_skin.joint_from_mesh[index]);
	}
	return transforms;
}

SkinTransforms compute_surface_transforms(const MeshInstance3D &p_node, const Mesh &p_mesh,
		const glm::dmat4 &p_world_from_node, const WorldTransforms &p_world_from_nodes) {
	const MeshRig *rig = p_mesh.attributes.rig.get();
	return p_node.skin && rig && rig->joint_count > 0
			? compute_skin_transforms(*p_node.skin, p_world_from_nodes)
			: SkinTransforms{ p_world_from_node, {} };
}

} // namespace gnomon
