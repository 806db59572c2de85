#include "modules/masks/mask_metrics.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gnomon {

namespace {

constexpr float UMBRA_OVER_REFERENCE = 0.05f; // visibly lit in the reference ...
constexpr float UMBRA_OVER_RESULT = 0.01f;	  // ... and black in the result
constexpr double PERCENTILE = 0.99;
constexpr float WRONG_ERROR = 0.2f; // float, like the masks: an error of 0.2f is not above it

/// Throws if a pixel is not finite.
void check_finite(const MaskImage &p_image, const std::string &p_name) {
	GNOMON_ASSERT(p_image.visibility.size() == p_image.get_pixel_count() &&
					p_image.receiver.size() == p_image.get_pixel_count(),
			p_name, ": values do not match the size");
	for (size_t i = 0; i < p_image.get_pixel_count(); ++i) {
		if (!std::isfinite(p_image.visibility[i]) || !std::isfinite(p_image.receiver[i])) {
			fail("Mask ", p_name, ": pixel (", i % p_image.size_px.x, ", ", i / p_image.size_px.x,
					") is visibility ", p_image.visibility[i], ", receiver ", p_image.receiver[i],
					", must be finite. The technique that wrote it has a bug.");
		}
	}
}

/// Throws unless both masks are finite and have the same size and receiver pixels.
void check_pair(const MaskImage &p_reference, const MaskImage &p_result,
		const std::string &p_reference_name, const std::string &p_result_name) {
	if (p_reference.size_px != p_result.size_px) {
		fail("Masks differ in size: ", p_reference_name, " is ", p_reference.size_px.x, " x ",
				p_reference.size_px.y, ", ", p_result_name, " is ", p_result.size_px.x, " x ",
				p_result.size_px.y, ". Render both with the same --size.");
	}
	check_finite(p_reference, p_reference_name);
	check_finite(p_result, p_result_name);
	size_t different_count = 0;
	size_t first = 0;
	for (size_t i = 0; i < p_reference.get_pixel_count(); ++i) {
		if (p_reference.is_receiver(i) != p_result.is_receiver(i)) {
			first = different_count == 0 ? i : first;
			++different_count;
		}
	}
	if (different_count > 0) {
		fail("Masks differ in their receivers: ", different_count, " pixels, the first at (",
				first % p_reference.size_px.x, ", ", first / p_reference.size_px.x, "), of ",
				p_reference_name, " and ", p_result_name,
				". Render both with the same scene, light and camera.");
	}
}

/// Accumulates the errors of a set of pixels.
class ErrorAccumulator {
public:
	void add(double p_error) {
		absolute_errors.push_back(std::abs(p_error));
		sum += p_error;
		absolute_sum += std::abs(p_error);
		square_sum += p_error * p_error;
		wrong_count += std::abs(p_error) > WRONG_ERROR ? 1 : 0;
	}
	ErrorMetrics finish() {
		ErrorMetrics metrics;
		metrics.pixel_count = absolute_errors.size();
		if (absolute_errors.empty()) {
			return metrics;
		}
		const double count = static_cast<double>(absolute_errors.size());
		metrics.mae = absolute_sum / count;
		metrics.rmse = std::sqrt(square_sum / count);
		metrics.bias = sum / count;
		metrics.wrong = static_cast<double>(wrong_count) / count;
		const size_t rank = std::max<size_t>(1, static_cast<size_t>(std::ceil(PERCENTILE * count)));
		const auto nth = absolute_errors.begin() + static_cast<ptrdiff_t>(rank - 1);
		std::nth_element(absolute_errors.begin(), nth, absolute_errors.end());
		metrics.p99 = *nth;
		return metrics;
	}

private:
	std::vector<double> absolute_errors;
	double sum = 0;
	double absolute_sum = 0;
	double square_sum = 0;
	uint64_t wrong_count = 0;
};

void add_metrics(const ErrorMetrics &p_metrics, nlohmann::ordered_json &r_json) {
	r_json["mae"] = p_metrics.mae;
	r_json["rmse"] = p_metrics.rmse;
	r_json["p99"] = p_metrics.p99;
	r_json["bias"] = p_metrics.bias;
	if (p_metrics.wrong) {
		r_json["wrong"] = *p_metrics.wrong;
	}
}

} // namespace

bool is_penumbra(float p_reference) {
	return p_reference > MIN_PENUMBRA_VISIBILITY && p_reference < MAX_PENUMBRA_VISIBILITY;
}

MaskMetrics compute_mask_metrics(const MaskImage &p_reference, const MaskImage &p_result,
		const std::string &p_reference_name, const std::string &p_result_name) {
	check_pair(p_reference, p_result, p_reference_name, p_result_name);
	ErrorAccumulator receiver;
	ErrorAccumulator penumbra;
	uint64_t lit_count = 0;
	uint64_t black_count = 0;
	for (size_t i = 0; i < p_reference.get_pixel_count(); ++i) {
		if (!p_reference.is_receiver(i)) {
			continue;
		}
		const float reference = p_reference.visibility[i];
		const float result = p_result.visibility[i];
		const double error = static_cast<double>(result) - reference;
		receiver.add(error);
		if (is_penumbra(reference)) {
			penumbra.add(error);
			lit_count += reference > UMBRA_OVER_REFERENCE ? 1 : 0;
			black_count += reference > UMBRA_OVER_REFERENCE && result < UMBRA_OVER_RESULT ? 1 : 0;
		}
	}
	MaskMetrics metrics;
	metrics.receiver = receiver.finish();
	metrics.penumbra = penumbra.finish();
	metrics.umbra_over =
			lit_count > 0 ? static_cast<double>(black_count) / static_cast<double>(lit_count) : 0.0;
	return metrics;
}

TemporalMetrics compute_temporal_metrics(
		std::span<const MaskImage> p_reference, std::span<const MaskImage> p_result) {
	if (p_reference.size() != p_result.size()) {
		fail("Sequences differ in length: ", p_reference.size(), " reference frames, ",
				p_result.size(), " of the result. Render both with the same --frames.");
	}
	for (size_t frame = 0; frame < p_reference.size(); ++frame) {
		check_pair(p_reference[frame], p_result[frame], text("reference, frame ", frame),
				text("result, frame ", frame));
		if (p_reference[frame].size_px != p_reference[0].size_px) {
			fail("Sequence: frame ", frame, " is ", p_reference[frame].size_px.x, " x ",
					p_reference[frame].size_px.y, ", frame 0 is ", p_reference[0].size_px.x, " x ",
					p_reference[0].size_px.y, ". Render all frames with the same --size.");
		}
	}
	TemporalMetrics metrics;
	double receiver_sum = 0;
	double penumbra_sum = 0;
	for (size_t frame = 1; frame < p_reference.size(); ++frame) {
		const MaskImage &before = p_reference[frame - 1];
		const MaskImage &after = p_reference[frame];
		for (size_t i = 0; i < after.get_pixel_count(); ++i) {
			if (!before.is_receiver(i) || !after.is_receiver(i)) {
				continue;
			}
			const double reference_change =
					static_cast<double>(after.visibility[i]) - before.visibility[i];
			const double result_change = static_cast<double>(p_result[frame].visibility[i]) -
					p_result[frame - 1].visibility[i];
			const double square =
					(result_change - reference_change) * (result_change - reference_change);
			receiver_sum += square;
			++metrics.receiver_pixel_count;
			if (is_penumbra(before.visibility[i]) || is_penumbra(after.visibility[i])) {
				penumbra_sum += square;
				++metrics.penumbra_pixel_count;
			}
		}
	}
	if (metrics.receiver_pixel_count > 0) {
		metrics.receiver_rmse =
				std::sqrt(receiver_sum / static_cast<double>(metrics.receiver_pixel_count));
	}
	if (metrics.penumbra_pixel_count > 0) {
		metrics.penumbra_rmse =
				std::sqrt(penumbra_sum / static_cast<double>(metrics.penumbra_pixel_count));
	}
	return metrics;
}

std::string to_json(const MaskMetrics &p_metrics) {
	nlohmann::ordered_json json;
	json["pixels"] = p_metrics.receiver.pixel_count;
	add_metrics(p_metrics.receiver, json["receiver"]);
	json["penumbra"]["pixels"] = p_metrics.penumbra.pixel_count;
	add_metrics(p_metrics.penumbra, json["penumbra"]);
	json["penumbra"]["umbra_over"] = p_metrics.umbra_over;
	return json.dump();
}

} // namespace gnomon
