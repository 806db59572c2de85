#include "modules/scene/frame_snapshots.h"

#include "modules/scene/scene_tree_reader.h"

namespace gnomon {

namespace {

/// Multiplies from the root on, as reading the whole tree does, so that both round alike.
glm::dmat4 compute_world_from_node(const Node3D &p_node) {
	const glm::dmat4 world_from_parent =
			p_node.parent ? compute_world_from_node(*p_node.parent) : glm::dmat4(1.0);
	return world_from_parent * p_node.get_parent_from_node();
}

/// Calls p_move for each part whose transform has changed.
template <typename Part, typename Move>
void move_parts(std::vector<Part> &r_parts, const Move &p_move) {
	for (Part &part : r_parts) {
		const glm::dmat4 world_from_node = compute_world_from_node(*part.node);
		if (world_from_node != part.world_from_node) {
			check_transform(*part.node, world_from_node);
			part.world_from_node = world_from_node;
			p_move(part);
		}
	}
}

} // namespace

std::shared_ptr<const SceneSnapshot> FrameSnapshots::build(
		const Scene &p_scene, const Camera3D &p_camera, SceneChange p_change) {
	if (!last || p_change == SceneChange::ANY ||
			(p_change == SceneChange::POSE && posed.has_deformable)) {
		last.reset(); // so that after an Error, nothing refers to nodes that may be gone
		posed = {};
		last = read_scene_tree(p_scene, p_camera, &posed);
		return last;
	}
	CameraSnapshot camera = build_camera_snapshot(p_camera);
	if (camera.name != last->camera.name ||
			camera.compute_hash(0) != last->camera.compute_hash(0)) {
		auto moved = std::make_shared<SceneSnapshot>(*last);
		moved->camera = std::move(camera);
		last = std::move(moved);
	}
	if (p_change == SceneChange::POSE) {
		apply_pose();
	}
	return last;
}

void FrameSnapshots::apply_pose() {
	auto moved = std::make_shared<SceneSnapshot>(*last);
	const std::shared_ptr<const SceneSnapshot> before = std::move(last); // null after an Error
	move_parts(posed.instances, [&](const PosedParts::Instances &p_part) {
		for (uint32_t index = p_part.first; index < p_part.first + p_part.count; ++index) {
			moved->instances.edit(index).set_transform(p_part.world_from_node);
		}
	});
	move_parts(posed.lights, [&](const PosedParts::Light &p_part) {
		LightSnapshot &light = moved->lights.edit(p_part.index);
		light = build_light_snapshot(*p_part.node, p_part.world_from_node);
		light.decide_settings(moved->scene_size_m);
	});
	last = std::move(moved);
}

} // namespace gnomon
