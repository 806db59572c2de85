// Where a block of pixels has more edges than its list holds, or the light more than its buffers
// do.

#include "modules/shadow_edge_count/block_passes.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

const LightType ALL_TYPES[] = { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI };

/// The line of the plan that begins so; there must be one.
FramePlanEntry find_entry(const RenderResult &p_result, const std::string &p_begin) {
	for (const FramePlanEntry &entry : p_result.plan.get_entries()) {
		if (entry.pass.starts_with(p_begin)) {
			return entry;
		}
	}
	FAIL("no line \"", p_begin, "\" in\n", p_result.plan.to_text());
	return {};
}

/// How many of the pixels the debug view "blocks" shows as filtered: the only class with any blue.
size_t count_filtered_pixels(
		RenderFixture &r_fixture, const SmallScene &p_scene, glm::uvec2 p_size_px) {
	RenderRequest request;
	request.scene = p_scene.snap();
	request.size_px = p_size_px;
	request.technique_override = "edge_count";
	request.wants_image = true;
	request.debug_view = "blocks";
	const std::vector<uint8_t> image = r_fixture.renderer->render(request).image;
	size_t count = 0;
	for (size_t index = 0; index < image.size(); index += 4) {
		count += image[index + 2] > 0 ? 1 : 0;
	}
	return count;
}

/// So many thin plates under the ground that the layer map has no room for them, though nothing
/// that is seen lies in their shadow.
void add_plates_below(SmallScene &r_scene) {
	const auto mesh = make_box_mesh("plate", { 4.0f, 0.002f, 4.0f });
	for (int index = 0; index < 60; ++index) {
		add_mesh(r_scene.scene, text("Plate ", index), mesh, { 0.0, -0.5 - 0.01 * index, 0.0 });
	}
}

} // namespace

TEST_CASE("[EdgeCount] a small picture's few blocks share the memory of a large one's many") {
	const uint32_t standard = COUNT_DEFAULT_BUDGET;
	const glm::uvec2 small_px(128);
	const glm::uvec2 large_px(1920, 1080);
	CHECK(choose_budget(small_px, standard, 1000000) == COUNT_MOST_BUDGET);
	CHECK(choose_budget(small_px, standard, 20000) == 32768); // no more than there may be
	CHECK(choose_budget(small_px, standard, 10) == standard);
	CHECK(choose_budget(small_px, 100, 1000000) == 100); // wanted so
	CHECK(choose_budget(small_px, 0, 1000000) == 0);
	for (const glm::uvec2 size_px : { small_px, glm::uvec2(256), glm::uvec2(630, 393), large_px }) {
		const uint32_t budget = choose_budget(size_px, standard, 1000000);
		CAPTURE(size_px.x);
		CHECK(budget >= standard);
		CHECK(choose_groups_per_block_side(size_px, budget) ==
				choose_groups_per_block_side(size_px, standard));
	}
}

TEST_CASE("[GPU][EdgeCount] a block with more edges than its budget is filtered, and said to be") {
	RenderFixture fixture;
	const FrameWishes wishes;
	SmallScene scene;
	add_mesh(scene.scene, "Globe", make_count_sphere(0.45, 40), { -0.8, 1.0, 0.6 });
	scene.light->properties["light_size"] = 0.3;
	const RenderResult counted = render_frame(fixture, scene, wishes);
	const FramePlanEntry left_out = find_entry(counted, "filter where");
	CHECK_FALSE(left_out.runs);
	CHECK(left_out.pass == "filter where a block has more than 8192 edges");
	CHECK(left_out.reason.starts_with("all casters together have "));
	CHECK(count_filtered_pixels(fixture, scene, wishes.size_px) == 0);

	scene.light->properties["edge_count_budget"] = int64_t(64);
	const RenderResult filtered = render_frame(fixture, scene, wishes);
	CHECK(find_entry(filtered, "filter where").runs);
	CHECK(find_entry(filtered, "filter where").pass ==
			"filter where a block has more than 64 edges");
	const size_t filtered_count = count_filtered_pixels(fixture, scene, wishes.size_px);
	CHECK(filtered_count > 256);
	CHECK(filtered_count < size_t(wishes.size_px.x) * wishes.size_px.y / 2);
	const MaskDifference difference = compare_masks(filtered.visibility, counted);
	CHECK(difference.mean > 0.0);
	CHECK(difference.mean < 0.01);
	CHECK(difference.penumbra_mean < 0.06);

	// Room for no edge at all: everything that may lie beside a shadow's edge is filtered.
	scene.light->properties["edge_count_budget"] = int64_t(0);
	const RenderResult all_filtered = render_frame(fixture, scene, wishes);
	CHECK(count_filtered_pixels(fixture, scene, wishes.size_px) > filtered_count);
	CHECK(compare_masks(all_filtered.visibility, counted).mean < 0.01);
}

TEST_CASE("[GPU][EdgeCount] a light with many layers has room for them from its first frame on") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		CAPTURE(int(type));
		RenderFixture fixture;
		SmallScene scene(type);
		scene.light->properties["edge_count_map_size"] = int64_t(64);
		add_plates_below(scene);
		const FrameWishes wishes = { .size_px = glm::uvec2(48), .wants_surfaces = true };
		const RenderResult first = render_frame(fixture, scene, wishes);
		const MaskDifference counted =
				compare_masks(first.visibility, count_in_double(scene, first));
		CHECK(counted.mean < 3e-5);
		CHECK(counted.apart_count == 0);
		CHECK(counted.penumbra_count > 40);
		CHECK_FALSE(find_entry(first, "filter where").runs);
	}
}

TEST_CASE("[GPU][EdgeCount] where layers cannot be told beforehand, a light without room filters") {
	RenderFixture fixture;
	SmallScene scene;
	scene.light->properties["edge_count_map_size"] = int64_t(64);
	add_plates_below(scene);
	// More faces than are looked at one by one.
	add_mesh(scene.scene, "Fine globe", make_count_sphere(0.3, 80), { 0, 2.0, 0.9 });
	const FrameWishes wishes = { .size_px = glm::uvec2(48), .wants_surfaces = true };
	const RenderResult first = render_frame(fixture, scene, wishes);
	const RenderResult truth = count_in_double(scene, first);
	const MaskDifference filtered = compare_masks(first.visibility, truth);
	CHECK(find_entry(first, "filter where").runs);
	CHECK(filtered.mean > 2e-4); // else there was room for all
	CHECK(filtered.mean < 0.02);
	// Then there is room, and that stays.
	for (const bool may_keep : { true, true, false }) {
		CAPTURE(may_keep);
		const MaskDifference counted = compare_masks(
				render_frame(fixture, scene, { .size_px = wishes.size_px, .may_keep = may_keep })
						.visibility,
				truth);
		CHECK(counted.mean < 1e-4);
		CHECK(counted.penumbra_count > 40);
	}
	CHECK(count_filtered_pixels(fixture, scene, wishes.size_px) == 0);
}

TEST_CASE("[GPU][EdgeCount] a small layer map does nearly as well as a large one") {
	RenderFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(int(type));
		SmallScene scene(type);
		add_globe(scene);
		// It stands in the ground: where they meet the texel that is asked matters most.
		add_mesh(scene.scene, "Half globe", make_count_sphere(0.4, 16), { 0.5, 0.05, 0.9 });
		scene.light->properties["edge_count_map_size"] = int64_t(512);
		const RenderResult large = render_frame(fixture, scene);
		scene.light->properties["edge_count_map_size"] = int64_t(64);
		const RenderResult small = render_frame(fixture, scene);
		const MaskDifference difference = compare_masks(small.visibility, large);
		CHECK(find_entry(small, "find edges").runs);
		CHECK(difference.penumbra_count > 50);
		CHECK(difference.mean < 0.002);
	}
}
