#pragma once

#include "modules/main/run_part.h"
#include "modules/masks/mask_timing.h"
#include "modules/renderer/renderer.h"

#include <cstdint>
#include <functional>
#include <string>

namespace gnomon {

/// When a measurement ends: after frame_count frames, or earlier, but after at least
/// min_frame_count frames, once `seconds` have passed or the median is precise enough.
struct MeasureLimits {
	uint32_t warm_up_count = 5; // frames drawn first, which are not measured
	uint32_t frame_count = 20;
	uint32_t min_frame_count = 20;
	double seconds = 0;		 // wall-clock limit; 0: ends after min_frame_count frames
	double median_error = 0; // required relative standard error of the median; 0: not used
};

/// Measures the run time of the shadow passes of one light (p_request.mask_light; empty: all
/// lights). The G-buffer and the lighting are not counted. Sets the request's mode to ONE_BY_ONE
/// and requests no masks or surfaces. With p_request.may_reuse = false nothing cached from earlier
/// frames is used. p_progress is called with the completed fraction, 0..1; it may be empty.
MaskTiming measure_mask_timing(Renderer &r_renderer, RenderRequest p_request,
		const MeasureLimits &p_limits, const std::function<void(double)> &p_progress);

/// Measures the shadow passes like measure_mask_timing, then p_count whole frames. Returns the JSON
/// of `--time` (doc/command_line.md). p_build_snapshot: rebuilds the snapshot from the
/// node tree before each whole frame, as a game does; empty: the request's scene is reused.
std::string measure_time(Renderer &r_renderer, RenderRequest p_request, uint32_t p_warm_up_count,
		uint32_t p_count, const RunPart::SnapshotBuilder &p_build_snapshot);

} // namespace gnomon
