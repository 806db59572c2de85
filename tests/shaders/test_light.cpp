#include "shared/light_shared.h"
#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <limits>

using namespace gnomon;

namespace {

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

struct Surface {
	glm::vec3 position;
	glm::vec3 normal;
};

/// A light at (1, 5, 2) m that shines down, with 10, 5 and 2.5 cd in red, green and blue
/// (directional: lx). The cone's inner and outer half angles are 0.5 and 0.6 rad. p_range_m: 0 for
/// no limit.
shader::LightConstants make_light(uint32_t p_type, float p_range_m = 0.0f) {
	shader::LightConstants light = {};
	light.position_radius = glm::vec4(1, 5, 2, 0.3f);
	light.direction = glm::vec4(0, -1, 0, 0);
	light.intensity = glm::vec4(10, 5, 2.5f, 0);
	light.range_m = p_range_m;
	light.cos_outer = std::cos(0.6f);
	light.cos_inner = std::cos(0.5f);
	light.type = p_type;
	return light;
}

std::vector<glm::vec4> run(KernelFixture &r_fixture, const shader::LightConstants &p_light,
		const std::vector<Surface> &p_surfaces) {
	std::vector<glm::vec4> input;
	for (const Surface &surface : p_surfaces) {
		input.push_back(glm::vec4(surface.position, 1.0f));
		input.push_back(glm::vec4(surface.normal, 0.0f));
	}
	return r_fixture.run_with_constants("light.comp", p_light, input, p_surfaces.size(), 1);
}

bool receives(KernelFixture &r_fixture, const shader::LightConstants &p_light,
		const glm::vec3 &p_position, const glm::vec3 &p_normal) {
	return run(r_fixture, p_light, { { p_position, p_normal } })[0].w != 0.0f;
}

/// The illuminance according to KHR_lights_punctual, in double precision. The light's axis is -y.
double compute_illuminance(
		const shader::LightConstants &p_light, const glm::dvec3 &p_position, double p_intensity) {
	if (p_light.type == LIGHT_TYPE_DIRECTIONAL) {
		return p_intensity;
	}
	const glm::dvec3 to_light = glm::dvec3(p_light.position_radius) - p_position;
	const double distance_m = glm::length(to_light);
	double result = p_intensity / (distance_m * distance_m);
	if (p_light.range_m > 0.0f) {
		result *= std::clamp(1 - std::pow(distance_m / double(p_light.range_m), 4), 0.0, 1.0);
	}
	if (p_light.type == LIGHT_TYPE_SPOT) {
		const double cosine = to_light.y / distance_m;
		const double cone = std::clamp((cosine - double(p_light.cos_outer)) /
						(double(p_light.cos_inner) - double(p_light.cos_outer)),
				0.0, 1.0);
		result *= cone * cone;
	}
	return result;
}

} // namespace

TEST_CASE("[GPU][Shaders] a receiver faces the light and is in its cone and range") {
	KernelFixture fixture;
	const glm::vec3 up(0, 1, 0);
	const glm::vec3 below(1, 1, 2); // 4 m under the light
	for (uint32_t type : { LIGHT_TYPE_OMNI, LIGHT_TYPE_SPOT, LIGHT_TYPE_DIRECTIONAL }) {
		CAPTURE(type);
		const shader::LightConstants light = make_light(type);
		const bool is_directional = type == LIGHT_TYPE_DIRECTIONAL;
		CHECK(receives(fixture, light, below, up));
		CHECK_FALSE(receives(fixture, light, below, -up));		   // faces away
		CHECK_FALSE(receives(fixture, light, below, { 1, 0, 0 })); // edge on
		CHECK(receives(fixture, light, below, { 1, 1e-3f, 0 }));   // just not edge on
		// Closer to edge on, rounding would decide pixel by pixel.
		CHECK(receives(fixture, light, below, { 1, 2.0f * LIGHT_MIN_COSINE, 0 }));
		CHECK_FALSE(receives(fixture, light, below, { 1, 0.5f * LIGHT_MIN_COSINE, 0 }));
		CHECK_FALSE(receives(fixture, light, below, glm::vec3(0.0f)));
		CHECK_FALSE(receives(fixture, light, below, glm::vec3(NOT_A_NUMBER)));
		// At the light's position there is no direction to it. A directional light has no position.
		CHECK(receives(fixture, light, glm::vec3(light.position_radius), up) == is_directional);
		CHECK(receives(fixture, light, glm::vec3(NOT_A_NUMBER), up) == is_directional);
		// Above the light and facing it.
		CHECK(receives(fixture, light, { 1, 9, 2 }, -up) == (type == LIGHT_TYPE_OMNI));
		// The cone's edge at 4 m is at 4 tan 0.6 = 2.736547 m.
		CHECK(receives(fixture, light, { 1 + 2.7365f, 1, 2 }, up));
		CHECK(receives(fixture, light, { 1 + 2.7366f, 1, 2 }, up) == (type != LIGHT_TYPE_SPOT));
		CHECK(receives(fixture, make_light(type, 4.001f), below, up));
		CHECK(receives(fixture, make_light(type, 3.999f), below, up) == is_directional);
	}
}

TEST_CASE("[GPU][Shaders] illuminance follows KHR_lights_punctual") {
	KernelFixture fixture;
	TestRandom random;
	std::vector<Surface> surfaces;
	for (int index = 0; index < 2000; ++index) {
		const glm::dvec3 offset = random.next(0.1, 8) * random.next_unit();
		surfaces.push_back({ glm::vec3(glm::dvec3(1, 5, 2) + offset), glm::vec3(0, 1, 0) });
	}
	for (uint32_t type : { LIGHT_TYPE_OMNI, LIGHT_TYPE_SPOT, LIGHT_TYPE_DIRECTIONAL }) {
		for (float range_m : { 0.0f, 6.0f }) {
			CAPTURE(type);
			CAPTURE(range_m);
			const shader::LightConstants light = make_light(type, range_m);
			const std::vector<glm::vec4> results = run(fixture, light, surfaces);
			double largest_error = 0; // relative to the light without cone and range
			for (size_t index = 0; index < surfaces.size(); ++index) {
				const glm::dvec3 position(surfaces[index].position);
				const double distance_m =
						glm::distance(position, glm::dvec3(light.position_radius));
				const double scale = type == LIGHT_TYPE_DIRECTIONAL
						? 1
						: std::max(distance_m * distance_m, 1e-12);
				for (int channel = 0; channel < 3; ++channel) {
					const double intensity = double(light.intensity[channel]);
					const double expected = compute_illuminance(light, position, intensity);
					largest_error = std::max(largest_error,
							std::abs(double(results[index][channel]) - expected) * scale /
									intensity);
				}
			}
			// The cone multiplies rounding errors of the cosine by up to
			// 2 / (cos_inner - cos_outer) = 38.
			CHECK(largest_error < 2e-5);
		}
	}
	// On the light: large, but a number.
	const glm::vec4 at_light = run(fixture, make_light(LIGHT_TYPE_SPOT),
			{ { glm::vec3(1, 5, 2), glm::vec3(0, 1, 0) } })[0];
	CHECK(std::isfinite(at_light.x));
}
