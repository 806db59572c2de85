// build_snapshot: reads what one frame needs from a scene's tree.

#include "modules/scene/scene_tree_reader.h"

#include "modules/core/error.h"
#include "modules/core/finite.h"
#include "modules/scene/mesh_pose.h"
#include "modules/scene/skin_transforms.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gnomon {

namespace {

const double MIN_SCENE_SIZE_M = 1e-9; // S is a divisor, also in a scene of one point

/// Fills the snapshot from the tree. Passes the world transform down, because
/// Node3D::compute_world_from_node would walk up to the root for each node.
class TreeReader {
public:
	/// p_is_posed: false = the scene at rest, without its animations; only used for the scene size.
	/// r_posed: null = not wanted.
	TreeReader(SceneSnapshot &r_snapshot, bool p_is_posed, PosedParts *r_posed) :
			snapshot(r_snapshot), posed(r_posed), is_posed(p_is_posed) {}

	void read(const Node3D &p_root) {
		read_node(p_root, glm::dmat4(1.0), /*p_is_moving=*/false);
		if (!deformable.empty()) {
			find_joints(p_root, glm::dmat4(1.0));
		}
		if (posed) {
			posed->has_deformable = !deformable.empty();
		}
		for (const auto &[node, world_from_node] : deformable) {
			read_deformable(*node, world_from_node);
		}
	}
	bool has_animated_nodes() const { return is_animated; }

private:
	SceneSnapshot &snapshot;
	PosedParts *posed;
	bool is_posed;
	bool is_animated = false;
	std::vector<std::pair<const MeshInstance3D *, glm::dmat4>> deformable; // and world_from_node
	WorldTransforms world_from_nodes;

	glm::dmat4 compute_world_from_node(
			const Node3D &p_node, const glm::dmat4 &p_world_from_parent) const {
		return p_world_from_parent *
				(is_posed ? p_node.get_parent_from_node() : p_node.parent_from_node);
	}

	/// Fills world_from_nodes, which only scenes with deformable meshes need.
	void find_joints(const Node3D &p_node, const glm::dmat4 &p_world_from_parent) {
		const glm::dmat4 world_from_node = compute_world_from_node(p_node, p_world_from_parent);
		if (p_node.file_index >= 0) {
			world_from_nodes.emplace(p_node.file_index, world_from_node);
		}
		for (const std::unique_ptr<Node3D> &child : p_node.children) {
			find_joints(*child, world_from_node);
		}
	}

	/// p_is_moving: an ancestor is posed.
	void read_node(const Node3D &p_node, const glm::dmat4 &p_world_from_parent, bool p_is_moving) {
		is_animated = is_animated || p_node.posed_parent_from_node;
		const bool is_moving = p_is_moving || p_node.posed_parent_from_node;
		const glm::dmat4 world_from_node = compute_world_from_node(p_node, p_world_from_parent);
		check_transform(p_node, world_from_node);
		if (const auto *light = dynamic_cast<const Light3D *>(&p_node)) {
			if (posed && is_moving) {
				const auto index = static_cast<uint32_t>(snapshot.lights.size());
				posed->lights.push_back({ light, world_from_node, index });
			}
			snapshot.lights.push_back(build_light_snapshot(*light, world_from_node));
		} else if (const auto *instance = dynamic_cast<const MeshInstance3D *>(&p_node)) {
			const auto first = static_cast<uint32_t>(snapshot.instances.size());
			read_surfaces(*instance, world_from_node);
			const auto count = static_cast<uint32_t>(snapshot.instances.size()) - first;
			if (posed && is_moving && count > 0) {
				posed->instances.push_back({ instance, world_from_node, first, count });
			}
		}
		for (const std::unique_ptr<Node3D> &child : p_node.children) {
			read_node(*child, world_from_node, is_moving);
		}
	}

	void read_surfaces(const MeshInstance3D &p_node, const glm::dmat4 &p_world_from_node) {
		is_animated = is_animated || p_node.posed_morph_weights;
		bool is_deformable = false;
		for (const MeshInstance3D::Surface &surface : p_node.surfaces) {
			if (!surface.mesh || surface.mesh->indices.empty()) {
				continue;
			}
			if (surface.mesh->attributes.rig) {
				is_deformable = true;
				continue;
			}
			add_instance(p_node, surface, p_world_from_node);
		}
		if (is_deformable) {
			deformable.emplace_back(&p_node, p_world_from_node);
		}
	}

	void read_deformable(const MeshInstance3D &p_node, const glm::dmat4 &p_world_from_node) {
		for (const MeshInstance3D::Surface &surface : p_node.surfaces) {
			if (!surface.mesh || surface.mesh->indices.empty() || !surface.mesh->attributes.rig) {
				continue;
			}
			SkinTransforms transforms = compute_surface_transforms(
					p_node, *surface.mesh, p_world_from_node, world_from_nodes);
			const std::vector<float> &weights =
					is_posed ? p_node.get_morph_weights() : p_node.morph_weights;
			const std::string object = text("Node \"", p_node.name, "\"");
			InstanceSnapshot &instance = add_instance(p_node, surface, transforms.world_from_mesh);
			if (is_posed) {
				const std::shared_ptr<PoseSlot> slot = p_node.get_pose_slot(surface.mesh);
				instance.set_pose(
						slot, slot->make_pose(std::move(transforms.joints), weights, object));
			} else {
				const MeshPose pose(surface.mesh, std::move(transforms.joints), weights, object);
				instance.bounds_world =
						transform_bounds(pose.get_bounds(), instance.world_from_node);
			}
		}
	}

	InstanceSnapshot &add_instance(const MeshInstance3D &p_node,
			const MeshInstance3D::Surface &p_surface, const glm::dmat4 &p_world_from_node) {
		snapshot.instances.push_back(
				make_instance(p_surface.mesh, p_surface.material, p_world_from_node, p_node.name));
		InstanceSnapshot &instance = snapshot.instances.edit_back();
		instance.casts_shadow = instance.casts_shadow && p_node.casts_shadow;
		instance.is_planar_receiver = p_node.is_planar_receiver;
		return instance;
	}
};

} // namespace

void check_transform(const Node3D &p_node, const glm::dmat4 &p_world_from_node) {
	if (!is_finite(p_world_from_node)) {
		fail("Node \"", p_node.name, "\": its transform to the world is not finite. Correct it or ",
				"one of its parents' transforms.");
	}
}

CameraSnapshot build_camera_snapshot(const Camera3D &p_camera) {
	const glm::dmat4 world_from_node = p_camera.compute_world_from_node();
	check_transform(p_camera, world_from_node);
	CameraSnapshot snapshot;
	snapshot.name = p_camera.name;
	snapshot.position_world = glm::dvec3(world_from_node[3]);
	snapshot.world_from_camera = compute_orientation(world_from_node, "Camera", p_camera.name);
	snapshot.vertical_fov_rad = p_camera.vertical_fov_rad;
	snapshot.near_m = p_camera.near_m;
	return snapshot;
}

LightSnapshot build_light_snapshot(const Light3D &p_light, const glm::dmat4 &p_world_from_node) {
	check_transform(p_light, p_world_from_node);
	LightSnapshot snapshot;
	static_cast<LightSettings &>(snapshot) = p_light;
	snapshot.name = p_light.name;
	snapshot.position_world = glm::dvec3(p_world_from_node[3]);
	snapshot.world_from_light = compute_orientation(p_world_from_node, "Light", p_light.name);
	snapshot.file_path = p_light.file_path;
	return snapshot;
}

std::shared_ptr<const SceneSnapshot> build_snapshot(
		const Scene &p_scene, const Camera3D &p_camera) {
	return read_scene_tree(p_scene, p_camera, /*r_posed=*/nullptr);
}

std::shared_ptr<const SceneSnapshot> read_scene_tree(
		const Scene &p_scene, const Camera3D &p_camera, PosedParts *r_posed) {
	auto snapshot = std::make_shared<SceneSnapshot>();
	snapshot->camera = build_camera_snapshot(p_camera);
	TreeReader reader(*snapshot, /*p_is_posed=*/true, r_posed);
	reader.read(*p_scene.root);
	const bool has_own_size = p_scene.scene_size_m > 0 && std::isfinite(p_scene.scene_size_m);
	if (has_own_size) {
		snapshot->scene_size_m = p_scene.scene_size_m;
	} else if (reader.has_animated_nodes()) { // at rest, so that S does not change with the pose
		SceneSnapshot rest_snapshot;
		TreeReader(rest_snapshot, /*p_is_posed=*/false, /*r_posed=*/nullptr).read(*p_scene.root);
		snapshot->scene_size_m = rest_snapshot.compute_caster_bounds().get_diagonal();
	} else {
		snapshot->scene_size_m = snapshot->compute_caster_bounds().get_diagonal();
	}
	snapshot->scene_size_m = std::max(MIN_SCENE_SIZE_M, snapshot->scene_size_m);
	snapshot->lights.edit_all(
			[&](LightSnapshot &r_light) { r_light.decide_settings(snapshot->scene_size_m); });
	return snapshot;
}

} // namespace gnomon
