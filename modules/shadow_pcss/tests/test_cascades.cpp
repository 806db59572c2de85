// Nested views of directional lights.

#include "modules/shadow_pcss/cascades.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace gnomon;

namespace {

/// A small scene on a wide plain that casts nothing. p_has_tower: and a caster far away, so that
/// one map of all casters is coarse. The camera does not see the tower or its shadow.
SmallScene make_wide_scene(bool p_has_tower = true) {
	SmallScene scene(LightType::DIRECTIONAL);
	scene.light->properties["light_angular_distance"] = 0.5;
	add_mesh(scene.scene, "Plain", make_box_mesh("plain", glm::vec3(500, 0.1, 500)), { 0, -0.6, 0 })
			.casts_shadow = false;
	if (p_has_tower) {
		add_mesh(scene.scene, "Tower", make_box_mesh("tower", glm::vec3(1, 20, 1)),
				{ 150, 5, -400 });
	}
	return scene;
}

std::vector<LightView> split(const SceneSnapshot &p_scene, uint32_t p_count) {
	const LightScene scene(p_scene);
	const std::vector<LightView> whole =
			build_light_views(p_scene.lights[0], scene, /*p_map_size_px=*/256, /*p_border_px=*/1);
	return split_into_cascades(whole.front(), scene, p_count, /*p_border_px=*/1);
}

} // namespace

TEST_CASE("[Pcss] cascades grow from view to view, and the last one contains all casters") {
	const SmallScene scene = make_wide_scene();
	for (uint32_t count = 1; count <= 4; ++count) {
		const std::vector<LightView> views = split(*scene.snap(), count);
		REQUIRE(views.size() == count);
		CHECK(views.back() == split(*scene.snap(), 1).front());
		for (size_t index = 1; index < views.size(); ++index) {
			CHECK(views[index].half_extent.x > views[index - 1].half_extent.x);
			CHECK(views[index].far_m == views[index - 1].far_m);
		}
		// Each contains what the camera looks at up to its own size.
		for (const LightView &view : views) {
			const glm::dvec3 seen = glm::dvec3(
					view.view_from_world * glm::dvec4(scene.snap()->camera.position_world, 1.0));
			CHECK(std::abs(seen.x) < view.half_extent.x);
			CHECK(std::abs(seen.y) < view.half_extent.y);
		}
	}
}

TEST_CASE("[Pcss] cascades keep their size while the camera moves and turns, and move by texels") {
	SmallScene scene = make_wide_scene();
	const std::vector<LightView> before = split(*scene.snap(), 4);
	const glm::dmat4 start = scene.camera->parent_from_node;
	for (int step = 1; step <= 20; ++step) {
		CAPTURE(step);
		scene.camera->parent_from_node =
				glm::rotate(glm::translate(start, glm::dvec3(0.013 * step, 0, 0.02 * step)),
						0.1 * step, glm::dvec3(0, 1, 0));
		const std::vector<LightView> after = split(*scene.snap(), 4);
		REQUIRE(after.size() == before.size());
		for (size_t index = 0; index < after.size(); ++index) {
			CHECK(after[index].half_extent == before[index].half_extent);
			const double texel_m = 2.0 * before[index].half_extent.x / 256;
			const glm::dvec4 moved =
					(after[index].view_from_world[3] - before[index].view_from_world[3]) / texel_m;
			CHECK(std::abs(moved.x - std::round(moved.x)) < 1e-3);
			CHECK(std::abs(moved.y - std::round(moved.y)) < 1e-3);
		}
	}
}

TEST_CASE("[GPU][Pcss] with cascades, shadows near the camera are not coarse where it sees far") {
	MaskFixture fixture;
	const auto render = [&](SmallScene &r_scene, int64_t p_map_size, int64_t p_cascades) {
		r_scene.light->properties["pcss_map_size"] = p_map_size;
		r_scene.light->properties["pcss_cascades"] = p_cascades;
		const MaskResult mask = fixture.render_mask(r_scene, "pcss", glm::uvec2(128));
		CHECK(is_valid_mask(mask));
		return mask;
	};
	SmallScene near = make_wide_scene(/*p_has_tower=*/false);
	SmallScene scene = make_wide_scene();
	for (SmallScene *each : { &near, &scene }) { // to the horizon, with the box in front
		each->camera->parent_from_node = look_at({ -1.2, 1.8, 3.4 }, { 0, 1.2, 0 });
	}
	const MaskResult fine = render(near, 4096, 1); // all casters are near
	const MaskResult cascades = render(scene, 512, 4);
	const double one = compute_mask_difference(render(scene, 512, 1), fine);
	const double four = compute_mask_difference(cascades, fine);
	CHECK(one > 0.01);
	CHECK(four < 0.3 * one);
	// Nothing that is skipped changes the mask.
	CHECK(fixture.render_mask(scene, "pcss", glm::uvec2(128), /*p_may_skip=*/false).visibility ==
			render(scene, 512, 4).visibility);
}

TEST_CASE("[GPU][Pcss] cascades are skipped where one map of all that the camera sees is finer") {
	MaskFixture fixture;
	SmallScene scene = make_wide_scene(); // the camera looks down at the ground
	scene.light->properties["pcss_map_size"] = int64_t(512);
	const MaskResult one = fixture.render_mask(scene, "pcss", glm::uvec2(96));
	scene.light->properties["pcss_cascades"] = int64_t(4);
	const MaskResult four = fixture.render_mask(scene, "pcss", glm::uvec2(96));
	CHECK(four.plan.to_text().find("no finer than the map of all that the camera sees") !=
			std::string::npos);
	CHECK(four.visibility == one.visibility);
}

TEST_CASE("[GPU][Pcss] spot and omni lights have no cascades") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		SmallScene scene(type);
		const MaskResult one = fixture.render_mask(scene, "pcss");
		scene.light->properties["pcss_cascades"] = int64_t(4);
		CHECK(fixture.render_mask(scene, "pcss").visibility == one.visibility);
	}
}
