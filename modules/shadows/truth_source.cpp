#include "modules/shadows/truth_source.h"

#include "modules/core/files.h"
#include "modules/shadows/mask_filter.h"

namespace gnomon {

uint64_t compute_truth_hash(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light, glm::uvec2 p_size_px) {
	uint64_t hash = compute_filter_hash();
	hash = compute_value_hash(p_size_px, hash);
	hash = compute_value_hash(p_scene.camera.position_world, hash);
	hash = compute_value_hash(p_scene.camera.world_from_camera, hash);
	hash = compute_value_hash(p_scene.camera.vertical_fov_rad, hash);
	hash = compute_value_hash(p_scene.camera.near_m, hash);
	hash = compute_value_hash(p_scene.scene_size_m, hash);
	hash = compute_value_hash(p_light.type, hash);
	hash = compute_value_hash(p_light.position_world, hash);
	hash = compute_value_hash(p_light.world_from_light, hash);
	hash = compute_value_hash(p_light.range_m, hash);
	hash = compute_value_hash(p_light.outer_cone_rad, hash);
	hash = compute_value_hash(p_light.get_disc_radius(), hash);
	for (const InstanceSnapshot &instance : p_scene.instances) {
		hash = compute_value_hash(instance.mesh->id, hash);
		hash = compute_value_hash(instance.world_from_node, hash);
		hash = compute_value_hash(instance.casts_shadow, hash);
		hash = compute_value_hash(instance.material->scatter, hash);
		hash = compute_value_hash(instance.material->scatter_distance_m, hash);
		hash = compute_value_hash(instance.compute_transmittance(), hash);
	}
	return hash;
}

} // namespace gnomon
