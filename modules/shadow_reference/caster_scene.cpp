#include "modules/shadow_reference/caster_scene.h"

#include <algorithm>

namespace gnomon {

namespace {

constexpr uint32_t LANE_COUNT = 8; // rays in an RTCRay8

} // namespace

void set_ray(RTCRay8 &r_rays, uint32_t p_lane, const glm::vec3 &p_origin, const glm::vec3 &p_ray,
		float p_end) {
	r_rays.org_x[p_lane] = p_origin.x;
	r_rays.org_y[p_lane] = p_origin.y;
	r_rays.org_z[p_lane] = p_origin.z;
	r_rays.dir_x[p_lane] = p_ray.x;
	r_rays.dir_y[p_lane] = p_ray.y;
	r_rays.dir_z[p_lane] = p_ray.z;
	r_rays.tfar[p_lane] = p_end;
	r_rays.mask[p_lane] = 0xffffffffu;
}

CasterScene::CasterScene(std::span<const glm::vec3> p_positions,
		std::span<const uint32_t> p_triangle_indices,
		std::span<const TranslucentTriangles> p_translucent,
		std::span<const CutOutTriangles> p_cut_out) :
		opaque(p_positions, p_triangle_indices, p_cut_out) {
	std::vector<const Triangles *> bodies;
	for (const TranslucentTriangles &body : p_translucent) {
		bodies.push_back(&body.triangles);
		transmittances.push_back(body.transmittance);
	}
	if (!bodies.empty()) {
		translucent.emplace(EmbreeScene::make_recording_scene(bodies));
	}
}

void CasterScene::trace(const int *p_valid, RTCRay8 &r_rays, glm::vec3 *r_transmitted) const {
	alignas(32) RTCRay8 translucent_rays = r_rays;
	find_occluded_8(opaque.get(), p_valid, r_rays);
	alignas(32) int lit[LANE_COUNT];
	for (uint32_t i = 0; i < LANE_COUNT; ++i) {
		lit[i] = p_valid[i] != 0 && r_rays.tfar[i] >= 0.0f ? -1 : 0;
		r_transmitted[i] = glm::vec3(lit[i] != 0 ? 1.0f : 0.0f);
		translucent_rays.id[i] = i;
	}
	if (translucent) {
		thread_local Crossings crossings;
		for (std::vector<uint32_t> &bodies : crossings) {
			bodies.clear();
		}
		find_crossings_8(translucent->get(), lit, translucent_rays, crossings);
		for (uint32_t i = 0; i < LANE_COUNT; ++i) {
			// In a fixed order, so that rounding does not depend on how the BVH was traversed.
			std::sort(crossings[i].begin(), crossings[i].end());
			glm::vec3 transmitted(1.0f);
			for (const uint32_t body : crossings[i]) {
				transmitted *= transmittances[body];
			}
			r_transmitted[i] *= transmitted;
		}
	}
}

glm::vec3 CasterScene::trace(const glm::vec3 &p_origin, const glm::vec3 &p_ray, float p_end) const {
	if (!translucent) {
		return glm::vec3(opaque.is_occluded(p_origin, p_ray, p_end) ? 0.0f : 1.0f);
	}
	alignas(32) RTCRay8 rays = {};
	set_ray(rays, 0, p_origin, p_ray, p_end);
	alignas(32) const int valid[LANE_COUNT] = { -1 };
	glm::vec3 transmitted[LANE_COUNT];
	trace(valid, rays, transmitted);
	return transmitted[0];
}

} // namespace gnomon
