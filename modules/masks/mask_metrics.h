#pragma once

#include "modules/masks/mask_image.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace gnomon {

/// Visibility error over a set of pixels; all 0 for an empty set. "Error" is result minus
/// reference.
struct ErrorMetrics {
	uint64_t pixel_count = 0;
	double mae = 0;	 // mean of |error|
	double rmse = 0; // root of the mean square
	double p99 = 0;	 // |error| that 99 % of the pixels do not exceed (nearest rank)
	double bias = 0; // mean error: negative = too dark, positive = too light
	/// Fraction 0..1 of the pixels whose |error| exceeds 0.2, which is visible as a wrong shadow.
	/// Absent only if read from the report of an earlier version.
	std::optional<double> wrong = 0.0;
};

/// Whether a reference value is penumbra, in (0.002, 0.998): neither umbra nor fully lit.
bool is_penumbra(float p_reference);

/// The error of a result against the reference. Both are linear visibility, before tone mapping.
struct MaskMetrics {
	ErrorMetrics receiver; // pixels whose surface faces the light, in its cone and range
	ErrorMetrics penumbra; // receiver pixels whose reference is in (0.002, 0.998)
	/// Umbra over-estimation: the fraction, 0..1, of the penumbra pixels with reference > 0.05
	/// whose result is below 0.01.
	double umbra_over = 0;
};

/// Temporal error: flicker and lag, which single frames do not show.
struct TemporalMetrics {
	uint64_t receiver_pixel_count = 0; // receiver in both frames of a pair, summed over the pairs
	uint64_t penumbra_pixel_count = 0; // of those, penumbra in the reference of either frame
	/// Root mean square of (result's difference - reference's difference) from frame to frame.
	double receiver_rmse = 0;
	double penumbra_rmse = 0;
};

/// Compares two images. Different sizes or receiver masks, or values that are not finite, are an
/// Error. Messages name the images by the given names.
MaskMetrics compute_mask_metrics(const MaskImage &p_reference, const MaskImage &p_result,
		const std::string &p_reference_name = "reference mask",
		const std::string &p_result_name = "result");

/// Compares frame k of one sequence with frame k of the other; all frames have one size. Fewer than
/// two frames give 0 throughout. Errors as in compute_mask_metrics, and for sequences of different
/// length.
TemporalMetrics compute_temporal_metrics(
		std::span<const MaskImage> p_reference, std::span<const MaskImage> p_result);

/// Formats {"pixels", "receiver": {"mae","rmse","p99","bias","wrong"}, "penumbra": {"pixels","mae",
/// "rmse","p99","bias","wrong","umbra_over"}} in this order, on one line. "pixels" counts the
/// pixels of the set: receivers or penumbra. An absent "wrong" is omitted.
std::string to_json(const MaskMetrics &p_metrics);

} // namespace gnomon
