#include "modules/error_report/question_hash.h"

#include "modules/core/files.h"
#include "modules/core/text.h"

namespace gnomon {

namespace {

uint64_t add_light(const LightSnapshot &p_light, uint64_t p_hash) {
	p_hash = p_light.compute_hash(p_hash);
	for (const float value : { p_light.inner_cone_rad, p_light.penumbra_outer_width_m,
				 p_light.penumbra_inner_width_m }) {
		p_hash = compute_value_hash(value, p_hash);
	}
	p_hash = compute_value_hash(p_light.casts_shadow, p_hash);
	for (const auto &[name, value] : p_light.properties) {
		p_hash = compute_text_hash(text(name, "=", format_property(value)), p_hash);
	}
	return p_hash;
}

uint64_t add_instance(const InstanceSnapshot &p_instance, uint64_t p_hash) {
	p_hash = p_instance.compute_hash(p_hash);
	p_hash = compute_value_hash(p_instance.is_planar_receiver, p_hash);
	p_hash = compute_value_hash(p_instance.material->scatter, p_hash);
	p_hash = compute_value_hash(p_instance.material->scatter_distance_m, p_hash);
	return compute_value_hash(p_instance.material->is_double_sided, p_hash);
}

} // namespace

uint64_t compute_question_hash(const MaskQuestion &p_question) {
	const SceneSnapshot &scene = *p_question.scene;
	uint64_t hash = scene.camera.compute_hash(1);
	hash = compute_value_hash(scene.scene_size_m, hash);
	for (const InstanceSnapshot &instance : scene.instances) {
		hash = add_instance(instance, hash);
	}
	for (const LightSnapshot &light : scene.lights) {
		if (p_question.light.empty() || light.name == p_question.light) {
			hash = add_light(light, hash);
		}
	}
	hash = compute_value_hash(p_question.filter_hash, hash);
	return compute_value_hash(p_question.size_px, hash);
}

} // namespace gnomon
