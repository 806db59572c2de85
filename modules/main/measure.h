#pragma once

#include "modules/main/run_part.h"
#include "modules/masks/mask_timing.h"
#include "modules/renderer/renderer.h"

#include <cstdint>
#include <functional>
#include <string>

namespace gnomon {

/// When a measurement ends: after frame_count frames, or after the minimum number of frames as soon
/// as the time is over or the median is precise enough.
struct MeasureLimits {
	uint32_t warm_up_count = 5;
	uint32_t frame_count = 20;
	uint32_t least_frame_count = 20;
	double seconds = 0;		 // of the measured frames
	double median_error = 0; // relative standard error of the median
};

/// Measures the masks of a light (of all lights if the request names none), pass by pass. The
/// G-buffer and the lighting are not counted. p_request: its mode and outputs are replaced; with
/// may_reuse = false every frame is rendered as if the light had moved. p_progress gets 0..1; may
/// be empty.
MaskTiming measure_mask_timing(Renderer &r_renderer, RenderRequest p_request,
		const MeasureLimits &p_limits, const std::function<void(double)> &p_progress);

/// Like measure_mask_timing, plus whole frames, in the format of `visibility --time`
/// (doc/command_line.md). p_make_snapshot: rebuilds the snapshot from the node tree for each of
/// those frames, as a game does; empty: the request's scene is reused.
std::string measure_time(Renderer &r_renderer, RenderRequest p_request, uint32_t p_warm_up_count,
		uint32_t p_count, const RunPart::SnapshotMaker &p_make_snapshot);

} // namespace gnomon
