#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

bool draws_light_view(const MaskResult &p_result) {
	for (const PassTiming &timing : p_result.timings) {
		if (timing.name.find("depth view") != std::string::npos) {
			return true;
		}
	}
	return false;
}

} // namespace

TEST_CASE("[GPU][ShadowMap] a static scene's second frame draws no light view") {
	MaskFixture fixture;
	for (LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		SmallScene scene(type);
		const MaskResult first = fixture.render_mask(scene, "shadow_map");
		const MaskResult second = fixture.render_mask(scene, "shadow_map");
		CHECK(draws_light_view(first));
		CHECK_FALSE(draws_light_view(second));
		CHECK(second.plan.is_skipped("Light", "light view 0"));
		CHECK(first.visibility == second.visibility);
	}
}

TEST_CASE("[GPU][ShadowMap] the map is redrawn when a caster or the light moves or its own size "
		  "changes, not when the camera moves") {
	MaskFixture fixture;
	SmallScene scene;
	fixture.render_mask(scene, "shadow_map");
	scene.camera->parent_from_node = look_at({ -2, 3, 3 }, { 0, 0, 0 });
	CHECK_FALSE(draws_light_view(fixture.render_mask(scene, "shadow_map")));
	scene.box->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 1.1, 0));
	CHECK(draws_light_view(fixture.render_mask(scene, "shadow_map")));
	scene.light->parent_from_node = look_at({ 1.3, 4.0, 0.8 }, { 0, 0.3, 0 });
	CHECK(draws_light_view(fixture.render_mask(scene, "shadow_map")));
	scene.light->properties["shadow_map_size"] = int64_t(256);
	CHECK(draws_light_view(fixture.render_mask(scene, "shadow_map")));
	CHECK_FALSE(draws_light_view(fixture.render_mask(scene, "shadow_map")));
}

TEST_CASE("[GPU][ShadowMap] a moved caster's cached frame equals a fresh one bit for bit") {
	MaskFixture fixture;
	SmallScene scene(LightType::OMNI);
	fixture.render_mask(scene, "shadow_map");
	scene.box->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0.4, 1.2, 0.1));
	const MaskResult reused = fixture.render_mask(scene, "shadow_map");
	MaskFixture fresh;
	CHECK(reused.visibility == fresh.render_mask(scene, "shadow_map").visibility);
}

TEST_CASE("[GPU][ShadowMap] a hard mask has only 0 and 1, wider filters have more values between") {
	MaskFixture fixture;
	SmallScene scene;
	const auto count_shades = [&](const char *p_filter) {
		scene.light->properties["shadow_map_filter"] = std::string(p_filter);
		const MaskResult result = fixture.render_mask(scene, "shadow_map", glm::uvec2(128));
		size_t count = 0;
		for (float value : result.visibility) {
			count += value > 0.0f && value < 1.0f;
		}
		return count;
	};
	scene.light->properties["shadow_map_size"] = int64_t(256);
	CHECK(count_shades("hard") == 0);
	const size_t narrow = count_shades("2x2");
	CHECK(narrow > 20);
	CHECK(count_shades("7x7") > 2 * narrow);
}

TEST_CASE("[GPU][ShadowMap] a flat lit floor has no acne at any map size or light angle") {
	MaskFixture fixture;
	for (int64_t size : { 64, 256, 2048 }) {
		for (double x : { 0.0, 2.0, 8.0, 40.0 }) {
			SmallScene scene(LightType::DIRECTIONAL);
			scene.box->casts_shadow = false;
			scene.light->parent_from_node = look_at({ x, 4, 0 }, { 0, 0, 0 });
			scene.light->properties["shadow_map_size"] = size;
			const MaskResult result = fixture.render_mask(scene, "shadow_map");
			CAPTURE(size);
			CAPTURE(x);
			CHECK(count_receivers(result) > 100);
			CHECK(result.visibility == result.receiver);
		}
	}
}

TEST_CASE("[GPU][ShadowMap] omni faces meet without a seam") {
	MaskFixture fixture;
	SmallScene scene(LightType::OMNI);
	// The light hangs so low that several of its six views see the floor.
	scene.box->casts_shadow = false;
	scene.light->parent_from_node = look_at({ 0, 1.0, 0 }, { 1, 0.2, 0.3 });
	for (const char *filter : { "hard", "7x7" }) {
		scene.light->properties["shadow_map_filter"] = std::string(filter);
		const MaskResult result = fixture.render_mask(scene, "shadow_map", glm::uvec2(128));
		CHECK(result.visibility == result.receiver);
	}
}

TEST_CASE("[GPU][Views] the error against 128 views falls with the number of views") {
	MaskFixture fixture;
	for (LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		SmallScene scene(type);
		scene.light->properties["views_map_size"] = int64_t(512);
		const auto render = [&](int64_t p_count) {
			scene.light->properties["views_count"] = p_count;
			return fixture.render_mask(scene, "views");
		};
		const MaskResult many = render(128);
		const double error_4 = compute_mask_difference(many, render(4));
		const double error_32 = compute_mask_difference(many, render(32));
		CHECK(error_4 > 0);
		CHECK(error_32 < 0.5 * error_4);
	}
}

TEST_CASE("[GPU][Views] a light without size is drawn once and equals the hard map") {
	MaskFixture fixture;
	SmallScene scene;
	scene.light->properties["light_size"] = 0.0;
	const MaskResult views = fixture.render_mask(scene, "views");
	size_t pass_count = 0;
	for (const PassTiming &timing : views.timings) {
		pass_count += timing.name.find("accumulate") != std::string::npos;
	}
	CHECK(pass_count == 1);
	CHECK(compute_mask_difference(views, fixture.render_mask(scene, "shadow_map")) < 1e-3);
}
