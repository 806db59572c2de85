#include "modules/renderer/truth_source.h"

#include "modules/core/files.h"

namespace gnomon {

namespace {

template <typename T> void add_to_hash(const T &p_value, uint64_t &r_hash) {
	r_hash = compute_hash(bytes_of(std::span<const T>(&p_value, 1)), r_hash);
}

} // namespace

uint64_t compute_truth_hash(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light, glm::uvec2 p_size_px) {
	uint64_t hash = 0;
	add_to_hash(p_size_px, hash);
	add_to_hash(p_scene.camera.position_world, hash);
	add_to_hash(p_scene.camera.world_from_camera, hash);
	add_to_hash(p_scene.camera.vertical_fov_rad, hash);
	add_to_hash(p_scene.camera.near_m, hash);
	add_to_hash(p_scene.scene_size_m, hash);
	add_to_hash(p_light.type, hash);
	add_to_hash(p_light.position_world, hash);
	add_to_hash(p_light.world_from_light, hash);
	add_to_hash(p_light.range_m, hash);
	add_to_hash(p_light.outer_cone_rad, hash);
	add_to_hash(p_light.get_disc_radius(), hash);
	for (const InstanceSnapshot &instance : p_scene.instances) {
		add_to_hash(instance.mesh->id, hash);
		add_to_hash(instance.world_from_node, hash);
		add_to_hash(instance.casts_shadow, hash);
	}
	return hash;
}

} // namespace gnomon
