#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon {

/// The time of one pass of one frame, in milliseconds.
struct PassCost {
	std::string name;
	double gpu_ms = 0;
	double wall_ms = 0;		 // from the start of recording to the end of the pass
	bool is_on_host = false; // it runs on the CPU: gpu_ms is 0
};

/// The cost over the frames of a measurement: medians and 90th percentiles, in milliseconds.
struct FrameCost {
	double gpu_ms = 0;
	double gpu_ms_p90 = 0;
	double wall_ms = 0;
	double wall_ms_p90 = 0;
};

/// The cost of one pass over the frames of a measurement.
struct PassMedians {
	std::string name;
	FrameCost cost;
	bool is_on_host = false;
};

/// The cost of one light's mask.
struct MaskTiming {
	uint32_t frame_count = 0;
	std::vector<PassMedians> passes; // in execution order
	FrameCost total;				 // of the frames' sums over their passes
	/// The time for comparing techniques, in ms: the median over the frames of the sum of each
	/// pass's GPU time, or of its wall time if it runs on the CPU.
	double cost_ms = 0;
};

/// Returns the value at a fraction 0..1 of the sorted values, interpolated; 0 without values.
double compute_percentile(std::vector<double> p_values, double p_fraction);

/// Collects the pass times of successive frames.
class TimingSamples {
public:
	/// Adds the passes of one frame. The first frame that contains a pass decides its position in
	/// MaskTiming::passes.
	void add_frame(const std::vector<PassCost> &p_passes);
	uint32_t get_frame_count() const { return static_cast<uint32_t>(costs_ms.size()); }
	/// Estimates the relative standard error of MaskTiming::cost_ms, a median: 1.2533 times that of
	/// the mean, with the standard deviation estimated from the median absolute deviation. Returns
	/// 1 if there are fewer than two frames or cost_ms is 0.
	double compute_median_error() const;
	/// Computes the cost over all frames so far.
	MaskTiming compute() const;

private:
	struct Values {
		std::string name;
		std::vector<double> gpu_ms = {};
		std::vector<double> wall_ms = {};
		bool is_on_host = false;
	};
	std::vector<Values> passes;	  // in execution order
	Values totals;				  // sums over the passes of each frame
	std::vector<double> costs_ms; // one per frame, see MaskTiming::cost_ms
};

/// Computes the medians and 90th percentiles of times in milliseconds.
FrameCost compute_frame_cost(
		const std::vector<double> &p_gpu_ms, const std::vector<double> &p_wall_ms);

/// Format costs as doc/command_line.md and doc/report_format.md describe.
nlohmann::ordered_json to_json(const FrameCost &p_cost);
nlohmann::ordered_json to_json(const std::vector<PassMedians> &p_passes);

} // namespace gnomon
