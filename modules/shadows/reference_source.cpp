#include "modules/shadows/reference_source.h"

#include "modules/core/files.h"
#include "modules/shadows/mask_filter.h"

namespace gnomon {

uint64_t compute_reference_hash(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light, glm::uvec2 p_size_px) {
	uint64_t hash = compute_filter_hash();
	hash = compute_value_hash(p_size_px, hash);
	hash = p_scene.camera.compute_hash(hash);
	hash = compute_value_hash(p_scene.scene_size_m, hash);
	hash = p_light.compute_hash(hash);
	for (const InstanceSnapshot &instance : p_scene.instances) {
		hash = instance.compute_hash(hash);
		hash = compute_value_hash(instance.material->scatter, hash);
		hash = compute_value_hash(instance.material->scatter_distance_m, hash);
	}
	return hash;
}

} // namespace gnomon
