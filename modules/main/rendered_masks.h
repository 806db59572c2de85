#pragma once

#include "modules/error_report/mask_source.h"
#include "modules/rendering_device/rendering_device.h"

#include <string>
#include <vector>

namespace gnomon {

/// Renders the masks for the error report. Each call uses a new Renderer, so that no result depends
/// on the caches of an earlier call.
class RenderedMaskSource : public MaskSource {
public:
	/// p_frame_count: maximum number of timed frames per cell. p_median_error: timing ends early
	/// once the relative standard error of the median is at most this; 0: never.
	RenderedMaskSource(
			RenderingDevice &p_device, double p_median_error, uint32_t p_frame_count = 20) :
			device(p_device),
			median_error(p_median_error), frame_count(p_frame_count) {}

	ReportMachine get_machine() const override;
	TracedReference trace_reference(const MaskTask &p_task, uint32_t p_sample_count) override;
	std::vector<uint8_t> draw_scene(
			const std::shared_ptr<const SceneSnapshot> &p_scene, glm::uvec2 p_size_px) override;
	MeasuredMask measure(const MaskTask &p_task, const std::string &p_technique) override;
	DrawnMasks draw(std::span<const MaskTask> p_tasks, const std::string &p_technique) override;

	/// Returns the techniques and mask filters with these ids; if p_ids is empty, all except the
	/// reference technique and examples. Throws a UsageError for an unknown id, and an Error if a
	/// requested mask filter has no default technique to follow.
	static std::vector<MeasurableTechnique> find_techniques(const std::vector<std::string> &p_ids);

private:
	RenderingDevice &device;
	const double median_error;
	const uint32_t frame_count;
};

} // namespace gnomon
