#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace gnomon;

namespace {

constexpr double PI = 3.14159265358979;

/// Angles in radians: of light and viewer from the normal, and the viewer's azimuth about the
/// normal, from the light's side.
struct Directions {
	double light = 0;
	double viewer = 0;
	double azimuth = 0;
};

/// A material, by default a grey dielectric. A roughness of -1 - r selects Phong's model with
/// roughness r.
struct Case {
	float scatter = 0;
	float roughness = 0.5f;
	float metallic = 0;
	glm::vec3 base_color = glm::vec3(0.8f);
};

std::vector<double> reflect(
		KernelFixture &r_fixture, const Case &p_case, const std::vector<Directions> &p_directions) {
	std::vector<glm::vec4> input;
	for (const Directions &directions : p_directions) {
		input.push_back(glm::vec4(
				p_case.scatter, /*scatter_distance_m=*/0.0f, p_case.roughness, p_case.metallic));
		input.push_back(glm::vec4(p_case.base_color, 1.0f));
		input.push_back(glm::vec4(directions.light, directions.viewer, directions.azimuth, 0.0));
	}
	std::vector<double> values;
	for (const glm::vec4 &result : r_fixture.run("brdf.comp", input, p_directions.size(), 1)) {
		values.push_back(result.x);
	}
	return values;
}

/// The fraction of the light from one direction that is reflected in all directions (directional
/// albedo). p_light: angle in radians from the normal.
double compute_directional_albedo(KernelFixture &r_fixture, const Case &p_case, double p_light) {
	const int STEP_COUNT = 96;
	std::vector<Directions> directions;
	std::vector<double> weights;
	for (int i = 0; i < STEP_COUNT; ++i) {
		for (int k = 0; k < STEP_COUNT; ++k) {
			const double viewer = (i + 0.5) * 0.5 * PI / STEP_COUNT;
			// Half of the azimuths: the other half mirrors it, so each weighs twice.
			directions.push_back({ p_light, viewer, (k + 0.5) * PI / STEP_COUNT });
			weights.push_back(std::sin(viewer) * std::cos(viewer) * (0.5 * PI / STEP_COUNT) *
					(2 * PI / STEP_COUNT));
		}
	}
	const std::vector<double> values = reflect(r_fixture, p_case, directions);
	double sum = 0;
	for (size_t index = 0; index < values.size(); ++index) {
		sum += values[index] * weights[index] / std::cos(p_light);
	}
	return sum;
}

} // namespace

TEST_CASE("[GPU][Brdf] a white surface reflects 50 to 110 % of the light, grazing up to 140 %") {
	KernelFixture fixture;
	for (const float roughness : { 0.3f, 0.6f, 1.0f, -1.3f, -1.6f, -2.0f }) {
		for (const float scatter : { 0.0f, 0.5f, 1.0f }) {
			for (const double light : { 0.1, 0.8, 1.3 }) {
				CAPTURE(roughness);
				CAPTURE(scatter);
				CAPTURE(light);
				const double albedo = compute_directional_albedo(
						fixture, { scatter, roughness, 0.0f, glm::vec3(1.0f) }, light);
				CHECK(albedo > 0.5);
				// Neither glTF's sum of lobes nor Burley's lobe is normalised at grazing light.
				CHECK(albedo < (light > 1 ? 1.4 : 1.1));
			}
		}
	}
}

TEST_CASE("[GPU][Brdf] what is reflected does not change when light and viewer swap positions") {
	KernelFixture fixture;
	for (const float roughness : { 0.4f, -1.4f }) {
		for (const float scatter : { 0.0f, 0.7f }) {
			const std::vector<double> values = reflect(
					fixture, { scatter, roughness }, { { 0.3, 1.1, 0.4 }, { 1.1, 0.3, 0.4 } });
			CHECK(values[0] / std::cos(0.3) == doctest::Approx(values[1] / std::cos(1.1)));
		}
	}
}

TEST_CASE("[GPU][Brdf] Phong's highlight is where a mirror would send the light") {
	KernelFixture fixture;
	const std::vector<double> values = reflect(fixture, { 0.0f, -1.3f },
			{ { 0.5, 0.5, PI }, { 0.5, 0.45, PI }, { 0.5, 0.55, PI }, { 0.5, 0.5, 0.0 } });
	CHECK(values[0] > values[1]);
	CHECK(values[1] == doctest::Approx(values[2]).epsilon(1e-3));
	CHECK(values[3] < 0.5 * values[0]);
	// Away from the highlight a rough Phong surface is Lambertian: 0.96 = 1 - DIELECTRIC_F0, and
	// 0.8 is the base colour.
	CHECK(values[3] == doctest::Approx(0.96 * 0.8 / PI * std::cos(0.5)).epsilon(0.05));
}

TEST_CASE("[GPU][Brdf] at grazing light a translucent surface darkens less than an opaque one") {
	KernelFixture fixture;
	const std::vector<Directions> directions = { { 0.2, 0.4, 1.0 }, { 1.35, 0.4, 1.0 } };
	const std::vector<double> opaque = reflect(fixture, { 0.0f, 1.0f }, directions);
	const std::vector<double> half = reflect(fixture, { 0.5f, 1.0f }, directions);
	const std::vector<double> wax = reflect(fixture, { 1.0f, 1.0f }, directions);
	CHECK(wax[1] / wax[0] > 1.1 * opaque[1] / opaque[0]);
	CHECK(half[0] == doctest::Approx(0.5 * (opaque[0] + wax[0])).epsilon(1e-3));
	// A surface that faces away from the light reflects nothing.
	CHECK(reflect(fixture, { 1.0f, 1.0f }, { { 1.6, 0.4, 1.0 } })[0] == 0);
}
