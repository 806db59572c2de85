#include "modules/shadow_reference/light_disc.h"

#include "modules/core/finite.h"

#include "shared/light_shared.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon {

namespace {

/// Rays to a disc at a finite distance end at this fraction of the distance, so that a lamp's own
/// surface at the disc does not hide it. The gap is many float roundings wide, but too small to
/// change the visibility noticeably.
constexpr float RAY_END = 1.0f - 1e-5f;

/// Returns the unit vector. Scales first, because squares of long or short vectors leave float's
/// range.
glm::vec3 normalize_safely(const glm::vec3 &p_vector) {
	const float largest =
			std::max({ std::abs(p_vector.x), std::abs(p_vector.y), std::abs(p_vector.z) });
	return glm::normalize(p_vector / largest);
}

} // namespace

void find_basis(const glm::vec3 &p_normal, glm::vec3 &r_x, glm::vec3 &r_y) {
	const float sign = std::copysign(1.0f, p_normal.z);
	const float a = -1.0f / (sign + p_normal.z);
	const float b = p_normal.x * p_normal.y * a;
	r_x = glm::vec3(1.0f + sign * p_normal.x * p_normal.x * a, sign * b, -sign * p_normal.x);
	r_y = glm::vec3(b, sign + p_normal.y * p_normal.y * a, -p_normal.y);
}

bool AreaLight::reaches(const glm::vec3 &p_position, const glm::vec3 &p_normal) const {
	const glm::vec3 to_light = is_directional ? -direction : position - p_position;
	const float distance_m = glm::length(to_light);
	if (!(glm::dot(p_normal, to_light) > LIGHT_MIN_COSINE * distance_m)) {
		return false;
	}
	if (is_directional) {
		return true;
	}
	if (range_m > 0.0f && distance_m > range_m) {
		return false;
	}
	return cos_outer <= -1.0f || glm::dot(-to_light, direction) >= cos_outer * distance_m;
}

bool find_disc_view(const AreaLight &p_light, const glm::vec3 &p_position,
		const glm::vec3 &p_normal, float p_offset_m, DiscView &r_view, float &r_visibility) {
	r_visibility = 0.0f;
	r_view.origin = p_position + p_normal * p_offset_m;
	if (!is_finite(r_view.origin)) {
		return false;
	}
	r_view.end = RAY_END;
	glm::vec3 axis;
	if (p_light.is_directional) {
		axis = -normalize_safely(p_light.direction);
		r_view.centre = axis;
		r_view.end = std::numeric_limits<float>::infinity();
	} else {
		r_view.centre = p_light.position - r_view.origin;
		if (!is_finite(r_view.centre)) {
			return false;
		}
		if (r_view.centre == glm::vec3(0.0f)) {
			r_visibility = 1.0f;
			return false;
		}
		axis = normalize_safely(r_view.centre);
	}
	find_basis(axis, r_view.basis_x, r_view.basis_y);
	r_view.basis_x *= p_light.disc_radius;
	r_view.basis_y *= p_light.disc_radius;
	return true;
}

} // namespace gnomon
