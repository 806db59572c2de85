#pragma once

#include "modules/masks/mask_image.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace gnomon {

/// Error of v over a set of pixels; all 0 for an empty set. "Error" is result minus reference.
struct ErrorMetrics {
	uint64_t pixel_count = 0;
	double mae = 0;	 // mean of |error|
	double rmse = 0; // root of the mean square
	double p99 = 0;	 // |error| that 99 % of the pixels do not exceed (nearest rank)
	double bias = 0; // mean error: negative = too dark, positive = too light
	/// Share 0..1 of the pixels whose |error| exceeds 0.2: large enough to be seen as a wrong
	/// shadow. Absent only in what a report of an earlier version holds.
	std::optional<double> wrong = 0.0;
};

/// Of a reference: neither umbra nor fully lit.
bool is_penumbra(float p_reference);

/// A result against the reference. Both are linear visibility, before any tone mapping.
struct MaskMetrics {
	ErrorMetrics receiver; // pixels whose surface faces the light, in its cone and range
	ErrorMetrics penumbra; // of those the ones whose reference is in (0.002, 0.998)
	/// Umbra over-estimation: of the penumbra pixels with reference > 0.05, the share shown below
	/// 0.01.
	double umbra_over = 0;
};

/// Error of change: flicker and lag that single frames do not show.
struct TemporalMetrics {
	uint64_t receiver_pixel_count = 0; // receiver in both frames of a pair, summed over the pairs
	uint64_t penumbra_pixel_count = 0; // of those, penumbra in the reference of either frame
	/// Root mean square of (result's difference - reference's difference) from frame to frame.
	double receiver_rmse = 0;
	double penumbra_rmse = 0;
};

/// Different sizes or receiver masks, and values that are not finite, are an Error: these two
/// images do not answer the same question. The names are used for the images in messages.
MaskMetrics compute_mask_metrics(const MaskImage &p_reference, const MaskImage &p_result,
		const std::string &p_reference_name = "reference mask",
		const std::string &p_result_name = "result");

/// Frame k of one sequence against frame k of the other; all frames of one size. Fewer than two
/// frames: all 0. Errors as in compute_mask_metrics, and sequences of different length.
TemporalMetrics compute_temporal_metrics(
		std::span<const MaskImage> p_reference, std::span<const MaskImage> p_result);

/// {"pixels", "receiver": {"mae","rmse","p99","bias","wrong"}, "penumbra": {"pixels","mae","rmse",
/// "p99","bias","wrong","umbra_over"}} in this order, one line. "pixels" are those of the set:
/// receivers, penumbra. An absent "wrong" has no key.
std::string to_json(const MaskMetrics &p_metrics);

} // namespace gnomon
