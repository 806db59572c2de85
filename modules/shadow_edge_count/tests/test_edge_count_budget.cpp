// Blocks of pixels that have more edges than the budget, edge lists and face lists that do not fit,
// and the size of the maps that have the face lists.

#include "modules/shadow_edge_count/block_passes.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace gnomon;

namespace {

const LightType ALL_TYPES[] = { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI };

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

/// Number of pixels in blocks of a kind, EDGE_COUNT_BLOCKS_*.
size_t count_pixels(
		MaskFixture &r_fixture, const SmallScene &p_scene, glm::uvec2 p_size_px, int p_kind) {
	MaskRequest request;
	request.scene = p_scene.snap();
	request.size_px = p_size_px;
	request.technique_override = "edge_count";
	request.debug_view = "blocks";
	const std::vector<float> kinds = r_fixture.render(request).debug_values;
	return size_t(std::count(kinds.begin(), kinds.end(), float(p_kind)));
}

/// A mesh of stacked triangles, each as large as the scene, below its ground.
std::shared_ptr<const Mesh> make_floors(uint32_t p_count) {
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	for (uint32_t index = 0; index < p_count; ++index) {
		const float y = -1.0f - 1e-4f * float(index);
		for (const glm::vec3 &corner :
				{ glm::vec3(-4, y, -4), glm::vec3(4, y, -4), glm::vec3(0, y, 4) }) {
			indices.push_back(uint32_t(positions.size()));
			positions.push_back(corner);
		}
	}
	return make_mesh("floors", std::move(positions), {}, std::move(indices));
}

} // namespace

TEST_CASE("[EdgeCount] edge lists are large enough for small images, and at most 24 MB") {
	// 128 x 128 pixels are 256 blocks. Each may have all edges, rounded up to a power of two, but
	// 2048 on average at most. An edge takes 4 bytes.
	CHECK(choose_chunk_capacity({ 128, 128 }, 100) == 256 * 128 / EDGE_COUNT_CHUNK_SIZE);
	CHECK(choose_chunk_capacity({ 128, 128 }, 1'000'000) == 256 * 2048 / EDGE_COUNT_CHUNK_SIZE);
	CHECK(choose_chunk_capacity({ 8192, 8192 }, 1'000'000) == 6'000'000 / EDGE_COUNT_CHUNK_SIZE);
	CHECK(choose_chunk_capacity({ 1, 1 }, 0) >= 1);
}

TEST_CASE("[GPU][EdgeCount] a block with more edges than its budget is filtered, as the plan "
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
		CHECK(count_pixels(fixture, scene, options.size_px, EDGE_COUNT_BLOCKS_FILTERED) == 0);
		// 256 pixels are 4 blocks.
		CHECK(count_pixels(fixture, scene, options.size_px, EDGE_COUNT_BLOCKS_LISTED) > 256);

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
				"filter where a block has more than 64 edges");
		const size_t filtered_count =
				count_pixels(fixture, scene, options.size_px, EDGE_COUNT_BLOCKS_FILTERED);
		CHECK(filtered_count >= 256);
		CHECK(filtered_count < size_t(options.size_px.x) * options.size_px.y / 2);
		const MaskDifference difference = compare_masks(filtered.visibility, counted);
		CHECK(difference.mean > 0.0);
		CHECK(difference.mean < 0.01);
		CHECK(difference.penumbra_mean < 0.08);
		CHECK(filtered.visibility == render_frame(fixture, scene, options).visibility); // reused
		const FrameOptions uncached = { .may_reuse = false };
		CHECK(filtered.visibility == render_frame(fixture, scene, uncached).visibility);

		// With a budget of 0, every block that has an edge is filtered.
		scene.light->properties["edge_count_budget"] = int64_t(0);
		const MaskResult all_filtered = render_frame(fixture, scene, options);
		CHECK(count_pixels(fixture, scene, options.size_px, EDGE_COUNT_BLOCKS_FILTERED) >
				filtered_count);
		CHECK(count_pixels(fixture, scene, options.size_px, EDGE_COUNT_BLOCKS_LISTED) == 0);
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

TEST_CASE("[GPU][EdgeCount] blocks whose lists do not fit are counted as exactly as others") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		add_mesh(scene.scene, "Globe", make_count_sphere(0.5, 96), { -0.3, 1.2, 0.3 });
		scene.light->properties["light_size"] = 1.5;
		scene.light->properties["edge_count_quality"] = std::string("64");
		const FrameOptions options = { .size_px = glm::uvec2(32), .wants_surfaces = true };
		CHECK(count_pixels(fixture, scene, options.size_px, EDGE_COUNT_BLOCKS_UNLISTED) > 0);
		const MaskResult frame = render_frame(fixture, scene, options);
		const MaskDifference difference =
				compare_masks(frame.visibility, count_in_double(scene, frame));
		CHECK(difference.penumbra_count > 200);
		CHECK(difference.mean < 3e-4);
		CHECK(difference.maximum < 0.05);
	}
}

TEST_CASE("[GPU][EdgeCount] face lists that do not fit are rebuilt within the first frame") {
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		std::vector<float> masks[2];
		for (const bool has_floors : { false, true }) {
			MaskFixture fixture; // so that each frame is the first one
			SmallScene scene(type);
			scene.light->properties["edge_count_map_size"] = int64_t(16);
			if (has_floors) {
				// More than MAX_BOUNDED_FACES of count_casters.cpp. Each covers much of the map.
				add_mesh(scene.scene, "Floors", make_floors(21'000), {});
			}
			const FrameOptions options = { .size_px = glm::uvec2(48) };
			const MaskResult frame = render_frame(fixture, scene, options);
			masks[has_floors ? 1 : 0] = frame.visibility;
			if (has_floors) {
				CHECK(find_entry(frame, "face lists again with larger texels").runs);
			}
		}
		CHECK(std::count(masks[0].begin(), masks[0].end(), 1.0f) > 100);
		CHECK(std::count(masks[0].begin(), masks[0].end(), 0.0f) > 20);
		// The floors are below everything visible, so they cast no visible shadow.
		size_t mismatch_count = 0;
		for (size_t index = 0; index < masks[0].size(); ++index) {
			mismatch_count += std::abs(masks[0][index] - masks[1][index]) > 1e-3f ? 1 : 0;
		}
		CHECK(mismatch_count == 0);
	}
}

TEST_CASE("[GPU][EdgeCount] in a small scene the size of the map changes no bit of the mask") {
	// In others it changes pixels by rounding: see edge_count_maps in doc/benchmarks.md.
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		add_globe(scene);
		add_mesh(scene.scene, "Half globe", make_count_sphere(0.4, 16), { 0.5, 0.05, 0.9 });
		std::vector<float> expected;
		for (const int64_t map_size_px : { 256, 16, 48, 1024 }) {
			CAPTURE(map_size_px);
			scene.light->properties["edge_count_map_size"] = map_size_px;
			const MaskResult frame = render_frame(fixture, scene);
			CHECK(find_entry(frame, "find edges").runs);
			expected = expected.empty() ? frame.visibility : expected;
			CHECK(frame.visibility == expected);
		}
	}
}
