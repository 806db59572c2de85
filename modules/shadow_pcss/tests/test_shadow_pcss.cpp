#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;

namespace {

double compute_mean(const MaskResult &p_result) {
	double sum = 0;
	for (float value : p_result.visibility) {
		sum += value;
	}
	return sum / double(count_receivers(p_result));
}

size_t count_shades(const MaskResult &p_result) {
	return static_cast<size_t>(std::count_if(p_result.visibility.begin(), p_result.visibility.end(),
			[](float p_value) { return p_value > 0.01f && p_value < 0.99f; }));
}

} // namespace

TEST_CASE("[GPU][Pcss] a light without size has a hard shadow, a larger one a wider penumbra") {
	MaskFixture fixture;
	for (LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		SmallScene scene(type);
		size_t before = 0;
		for (double factor : { 0.0, 1.0, 3.0 }) {
			scene.light->properties["light_size"] = 0.15 * factor;
			scene.light->properties["light_angular_distance"] = 4.0 * factor;
			const MaskResult mask = fixture.render_mask(scene, "pcss");
			const size_t shades = count_shades(mask);
			CHECK((factor == 0.0 ? shades < 20 : shades > before + 20));
			before = shades;
		}
	}
}

TEST_CASE("[GPU][Pcss] more taps change the noise, not the mean") {
	MaskFixture fixture;
	SmallScene scene;
	scene.light->properties["light_size"] = 0.4;
	const auto render = [&](int64_t p_tap_count) {
		scene.light->properties["pcss_taps"] = p_tap_count;
		return fixture.render_mask(scene, "pcss", glm::uvec2(96));
	};
	const MaskResult many = render(256);
	const double few_difference = compute_mask_difference(render(8), many);
	const double more_difference = compute_mask_difference(render(64), many);
	CHECK(more_difference < 0.6 * few_difference);
	CHECK(compute_mean(render(16)) == doctest::Approx(compute_mean(many)).epsilon(0.01));
}

TEST_CASE("[GPU][Pcss] an omni light's penumbra does not end at the border of a view") {
	MaskFixture fixture;
	SmallScene scene(LightType::OMNI);
	scene.light->properties["light_size"] = 0.5;
	scene.light->properties["pcss_taps"] = int64_t(128);
	// Borders of the views pass through the penumbra.
	scene.light->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(-1.6, 2.9, 0.1));
	const MaskResult mask = fixture.render_mask(scene, "pcss", glm::uvec2(96));
	scene.light->parent_from_node =
			glm::rotate(scene.light->parent_from_node, glm::radians(45.0), glm::dvec3(0, 0, 1));
	const MaskResult rotated = fixture.render_mask(scene, "pcss", glm::uvec2(96));
	CHECK(count_shades(mask) > 100);
	CHECK(compute_mask_difference(mask, rotated) < 0.01);
}

TEST_CASE("[GPU][Pcss] a static scene's map is cached, even when the tap count changes") {
	MaskFixture fixture;
	SmallScene scene;
	const MaskResult first = fixture.render_mask(scene, "pcss");
	scene.light->properties["pcss_taps"] = int64_t(16);
	const MaskResult second = fixture.render_mask(scene, "pcss");
	CHECK_FALSE(first.plan.is_skipped("Light", "light view 0"));
	CHECK(second.plan.is_skipped("Light", "light view 0"));
	CHECK(first.visibility != second.visibility);
}

TEST_CASE("[GPU][Pcss] a caster behind the light changes nothing") {
	MaskFixture fixture;
	for (LightType type : { LightType::SPOT, LightType::OMNI }) {
		CAPTURE(get_light_type_name(type));
		SmallScene scene(type);
		const MaskResult without = fixture.render_mask(scene, "pcss", glm::uvec2(64));
		const glm::dvec3 light_position(1.2, 4.0, 0.8); // of a SmallScene
		const glm::dvec3 behind = light_position + glm::normalize(light_position); // 1 m farther
		MeshInstance3D &box =
				add_mesh(scene.scene, "Behind", make_box_mesh("behind", glm::vec3(0.4f)), behind);
		box.parent_from_node = scene.light->parent_from_node;
		box.parent_from_node[3] = glm::dvec4(behind, 1.0);
		const MaskResult with = fixture.render_mask(scene, "pcss", glm::uvec2(64));
		CHECK(compute_mask_difference(with, without) < 1e-3);
	}
}

TEST_CASE("[GPU][Pcss] views without receivers are drawn, as taps reach into them") {
	MaskFixture fixture;
	SmallScene scene(LightType::OMNI);
	scene.camera->parent_from_node = look_at({ 0, 1.2, 2.5 }, { 0, 0.2, 0 });
	scene.camera->vertical_fov_rad = 0.1f;
	const MaskResult result = fixture.render_mask(scene, "pcss");
	for (const FramePlanEntry &entry : result.plan.get_entries()) {
		CHECK(entry.reason.find("receiver") == std::string::npos);
	}
	CHECK(result.visibility ==
			fixture.render_mask(scene, "pcss", glm::uvec2(64), /*p_may_skip=*/false).visibility);
}
