#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon {

/// What one pass of one frame took, in milliseconds.
struct PassCost {
	std::string name;
	double gpu_ms = 0;
	double wall_ms = 0;
	bool is_on_host = false; // it runs on the CPU: gpu_ms is 0
};

/// What something costs over the frames of a measurement: medians and 90th percentiles, in
/// milliseconds.
struct FrameCost {
	double gpu_ms = 0;
	double gpu_ms_p90 = 0;
	double wall_ms = 0;
	double wall_ms_p90 = 0;
};

struct PassMedians {
	std::string name;
	FrameCost cost;
	bool is_on_host = false;
};

/// What one light's mask costs.
struct MaskTiming {
	uint32_t frame_count = 0;
	std::vector<PassMedians> passes; // in the order in which they run
	FrameCost total;				 // sums over the passes of a frame
	/// The time to compare techniques by: sums of each pass's GPU time, or wall time on the CPU.
	double cost_ms = 0;
};

/// The value that a share of the values does not exceed, interpolated; 0 without values.
double compute_percentile(std::vector<double> p_values, double p_share);

/// Collects the passes of frame after frame.
class TimingSamples {
public:
	/// Passes of one frame. The first frame that has a pass decides its position.
	void add_frame(const std::vector<PassCost> &p_passes);
	uint32_t get_frame_count() const { return static_cast<uint32_t>(costs_ms.size()); }
	/// Standard error of cost_ms as a share of it, from the spread of the frames: 1.2533 times that
	/// of the mean, with the median of the distances from the median as spread. 1 below two frames.
	double compute_median_error() const;
	MaskTiming compute() const;

private:
	struct Values {
		std::string name;
		std::vector<double> gpu_ms = {};
		std::vector<double> wall_ms = {};
		bool is_on_host = false;
	};
	std::vector<Values> passes; // in the order in which they run
	Values totals;
	std::vector<double> costs_ms;
};

FrameCost compute_frame_cost(
		const std::vector<double> &p_gpu_ms, const std::vector<double> &p_wall_ms);

// As doc/command_line.md and doc/report_format.md describe them.
nlohmann::ordered_json to_json(const FrameCost &p_cost);
nlohmann::ordered_json to_json(const std::vector<PassMedians> &p_passes);

} // namespace gnomon
