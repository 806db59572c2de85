#include "modules/shadow_map/light_points.h"

#include <doctest/doctest.h>

using namespace gnomon;

TEST_CASE("[Views] points of an omni light project to a uniform disc from every side") {
	LightSnapshot light;
	light.type = LightType::OMNI;
	light.light_size_m = 2.0f;
	const uint32_t count = 4096;
	for (const glm::dvec3 &side : { glm::dvec3(1, 0, 0), glm::dvec3(0, 0.6, 0.8) }) {
		int inner_count = 0; // within R / sqrt(2): half of a uniform disc
		for (uint32_t index = 0; index < count; ++index) {
			const glm::dvec3 point =
					make_light_point(light, index, count, /*p_nearest_m=*/5.0).position_world;
			const glm::dvec3 across = point - side * glm::dot(point, side);
			CHECK(glm::length(point) <= 2.0);
			inner_count += glm::length(across) < 2.0 / std::sqrt(2.0);
		}
		CHECK(inner_count / double(count) == doctest::Approx(0.5).epsilon(0.02));
	}
}

TEST_CASE("[Views] axes of a directional light stay right-handed, its directions in the cone") {
	LightSnapshot light;
	light.type = LightType::DIRECTIONAL;
	light.light_angular_distance_deg = 10.0f;
	for (uint32_t index = 0; index < 64; ++index) {
		const LightSnapshot point = make_light_point(light, index, 64, /*p_nearest_m=*/1.0);
		const glm::dmat3 &axes = point.world_from_light;
		CHECK(glm::determinant(axes) == doctest::Approx(1.0));
		const double angle =
				std::acos(glm::dot(point.get_direction_world(), light.get_direction_world()));
		CHECK(angle <= glm::radians(5.0) + 1e-9);
	}
}
