#include "modules/masks/mask_timing.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <vector>

using namespace gnomon;

namespace {

std::vector<std::string> get_names(const MaskTiming &p_timing) {
	std::vector<std::string> names;
	for (const PassMedians &pass : p_timing.passes) {
		names.push_back(pass.name);
	}
	return names;
}

} // namespace

TEST_CASE("[MaskTiming] the percentile of no value is 0, of one value that value") {
	for (const double fraction : { 0.0, 0.5, 0.9, 1.0 }) {
		CHECK(compute_percentile({}, fraction) == 0);
		CHECK(compute_percentile({ 7.5 }, fraction) == 7.5);
	}
}

TEST_CASE("[MaskTiming] percentiles are interpolated between values in any order") {
	CHECK(compute_percentile({ 3, 1 }, 0.5) == 2);
	CHECK(compute_percentile({ 9, 1, 4 }, 0.5) == 4);
	CHECK(compute_percentile({ 40, 10, 30, 20 }, 0.5) == 25);
	const std::vector<double> eleven = { 10, 0, 1, 9, 2, 8, 3, 7, 4, 6, 5 };
	CHECK(compute_percentile(eleven, 0) == 0);
	CHECK(compute_percentile(eleven, 0.9) == doctest::Approx(9));
	CHECK(compute_percentile(eleven, 0.95) == doctest::Approx(9.5));
	CHECK(compute_percentile(eleven, 1) == 10);
}

TEST_CASE("[MaskTiming] a frame's cost has median and 90th percentile of GPU and wall time") {
	const FrameCost cost = compute_frame_cost({ 1, 3, 2 }, { 10, 30 });
	CHECK(cost.gpu_ms == 2);
	CHECK(cost.gpu_ms_p90 == doctest::Approx(2.8));
	CHECK(cost.wall_ms == 20);
	CHECK(cost.wall_ms_p90 == doctest::Approx(28));
	CHECK(compute_frame_cost({}, {}).wall_ms_p90 == 0);
}

TEST_CASE("[MaskTiming] without frames there are no passes and no cost") {
	const MaskTiming timing = TimingSamples().compute();
	CHECK(timing.frame_count == 0);
	CHECK(timing.passes.empty());
	CHECK(timing.total.gpu_ms == 0);
	CHECK(timing.cost_ms == 0);
}

TEST_CASE("[MaskTiming] passes are ordered as in the first frame that has them") {
	TimingSamples samples;
	samples.add_frame({ { "view 1", 1, 1 }, { "fins", 1, 1 } });
	samples.add_frame({ { "fins", 1, 1 }, { "view 1", 1, 1 }, { "a late pass", 1, 1 } });
	CHECK(samples.get_frame_count() == 2);
	CHECK(get_names(samples.compute()) ==
			std::vector<std::string>{ "view 1", "fins", "a late pass" });
}

TEST_CASE("[MaskTiming] each pass has the median of its frames, the total that of their sums") {
	TimingSamples samples;
	samples.add_frame({ { "depth", 1, 2 }, { "resolve", 9, 10 } });
	samples.add_frame({ { "depth", 5, 6 }, { "resolve", 2, 3 } });
	samples.add_frame({ { "depth", 3, 4 }, { "resolve", 4, 5 } });
	const MaskTiming timing = samples.compute();
	REQUIRE(timing.passes.size() == 2);
	CHECK(timing.frame_count == 3);
	CHECK(timing.passes[0].cost.gpu_ms == 3);
	CHECK(timing.passes[0].cost.wall_ms == 4);
	CHECK(timing.passes[1].cost.gpu_ms == 4);
	CHECK(timing.passes[1].cost.wall_ms == 5);
	// Sums of the frames are 10, 7, 7 and 12, 9, 9. Their 90th percentiles are not the sums of the
	// passes' percentiles.
	CHECK(timing.total.gpu_ms == 7);
	CHECK(timing.total.gpu_ms_p90 == doctest::Approx(9.4));
	CHECK(timing.total.wall_ms == 9);
	CHECK(timing.total.wall_ms_p90 == doctest::Approx(11.4));
	CHECK(timing.cost_ms == 7);
}

TEST_CASE("[MaskTiming] a pass on the CPU costs its wall time, one on the GPU its GPU time") {
	TimingSamples samples;
	samples.add_frame({ { "depth", 1, 50 }, { "trace", 0, 20, true } });
	samples.add_frame({ { "depth", 3, 60 }, { "trace", 0, 30, true } });
	const MaskTiming timing = samples.compute();
	REQUIRE(timing.passes.size() == 2);
	CHECK_FALSE(timing.passes[0].is_on_host);
	CHECK(timing.passes[1].is_on_host);
	CHECK(timing.passes[1].cost.wall_ms == 25);
	CHECK(timing.cost_ms == 27); // (1 + 20 + 3 + 30) / 2
	CHECK(timing.total.gpu_ms == 2);
	CHECK(timing.total.wall_ms == 80);
}

TEST_CASE("[MaskTiming] a pass that some frames lack is 0 in their sums, not in its own median") {
	TimingSamples samples;
	samples.add_frame({ { "depth", 2, 2 } });
	samples.add_frame({ { "depth", 2, 2 }, { "fins", 6, 8 } });
	samples.add_frame({ { "depth", 2, 2 } });
	samples.add_frame({});
	const MaskTiming timing = samples.compute();
	REQUIRE(timing.passes.size() == 2);
	CHECK(timing.frame_count == 4);
	CHECK(timing.passes[1].cost.gpu_ms == 6);
	CHECK(timing.passes[1].cost.wall_ms == 8);
	CHECK(timing.total.gpu_ms == 2); // of 2, 8, 2, 0
	CHECK(timing.total.gpu_ms_p90 == doctest::Approx(6.2));
	CHECK(timing.cost_ms == 2);
}

TEST_CASE("[MaskTiming] the times in JSON have the documented keys in their order") {
	CHECK(to_json(FrameCost{ 0.5, 1.5, 2, 3 }).dump() ==
			R"({"gpu_ms":0.5,"gpu_ms_p90":1.5,"wall_ms":2.0,"wall_ms_p90":3.0})");
	const std::vector<PassMedians> passes = { { "depth", { 0.5, 0.75, 1, 1.5 }, false },
		{ "trace", { 0, 0, 2, 3 }, true } };
	CHECK(to_json(passes).dump() ==
			R"([{"name":"depth","gpu_ms":0.5,"gpu_ms_p90":0.75,"wall_ms":1.0,"wall_ms_p90":1.5,)"
			R"("is_on_host":false},{"name":"trace","gpu_ms":0.0,"gpu_ms_p90":0.0,"wall_ms":2.0,)"
			R"("wall_ms_p90":3.0,"is_on_host":true}])");
	CHECK(to_json(std::vector<PassMedians>()).dump() == "[]");
}

TEST_CASE("[MaskTiming] the median's error shrinks with frames and grows with their spread") {
	const auto measure = [](std::vector<double> p_costs_ms) {
		TimingSamples samples;
		for (const double cost_ms : p_costs_ms) {
			samples.add_frame({ { "pass", cost_ms, cost_ms } });
		}
		return samples.compute_median_error();
	};
	CHECK(measure({}) == 1);
	CHECK(measure({ 5 }) == 1);
	CHECK(measure({ 5, 5, 5 }) == 0);
	const double five = measure({ 8, 9, 10, 11, 12 });
	// The median is 10, the median absolute deviation 1; 5 / 4.2 is the factor for five values.
	CHECK(five == doctest::Approx(1.2533 * 1.4826 * 5 / 4.2 / std::sqrt(5.0) / 10));
	CHECK(measure({ 8, 8, 9, 9, 10, 10, 11, 11, 12, 12 }) < five);
	CHECK(measure({ 6, 8, 10, 12, 14 }) > five);
}
