// Leaves that have more edges than the budget, and lists that do not fit.

#include "modules/shadow_edge_count/leaf_passes.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace gnomon;

namespace {

/// The first entry of the plan that starts with p_begin. The test fails if there is none.
FramePlanEntry find_entry(const MaskResult &p_result, const std::string &p_begin) {
	for (const FramePlanEntry &entry : p_result.plan.get_entries()) {
		if (entry.pass.starts_with(p_begin)) {
			return entry;
		}
	}
	FAIL("no line \"", p_begin, "\" in\n", p_result.plan.to_text());
	return {};
}

/// Number of receivers in leaves of a kind, EDGE_COUNT_LEAVES_*.
size_t count_pixels(
		MaskFixture &r_fixture, const SmallScene &p_scene, glm::uvec2 p_size_px, int p_kind) {
	MaskRequest request;
	request.scene = p_scene.snap();
	request.size_px = p_size_px;
	request.technique_override = "edge_count";
	request.debug_view = "leaves";
	const std::vector<float> kinds = r_fixture.render(request).debug_values;
	return size_t(std::count(kinds.begin(), kinds.end(), float(p_kind)));
}

} // namespace

TEST_CASE("[EdgeCount] lists are large enough for small images, and take at most 23 MB") {
	// 128 x 128 pixels are 256 blocks. Each may have all faces and edges, rounded up to a power of
	// two, but 2048 on average at most. A word takes 4 bytes.
	CHECK(choose_list_capacity({ 128, 128 }, 100) == 256 * 128);
	CHECK(choose_list_capacity({ 128, 128 }, 1'000'000) == 256 * 2048);
	CHECK(choose_list_capacity({ 8192, 8192 }, 1'000'000) == 5'700'000);
	CHECK(choose_list_capacity({ 1, 1 }, 0) >= 1);
}

TEST_CASE("[GPU][EdgeCount] a leaf with more edges than its budget is filtered, as the plan "
		  "reports") {
	MaskFixture fixture;
	const FrameOptions options;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		add_mesh(scene.scene, "Globe", make_count_sphere(0.45, 40), { -0.8, 1.0, 0.6 });
		scene.light->properties["light_size"] = 0.3;
		const MaskResult counted = render_frame(fixture, scene, options);
		CHECK_FALSE(find_entry(counted, "filter").runs);
		CHECK(find_entry(counted, "filter").reason.starts_with("edge_count_budget is -1"));
		CHECK(count_pixels(fixture, scene, options.size_px, EDGE_COUNT_LEAVES_FILTERED) == 0);
		// As many receivers as 4 blocks of pixels have.
		CHECK(count_pixels(fixture, scene, options.size_px, EDGE_COUNT_LEAVES_LISTED) > 256);

		scene.light->properties["edge_count_budget"] = int64_t(65536);
		const MaskResult unlimited = render_frame(fixture, scene, options);
		CHECK_FALSE(find_entry(unlimited, "filter where").runs);
		CHECK(find_entry(unlimited, "filter where")
						.reason.starts_with("all casters together have"));
		CHECK(unlimited.visibility == counted.visibility);

		scene.light->properties["edge_count_budget"] = int64_t(64);
		const MaskResult filtered = render_frame(fixture, scene, options);
		CHECK(find_entry(filtered, "filter where").runs);
		CHECK(find_entry(filtered, "filter where").pass ==
				"filter where there are more than 64 edges");
		const size_t filtered_count =
				count_pixels(fixture, scene, options.size_px, EDGE_COUNT_LEAVES_FILTERED);
		CHECK(filtered_count >= 128);
		CHECK(filtered_count < size_t(options.size_px.x) * options.size_px.y / 2);
		const MaskDifference difference = compare_masks(filtered.visibility, counted);
		CHECK(difference.mean > 0.0);
		CHECK(difference.mean < 0.01);
		CHECK(difference.penumbra_mean < 0.08);
		CHECK(filtered.visibility == render_frame(fixture, scene, options).visibility); // reused
		const FrameOptions uncached = { .may_reuse = false };
		CHECK(filtered.visibility == render_frame(fixture, scene, uncached).visibility);

		// With a budget of 0, all that has an edge is filtered.
		scene.light->properties["edge_count_budget"] = int64_t(0);
		const MaskResult all_filtered = render_frame(fixture, scene, options);
		CHECK(count_pixels(fixture, scene, options.size_px, EDGE_COUNT_LEAVES_FILTERED) >
				filtered_count);
		CHECK(count_pixels(fixture, scene, options.size_px, EDGE_COUNT_LEAVES_LISTED) == 0);
		CHECK(compare_masks(all_filtered.visibility, counted).mean < 0.01);
	}
}

TEST_CASE("[GPU][EdgeCount] with any budget an omni light's mask stays close to the counted one") {
	MaskFixture fixture;
	SmallScene scene(LightType::OMNI);
	scene.light->properties["light_size"] = 1.0;
	const FrameOptions options = { .size_px = glm::uvec2(16) };
	const MaskResult counted = render_frame(fixture, scene, options);
	for (const int64_t budget : { 8, 16, 24, 32, 48, 64, 128 }) {
		CAPTURE(budget);
		scene.light->properties["edge_count_budget"] = budget;
		CHECK(compare_masks(render_frame(fixture, scene, options).visibility, counted).mean < 0.1);
	}
}

TEST_CASE("[GPU][EdgeCount] leaves whose lists do not fit are counted as exactly as others") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		add_mesh(scene.scene, "Globe", make_count_sphere(0.5, 96), { -0.3, 1.2, 0.3 });
		scene.light->properties["light_size"] = 1.5;
		scene.light->properties["edge_count_quality"] = std::string("64");
		const FrameOptions options = { .size_px = glm::uvec2(32), .wants_surfaces = true };
		CHECK(count_pixels(fixture, scene, options.size_px, EDGE_COUNT_LEAVES_UNLISTED) > 0);
		const MaskResult frame = render_frame(fixture, scene, options);
		const MaskDifference difference =
				compare_masks(frame.visibility, count_in_double(scene, frame));
		CHECK(difference.penumbra_count > 200);
		CHECK(difference.mean < 3e-4);
		CHECK(difference.maximum < 0.05);
	}
}
