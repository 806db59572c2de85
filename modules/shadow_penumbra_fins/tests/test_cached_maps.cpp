// Tests that maps are cached from frame to frame, and which changes make them redraw.

#include "modules/core/error.h"
#include "modules/shadow_penumbra_fins/tests/fins_fixture.h"
#include "modules/shadows/tests/setting_scope.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <list>

using namespace gnomon;

namespace {

MaskResult render(MaskFixture &r_fixture, const SmallScene &p_scene,
		const std::string &p_technique = "penumbra_fins", bool p_may_reuse = true) {
	MaskRequest request;
	request.scene = p_scene.snap();
	request.size_px = glm::uvec2(64);
	request.technique_override = p_technique;
	request.light = p_scene.light->name;
	request.may_reuse = p_may_reuse;
	return r_fixture.render(request);
}

size_t count_drawn_views(const MaskResult &p_result) {
	return static_cast<size_t>(std::count_if(
			p_result.timings.begin(), p_result.timings.end(), [](const PassTiming &p_timing) {
				return p_timing.name.find("fins view") != std::string::npos;
			}));
}

} // namespace

TEST_CASE("[GPU][PenumbraFins] after any change cached maps give the mask that fresh ones give") {
	MaskFixture caching;
	MaskFixture fresh;
	SmallScene scene(LightType::OMNI);
	scene.light->properties["penumbra_outer_width"] = 0.2;
	scene.light->properties["penumbra_inner_width"] = 0.15;
	scene.light->properties["penumbra_fins_map_size"] = int64_t(256);
	const auto set = [&](const char *p_name, PropertyValue p_value) {
		return [&scene, p_name, p_value] { scene.light->properties[p_name] = p_value; };
	};
	struct Step {
		const char *description;
		std::function<void()> change;
		bool draws_fins; // the fins of some view are redrawn
	};
	std::list<SettingScope> scopes;
	const std::vector<Step> steps = {
		{ "first frame", [] {}, true },
		{ "nothing", [] {}, false },
		{ "r", set("penumbra_outer_width", 0.1), true },
		{ "t", set("penumbra_inner_width", 0.1), true },
		{ "beta", set("penumbra_fins_beta", 0.01), true },
		{ "curve", set("penumbra_fins_curve", std::string("linear")), true },
		{ "layers", set("penumbra_fins_layers", int64_t(2)), true },
		{ "map size", set("penumbra_fins_map_size", int64_t(128)), true },
		{ "peeling method", [&] { scopes.emplace_back("penumbra_fins", "peeling", "one_pass"); },
				false },
		{ "fin method", [&] { scopes.emplace_back("penumbra_fins", "method", "geometry_shader"); },
				false },
		{ "light's position", [&] { scene.light->parent_from_node[3].x += 0.3; }, true },
		{ "intensity", [&] { scene.light->intensity = 3.0f; }, false },
		{ "no t", set("penumbra_inner_width", 0.0), true },
		{ "no r either", set("penumbra_outer_width", 0.0), false }, // draws layers, no fins
		{ "r and t again",
				[&] {
					scene.light->properties["penumbra_outer_width"] = 0.2;
					scene.light->properties["penumbra_inner_width"] = 0.2;
				},
				true },
		{ "no casters", [&] { scene.box->casts_shadow = scene.ground->casts_shadow = false; },
				false },
		{ "casters again", [&] { scene.box->casts_shadow = scene.ground->casts_shadow = true; },
				true },
	};
	size_t full_count = 0;
	for (const Step &step : steps) {
		CAPTURE(step.description);
		step.change();
		const MaskResult reused = render(caching, scene);
		const MaskResult redrawn = render(fresh, scene, "penumbra_fins", /*p_may_reuse=*/false);
		CHECK(reused.visibility == redrawn.visibility);
		full_count = std::max(full_count, count_drawn_views(reused));
		CHECK((count_drawn_views(reused) > 0) == step.draws_fins);
		CHECK(reused.visibility == render(caching, scene).visibility);
	}
	// A caster that moves redraws some of the views, not all.
	scene.box->parent_from_node[3].x += 0.05;
	const MaskResult moved = render(caching, scene);
	const MaskResult redrawn = render(fresh, scene, "penumbra_fins", /*p_may_reuse=*/false);
	CHECK(moved.visibility == redrawn.visibility);
	CHECK(count_drawn_views(moved) > 0);
	CHECK(count_drawn_views(moved) < full_count);
}

TEST_CASE("[GPU][PenumbraFins] switching to another technique and back redraws the maps") {
	MaskFixture fixture;
	const SmallScene scene;
	const MaskResult first = render(fixture, scene);
	render(fixture, scene, "outer_fins");
	const MaskResult again = render(fixture, scene);
	CHECK(again.visibility == first.visibility);
	CHECK(count_drawn_views(again) == 1);
}

TEST_CASE("[GPU][PenumbraFins] a frame that fails half-way leaves no cached maps") {
	MaskFixture fixture;
	const SmallScene scene;
	MaskRequest request;
	request.scene = scene.snap();
	request.size_px = glm::uvec2(64);
	request.technique_override = "penumbra_fins";
	request.debug_view = "no such view"; // refused after the technique has planned its frame
	CHECK_THROWS_AS(fixture.render(request), Error);
	MaskFixture fresh;
	CHECK(render(fixture, scene).visibility == render(fresh, scene).visibility);
}

TEST_CASE("[GPU][PenumbraFins] fins of a caster outside an omni light's view reach into it") {
	// The box is outside the light's downward view, but its outer fins reach into that view and
	// darken the ground.
	MaskFixture fixture;
	SmallScene scene(LightType::OMNI);
	scene.box->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(2.4, 2.0, 0));
	scene.light->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 3.2, 0));
	scene.light->properties["penumbra_outer_width"] = 1.0;
	scene.light->properties["penumbra_inner_width"] = 0.0;
	scene.camera->parent_from_node = look_at({ 2.0, 6.0, 0.1 }, { 2.0, 0, 0 });
	const std::shared_ptr<const SceneSnapshot> snapshot = scene.snap();
	const uint32_t down_view = 3; // -y
	const uint32_t BORDER_PX = 2;
	const InstanceSnapshot &box = snapshot->instances[1];
	CHECK_FALSE(
			build_light_views(snapshot->lights[0], *snapshot, 256, BORDER_PX)[down_view].may_see(
					box.bounds_world));
	const float margin_m = 1.0f; // the outer width
	CHECK(build_light_views(snapshot->lights[0], *snapshot, 256, BORDER_PX, margin_m)[down_view]
					.may_see(box.bounds_world));
	const MaskResult omni = render(fixture, scene);
	// The same light rotated by 45 degrees has the borders of its views elsewhere.
	scene.light->parent_from_node =
			glm::rotate(scene.light->parent_from_node, glm::radians(45.0), glm::dvec3(0, 0, 1));
	const MaskResult rotated_light = render(fixture, scene);
	CHECK(compute_mask_difference(omni, rotated_light) < 0.001);
	// The fins do darken the downward view of the light before its rotation: that view contains the
	// whole ground, 3 m to each side, since it reaches 3.2 m to each side.
	scene.light->properties["penumbra_outer_width"] = 0.0;
	CHECK(compute_mask_difference(render(fixture, scene), omni) > 0.004);
}
