// Checks that passes that a frame does not need are skipped, for every registered technique.

#include "modules/renderer/tests/lean_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Draws the image with skipping and without, and checks that both are equal. Returns the result
/// with skipping.
RenderResult render_both(RenderFixture &r_fixture, const SmallScene &p_scene) {
	const RenderResult lean = r_fixture.render_image(p_scene);
	const RenderResult whole = r_fixture.render_image(p_scene, "", false);
	CHECK(lean.image == whole.image);
	for (const FramePlanEntry &entry : whole.plan.get_entries()) {
		CHECK_FALSE((entry.pass == "light" && !entry.runs)); // no light is skipped
	}
	return lean;
}

} // namespace

TEST_CASE("[GPU][Lean] a light that reaches no surface in view is skipped, the image is the "
		  "same") {
	RenderFixture fixture;
	struct Case {
		const char *what;
		const char *reason; // empty: the light must not be skipped
		void (*change)(TwoLights &r_lights);
	};
	const char *NOT_IN_CONE = "the camera sees no surface in its cone and range";
	const char *NOT_IN_RANGE = "the camera sees no surface in its range";
	const Case cases[] = {
		{ "a cone that points away from all that is seen", NOT_IN_CONE,
				[](TwoLights &r_lights) {
					r_lights.aim_second_light({ 1, 3, 0 }, { 1.2, 9, 0 });
				} },
		{ "a cone that lights a wall outside the view", NOT_IN_CONE,
				[](TwoLights &r_lights) {
					add_mesh(r_lights.scene.scene, "Wall", make_box_mesh("wall", { 1, 1, 1 }),
							{ 0, 0, 40 });
					r_lights.aim_second_light({ 0, 0, 30 }, { 0, 0, 40 });
				} },
		{ "a range that ends above everything, in the middle of the view", NOT_IN_RANGE,
				[](TwoLights &r_lights) {
					r_lights.second.type = LightType::OMNI;
					r_lights.second.range_m = 0.5f;
					r_lights.aim_second_light({ 0, 2.2, 0 }, { 0, 0, 0.1 });
				} },
		{ "any light, where the camera sees the sky alone", "the camera sees no surface",
				[](TwoLights &r_lights) {
					r_lights.second.type = LightType::DIRECTIONAL;
					r_lights.scene.camera->parent_from_node = look_at({ 0, 9, 0 }, { 0, 20, 0.1 });
				} },
		{ "one that is dark", "its intensity is 0",
				[](TwoLights &r_lights) { r_lights.second.intensity = 0.0f; } },
		{ "one that lights what is seen", "", [](TwoLights &) {} },
		{ "one whose range just reaches a surface", "",
				[](TwoLights &r_lights) {
					r_lights.second.type = LightType::OMNI;
					r_lights.second.range_m = 0.75f; // the box's upper side is 0.7 m away
					r_lights.aim_second_light({ 0, 2.0, 0 }, { 0, 0, 0.1 });
				} },
		{ "one behind the camera that lights the view", "",
				[](TwoLights &r_lights) {
					r_lights.aim_second_light({ -4.8, 7.2, 6.8 }, { 0, 0, 0 });
				} },
	};
	for (const Case &one : cases) {
		CAPTURE(one.what);
		TwoLights lights;
		one.change(lights);
		const RenderResult lean = render_both(fixture, lights.scene);
		CHECK(find_skip_reason(lean, "Second") == one.reason);
		const bool has_wall = std::string(one.what).find("a wall outside") != std::string::npos;
		CHECK((lean.plan.is_skipped("", "1 instances") || !has_wall));
	}
}

TEST_CASE("[GPU][Lean] the light whose debug view is requested is not skipped") {
	RenderFixture fixture;
	TwoLights lights;
	lights.aim_second_light({ 1, 3, 0 }, { 1.2, 9, 0 });
	RenderRequest request;
	request.scene = lights.scene.snap();
	request.size_px = glm::uvec2(32);
	request.technique_override = ShadowRegistry::get_all().at(0).id;
	request.debug_view = "mask";
	request.debug_light = "Second";
	const RenderResult result = fixture.renderer->render(request);
	CHECK(find_skip_reason(result, "Second") == "");
	CHECK(std::count(result.debug_views.begin(), result.debug_views.end(), "mask") == 1);
}

TEST_CASE("[GPU][Lean] the mask of a light that lights nothing in view runs no technique") {
	RenderFixture fixture;
	SmallScene scene;
	scene.light->parent_from_node = look_at({ 1.2, 4.0, 0.8 }, { 1.2, 9.0, 0.9 });
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		CAPTURE(info.id);
		const RenderResult lean = fixture.render_mask(scene, info.id);
		CHECK(lean.plan.is_skipped("Light", "shadow"));
		CHECK(count_receivers(lean) == 0);
		if (!info.is_reference) {
			const RenderResult whole = fixture.render_mask(scene, info.id, glm::uvec2(64), false);
			CHECK(lean.visibility == whole.visibility);
			CHECK(lean.find_light_passes("Light").size() < whole.find_light_passes("Light").size());
		}
	}
}

TEST_CASE("[GPU][Lean] skipping light views without receivers does not change a mask while the "
		  "camera turns") {
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		if (info.is_reference) {
			continue; // it draws no views
		}
		CAPTURE(info.id);
		RenderFixture skipping;
		RenderFixture whole;
		SmallScene scene(LightType::OMNI);
		scene.light->parent_from_node = look_at({ 0.2, 1.9, 0.3 }, { 0.1, 0, 0.2 });
		scene.light->properties["light_size"] = 0.1;
		// Cheap settings: this test does not check precision.
		for (const PropertyInfo &property :
				ShadowRegistry::get_light_properties(info.id).get_properties()) {
			if (property.name.ends_with("_map_size")) {
				scene.light->properties[property.name] = int64_t(128);
			} else if (property.name.ends_with("_count")) {
				scene.light->properties[property.name] = int64_t(2);
			}
		}
		// Walls around the light, so that each light view has its own casters and receivers.
		for (const double side : { -1.0, 1.0 }) {
			add_mesh(scene.scene, "Wall x", make_box_mesh("x", { 0.1f, 2, 2 }), { 2 * side, 1, 0 });
			add_mesh(scene.scene, "Wall z", make_box_mesh("z", { 2, 2, 0.1f }), { 0, 1, 2 * side });
		}
		for (const glm::dvec3 towards : { glm::dvec3(1, -0.2, 0), glm::dvec3(1, -0.2, 0),
					 glm::dvec3(-1, -0.3, 0.2), glm::dvec3(0, -1, 0.1), glm::dvec3(1, -0.2, 0) }) {
			scene.camera->parent_from_node =
					look_at({ 0, 1.2, 0 }, glm::dvec3(0, 1.2, 0) + towards);
			scene.camera->vertical_fov_rad = 0.7f;
			scene.light->parent_from_node[3].x += 0.01 * towards.y; // moves a little each frame
			const RenderResult lean = skipping.render_mask(scene, info.id, glm::uvec2(48));
			const RenderResult all = whole.render_mask(scene, info.id, glm::uvec2(48), false);
			CHECK(count_receivers(lean) > 500);
			CHECK(lean.visibility == all.visibility);
		}
	}
}

TEST_CASE("[GPU][Lean] maps stay cached while the camera looks away for a short time") {
	for (const ShadowTechniqueInfo *info :
			{ ShadowRegistry::find_fallback(), ShadowRegistry::find_default() }) {
		CAPTURE(info->id);
		RenderFixture fixture;
		SmallScene scene(LightType::DIRECTIONAL);
		scene.ground->casts_shadow = false; // the light's view holds the box alone
		scene.camera->vertical_fov_rad = 0.3f;
		const glm::dmat4 towards = scene.camera->parent_from_node;
		const auto get_reason = [&] {
			const RenderResult result = fixture.render_mask(scene, info->id);
			CHECK(count_receivers(result) > 0);
			for (const FramePlanEntry &entry : result.plan.get_entries()) {
				if (entry.pass == "light view 0" && !entry.runs) {
					return entry.reason;
				}
			}
			return std::string("drawn");
		};
		CHECK(get_reason() == "drawn");
		for (int frame = 0; frame < 3; ++frame) {
			scene.camera->parent_from_node = look_at({ 2.5, 3, 2.5 }, { 2.6, 0, 2.6 });
			CHECK(get_reason() == "the camera sees no receiver in it");
		}
		scene.camera->parent_from_node = towards;
		CHECK(get_reason().starts_with("cached"));
		scene.camera->parent_from_node = look_at({ 2.5, 3, 2.5 }, { 2.6, 0, 2.6 });
		for (int frame = 0; frame < 64; ++frame) { // above MAX_UNUSED_FRAMES
			get_reason();
		}
		scene.camera->parent_from_node = towards;
		CHECK(get_reason() == "drawn"); // unused for too many frames
	}
}

TEST_CASE("[GPU][TranslucentCasters] skipping does not change an image with a glass caster") {
	RenderFixture fixture;
	SmallScene scene;
	const std::string id = ShadowRegistry::find_default()->id;
	const RenderResult opaque = fixture.render_image(scene, id);
	auto glass = std::make_shared<Material>(*scene.box->surfaces[0].material);
	glass->transmission = 1.0f;
	glass->base_color = glm::vec3(0.9f, 0.1f, 0.1f);
	scene.box->surfaces[0].material = glass;
	const RenderResult lean = fixture.render_image(scene, id);
	CHECK(lean.image == fixture.render_image(scene, id, false).image);
	CHECK(lean.image != opaque.image);
}
