#include "modules/shadow_jittered_pcf/jitter_offsets.h"
#include "modules/shadows/tests/mask_fixture.h"

#include "shadow_jittered_pcf/shadow_jittered_pcf_shared.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

using namespace gnomon;

TEST_CASE("[JitteredPcf] each set starts with the outermost ring and has one tap per cell") {
	const double ROUNDING = 1e-4; // in cells: exceeds that of the float32 offsets
	for (uint32_t ring_count : { 1u, 4u, 8u }) {
		const std::vector<glm::vec4> pairs = build_jitter_offsets(ring_count);
		const uint32_t tap_count = ring_count * JITTERED_PCF_TAPS_PER_RING;
		const uint32_t set_count = JITTERED_PCF_SETS_PER_SIDE * JITTERED_PCF_SETS_PER_SIDE;
		REQUIRE(pairs.size() == set_count * tap_count / 2);
		for (uint32_t tap = 0; tap < set_count * tap_count; ++tap) {
			const glm::vec4 pair = pairs[tap / 2];
			const glm::dvec2 offset =
					tap % 2 == 0 ? glm::dvec2(pair.x, pair.y) : glm::dvec2(pair.z, pair.w);
			const uint32_t ring_from_outside = tap % tap_count / JITTERED_PCF_TAPS_PER_RING;
			const double v = glm::dot(offset, offset) * ring_count;
			CHECK(v <= ring_count - ring_from_outside + ROUNDING);
			CHECK(v >= ring_count - ring_from_outside - 1 - ROUNDING);
			const double turn = std::atan2(offset.y, offset.x) / (2 * std::numbers::pi);
			const double u = (turn < 0 ? turn + 1 : turn) * JITTERED_PCF_TAPS_PER_RING;
			CHECK(std::abs(u - (tap % JITTERED_PCF_TAPS_PER_RING + 0.5)) <= 0.5 + ROUNDING);
		}
		CHECK(build_jitter_offsets(ring_count) == pairs); // the same random numbers each time
	}
}

TEST_CASE("[GPU][JitteredPcf] a larger radius widens the penumbra, and radius 0 makes it hard") {
	MaskFixture fixture;
	for (LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		SmallScene scene(type);
		std::ptrdiff_t before = -1;
		for (double radius : { 0.0, 0.01, 0.04 }) {
			scene.light->properties["jittered_pcf_radius_uv"] = radius;
			const MaskResult mask = fixture.render_mask(scene, "jittered_pcf");
			const auto shades = std::count_if(mask.visibility.begin(), mask.visibility.end(),
					[](float p_value) { return p_value > 0.0f && p_value < 1.0f; });
			CHECK((radius == 0.0 ? shades == 0 : shades > before));
			before = shades;
		}
	}
}

TEST_CASE("[GPU][JitteredPcf] the early out changes few pixels, to fully lit or fully hidden") {
	MaskFixture fixture;
	SmallScene scene;
	scene.light->properties["jittered_pcf_radius_uv"] = 0.02;
	const MaskResult with = fixture.render_mask(scene, "jittered_pcf");
	scene.light->properties["jittered_pcf_early_out"] = false;
	const MaskResult without = fixture.render_mask(scene, "jittered_pcf");
	size_t different_count = 0;
	for (size_t pixel = 0; pixel < with.visibility.size(); ++pixel) {
		const bool is_same = with.visibility[pixel] == without.visibility[pixel];
		different_count += !is_same;
		// Where the filter stopped early, it returned 0 or 1.
		CHECK((is_same || with.visibility[pixel] == 0.0f || with.visibility[pixel] == 1.0f));
	}
	CHECK(different_count < with.visibility.size() / 20);
	CHECK(compute_mask_difference(with, without) < 0.01);
}

TEST_CASE("[GPU][JitteredPcf] the number of rings can change from frame to frame") {
	MaskFixture fixture;
	SmallScene scene;
	const MaskResult eight = fixture.render_mask(scene, "jittered_pcf");
	scene.light->properties["jittered_pcf_rings"] = int64_t(2);
	const MaskResult two = fixture.render_mask(scene, "jittered_pcf");
	CHECK(two.plan.is_skipped("Light", "light view 0")); // the map is cached
	CHECK(two.visibility != eight.visibility);
	CHECK(compute_mask_difference(two, eight) < 0.02);
	scene.light->properties["jittered_pcf_rings"] = int64_t(8);
	CHECK(fixture.render_mask(scene, "jittered_pcf").visibility == eight.visibility);
}
