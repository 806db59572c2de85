#pragma once

#include "modules/error_report/mask_source.h"
#include "modules/rendering_device/rendering_device.h"

#include <string>
#include <vector>

namespace gnomon {

/// Renders the masks for the error report. Each answer uses a new renderer, so that none benefits
/// from another's caches.
class RenderedMasks : public MaskSource {
public:
	/// p_median_error: a measurement may end before its frames or 3 s once the relative standard
	/// error of its median is that small; 0 = never.
	RenderedMasks(RenderingDevice &p_device, double p_median_error, uint32_t p_frame_count = 20) :
			device(p_device), median_error(p_median_error), frame_count(p_frame_count) {}

	ReportMachine get_machine() const override;
	TracedReference trace_reference(
			const MaskQuestion &p_question, uint32_t p_sample_count) override;
	std::vector<uint8_t> draw_scene(
			const std::shared_ptr<const SceneSnapshot> &p_scene, glm::uvec2 p_size_px) override;
	MeasuredMask measure(const MaskQuestion &p_question, const std::string &p_technique) override;
	DrawnMasks draw(
			std::span<const MaskQuestion> p_questions, const std::string &p_technique) override;

	/// Returns the techniques and mask filters with those ids; empty: all but the reference and
	/// examples. An unknown id is a UsageError.
	static std::vector<TechniqueSource> find_techniques(const std::vector<std::string> &p_ids);

private:
	RenderingDevice &device;
	const double median_error;
	const uint32_t frame_count;
};

} // namespace gnomon
