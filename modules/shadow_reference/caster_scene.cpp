#include "modules/shadow_reference/caster_scene.h"

namespace gnomon {

namespace {

constexpr uint32_t LANE_COUNT = 8;

} // namespace

CasterScene::CasterScene(std::span<const glm::vec3> p_positions,
		std::span<const uint32_t> p_triangle_indices,
		std::span<const TranslucentTriangles> p_translucent) :
		opaque(p_positions, p_triangle_indices) {
	for (const TranslucentTriangles &body : p_translucent) {
		translucent.push_back(
				{ std::make_unique<EmbreeScene>(body.triangles.positions, body.triangles.indices),
						body.transmittance });
	}
}

void CasterScene::trace(const int *p_valid, RTCRay8 &r_rays, glm::vec3 *r_left) const {
	const RTCRay8 rays = r_rays;
	find_occluded_8(opaque.get(), p_valid, r_rays);
	alignas(32) int lit[LANE_COUNT];
	for (uint32_t i = 0; i < LANE_COUNT; ++i) {
		lit[i] = p_valid[i] != 0 && r_rays.tfar[i] >= 0.0f ? -1 : 0;
		r_left[i] = glm::vec3(lit[i] != 0 ? 1.0f : 0.0f);
	}
	for (const Body &body : translucent) {
		alignas(32) RTCRay8 again = rays;
		find_occluded_8(body.scene->get(), lit, again);
		for (uint32_t i = 0; i < LANE_COUNT; ++i) {
			if (lit[i] != 0 && again.tfar[i] < 0.0f) {
				r_left[i] *= body.transmittance;
			}
		}
	}
}

glm::vec3 CasterScene::trace(const glm::vec3 &p_origin, const glm::vec3 &p_ray, float p_end) const {
	glm::vec3 left(opaque.is_occluded(p_origin, p_ray, p_end) ? 0.0f : 1.0f);
	for (const Body &body : translucent) {
		if (left != glm::vec3(0.0f) && body.scene->is_occluded(p_origin, p_ray, p_end)) {
			left *= body.transmittance;
		}
	}
	return left;
}

} // namespace gnomon
