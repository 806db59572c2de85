// Lights with a time budget: the ladder of leaves, what each rung does to the mask, and the rate
// that is learned from the times of frames.

#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// edge_count with a chosen limit in place of one that depends on the times of earlier frames.
class LimitedEdgeCount : public ShadowEdgeCount {
protected:
	uint32_t find_cost_limit() const override { return limit; }

public:
	static inline uint32_t limit = EDGE_COUNT_NO_COST_LIMIT;
};

SmallScene make_costly_scene(LightType p_type, const char *p_quality) {
	SmallScene scene(p_type);
	add_mesh(scene.scene, "Globe", make_count_sphere(0.45, 120), { -0.8, 1.0, 0.6 });
	add_mesh(scene.scene, "Second globe", make_count_sphere(0.5, 80), { 0.5, 0.9, 0.4 });
	scene.light->properties["light_size"] = 0.5;
	scene.light->properties["light_angular_distance"] = 10.0;
	scene.light->properties["edge_count_quality"] = std::string(p_quality);
	scene.light->properties["edge_count_interpolation"] = 0.0;
	return scene;
}

/// The numbers in the plan's line about rungs: leaves that are full, with 64 points, with 16 of 64
/// pixels, filtered. Empty if it has none.
std::vector<int> find_rungs(const MaskResult &p_result) {
	for (const FramePlanEntry &entry : p_result.plan.get_entries()) {
		std::vector<int> counts(4);
		if (std::sscanf(entry.pass.c_str(),
					"within %*f ms, leaves in the frame before: full %d, 64 points %d, 16 of 64 "
					"pixels %d, filtered %d",
					&counts[0], &counts[1], &counts[2], &counts[3]) == 4) {
			return counts;
		}
	}
	return {};
}

/// The mask of the second of two equal frames, which reports the rungs of the first.
MaskResult render_limited(MaskFixture &r_fixture, SmallScene &r_scene, uint32_t p_limit) {
	LimitedEdgeCount::limit = p_limit;
	r_scene.light->properties["edge_count_time_budget"] = 1000.0;
	render_frame(r_fixture, r_scene);
	return render_frame(r_fixture, r_scene);
}

} // namespace

TEST_CASE("[GPU][EdgeCount] with time for everything the mask is that without a time budget") {
	const ReplacedTechnique<LimitedEdgeCount> technique;
	for (const char *quality : { "64", "256" }) {
		CAPTURE(std::string(quality));
		MaskFixture fixture;
		SmallScene scene = make_costly_scene(LightType::SPOT, quality);
		const MaskResult expected = render_frame(fixture, scene);
		CHECK(find_rungs(expected).empty());
		const MaskResult limited = render_limited(fixture, scene, EDGE_COUNT_NO_COST_LIMIT);
		CHECK(limited.visibility == expected.visibility);
		const std::vector<int> rungs = find_rungs(limited);
		REQUIRE(rungs.size() == 4);
		CHECK(rungs[0] > 20);
		CHECK(rungs[1] + rungs[2] + rungs[3] == 0);
		CHECK(expected.plan.to_text().find("filter: skipped") != std::string::npos);
		CHECK(limited.plan.to_text().find("filter: skipped") == std::string::npos);
	}
}

TEST_CASE("[GPU][EdgeCount] with less time more leaves have fewer points, fewer pixels, or are "
		  "filtered") {
	const ReplacedTechnique<LimitedEdgeCount> technique;
	for (const LightType type : { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI }) {
		CAPTURE(std::string(get_light_type_name(type)));
		MaskFixture fixture;
		SmallScene few_points = make_costly_scene(type, "64");
		const MaskResult coarse = render_frame(fixture, few_points);
		SmallScene scene = make_costly_scene(type, "256");
		const MaskResult fine = render_frame(fixture, scene);
		bool are_all_seen[4] = {};
		double last_error = 0;
		for (uint32_t limit = 25'000; limit >= 250; limit = limit * 4 / 5) {
			CAPTURE(limit);
			const MaskResult limited = render_limited(fixture, scene, limit);
			const std::vector<int> rungs = find_rungs(limited);
			REQUIRE(rungs.size() == 4);
			for (size_t rung = 0; rung < rungs.size(); ++rung) {
				are_all_seen[rung] = are_all_seen[rung] || rungs[rung] > 0;
			}
			const MaskDifference difference = compare_masks(limited.visibility, fine);
			CHECK(difference.mean < 0.02);
			CHECK(difference.mean >= 0.5 * last_error); // grows, but for chance
			last_error = difference.mean;
			if (rungs[2] + rungs[3] == 0) { // each leaf has the mask of one of both qualities
				size_t other_count = 0;
				for (size_t index = 0; index < limited.visibility.size(); ++index) {
					other_count += limited.visibility[index] != fine.visibility[index] &&
							limited.visibility[index] != coarse.visibility[index];
				}
				CHECK(other_count == 0);
			}
		}
		CHECK(last_error > 0);
		for (const bool is_seen : are_all_seen) {
			CHECK(is_seen);
		}
	}
}

TEST_CASE("[GPU][EdgeCount] with time for everything, leaves without lists are counted too") {
	const ReplacedTechnique<LimitedEdgeCount> technique;
	for (const char *quality : { "64", "256" }) {
		CAPTURE(std::string(quality));
		MaskFixture fixture;
		SmallScene scene(LightType::OMNI); // lists have no room for all its edges
		add_mesh(scene.scene, "Globe", make_count_sphere(0.5, 96), { -0.3, 1.2, 0.3 });
		scene.light->properties["light_size"] = 1.5;
		scene.light->properties["edge_count_quality"] = std::string(quality);
		const FrameOptions options = { .size_px = glm::uvec2(32) };
		const MaskResult expected = render_frame(fixture, scene, options);
		LimitedEdgeCount::limit = EDGE_COUNT_NO_COST_LIMIT;
		scene.light->properties["edge_count_time_budget"] = 1000.0;
		CHECK(render_frame(fixture, scene, options).visibility == expected.visibility);
		LimitedEdgeCount::limit = 0; // and with none, they are filtered
		render_frame(fixture, scene, options);
		const MaskResult filtered = render_frame(fixture, scene, options);
		const std::vector<int> rungs = find_rungs(filtered);
		REQUIRE(rungs.size() == 4);
		CHECK(rungs[3] > 0);
		CHECK(compare_masks(filtered.visibility, expected).mean < 0.2);
	}
}

TEST_CASE("[GPU][EdgeCount] a light with 64 points has no rung of fewer points") {
	const ReplacedTechnique<LimitedEdgeCount> technique;
	MaskFixture fixture;
	SmallScene scene = make_costly_scene(LightType::SPOT, "64");
	for (uint32_t limit = 1u << 15; limit >= 1u << 6; limit /= 4) {
		CAPTURE(limit);
		const std::vector<int> rungs = find_rungs(render_limited(fixture, scene, limit));
		REQUIRE(rungs.size() == 4);
		CHECK(rungs[1] == 0);
	}
}

TEST_CASE("[GPU][EdgeCount] the ladder stays where it is while the cost is near the limit") {
	const ReplacedTechnique<LimitedEdgeCount> technique;
	MaskFixture fixture;
	SmallScene scene = make_costly_scene(LightType::SPOT, "256");
	// Down to a limit, then limits that are a little higher: nothing changes. A much higher one
	// does.
	const uint32_t limit = 10'000;
	const MaskResult low = render_limited(fixture, scene, limit);
	const std::vector<int> rungs = find_rungs(low);
	REQUIRE(rungs.size() == 4);
	REQUIRE(rungs[1] + rungs[2] + rungs[3] > 0);
	for (const double factor : { 1.1, 1.0, 1.15, 1.0 }) {
		CHECK(render_limited(fixture, scene, uint32_t(factor * limit)).visibility ==
				low.visibility);
	}
	CHECK(render_limited(fixture, scene, EDGE_COUNT_NO_COST_LIMIT).visibility != low.visibility);
	// Nothing of earlier frames is used where that is not wanted.
	LimitedEdgeCount::limit = limit;
	const MaskResult fresh = render_frame(fixture, scene, { .may_reuse = false });
	CHECK(render_frame(fixture, scene, { .may_reuse = false }).visibility == fresh.visibility);
}

TEST_CASE("[GPU][EdgeCount] a time of 0.1 ms filters all leaves with many edges") {
	MaskFixture fixture;
	SmallScene scene = make_costly_scene(LightType::SPOT, "256");
	scene.light->properties["edge_count_time_budget"] = 0.1;
	MaskResult result;
	for (int frame = 0; frame < 4; ++frame) {
		result = render_frame(fixture, scene);
	}
	const std::vector<int> rungs = find_rungs(result);
	REQUIRE(rungs.size() == 4);
	CHECK(rungs[1] + rungs[2] == 0);
	CHECK(rungs[3] > 0);
}

TEST_CASE("[EdgeCount] the cost for which there is time follows the times of frames") {
	CountTimeBudget budget(/*p_runs_on_cpu=*/false);
	const uint32_t guess = budget.find_cost_limit(4.0);
	CHECK(guess > 0);
	const std::vector<PassTiming> slow = { { "Lamp: list leaves", 1.0 }, { "Lamp: resolve", 9.0 },
		{ "Lamp: resolve dark", 0.5 }, { "Lamp: filter", 1.0 } };
	budget.learn(slow, 100'000); // 10,000 a ms, and 1.5 ms for other passes
	CHECK(budget.find_cost_limit(4.0) == 25'000);
	CHECK(budget.find_cost_limit(1.0) == 0);
	budget.learn(slow, 105'000); // as much as noise
	CHECK(budget.find_cost_limit(4.0) == 25'000);
	for (int frame = 0; frame < 20; ++frame) {
		budget.learn(slow, 200'000); // another scene, counted in half the time
	}
	CHECK(budget.find_cost_limit(4.0) > 40'000);
	CHECK(budget.find_cost_limit(4.0) < 52'000);
	const uint32_t before = budget.find_cost_limit(4.0);
	budget.learn({}, 200'000); // a device without timestamps
	budget.learn(slow, 0);	   // a frame without edges
	CHECK(budget.find_cost_limit(4.0) == before);
}
