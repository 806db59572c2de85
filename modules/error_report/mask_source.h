#pragma once

#include "modules/core/property.h"
#include "modules/error_report/report.h"
#include "modules/masks/mask_image.h"
#include "modules/scene/scene_snapshot.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// A task for a technique: compute the visibility mask of one light for the scene's camera.
struct MaskTask {
	std::shared_ptr<const SceneSnapshot> scene;
	std::string light; // name; empty: all lights, of which only the run time is measured
	glm::uvec2 size_px = glm::uvec2(0u);
	/// Hash of the registered mask filters, since masks and references depend on them.
	uint64_t filter_hash = 0;
	/// The scene one frame later, to measure the temporal error; null: not requested.
	std::shared_ptr<const SceneSnapshot> next_scene = nullptr;
};

/// A ray-traced reference mask with its surface points.
struct TracedReference {
	MaskImage mask;
	std::vector<uint8_t>
			sees_whole_light; // per pixel, see is_light_disc_above_horizon; 0 without a receiver
	/// Per pixel, where visibility is tested, camera-relative; see SurfacePoint.
	std::vector<glm::vec3> receiver_positions;
	bool is_double = false;	   // traced in double precision, because float32 was too inaccurate
	double standard_error = 0; // of visibility, from the finite number of rays
	double wall_ms = 0;		   // time to trace the mask or to load it from the cache
};

/// A mask with its run time.
struct MeasuredMask {
	MaskImage mask; // empty if MaskTask::light is empty
	MaskTiming time;
	uint64_t bytes = 0; // device memory in use, including G-buffer and meshes
};

/// Masks of consecutive frames, drawn without timing.
struct DrawnMasks {
	std::vector<MaskImage> frames;		   // one per MaskTask
	std::vector<std::string> warnings;	   // logged while drawing
	unsigned validation_message_count = 0; // 0 if the validation layers are off
};

/// A technique that the report can measure, or a mask filter, which runs after the default
/// technique.
struct MeasurableTechnique {
	ReportTechnique info;
	/// Returns the quality levels for a light. If it returns none, only the default settings are
	/// measured.
	std::function<std::vector<QualitySetting>(const LightSnapshot &)> get_settings;
	/// Returns false if a mask filter has no effect in the scene; then it gets no cells there.
	/// Empty: it always applies.
	std::function<bool(const MaskTask &)> applies = {};
};

/// Interface of the renderer that the report measures; tests use a fake. All functions may throw an
/// Error.
class MaskSource {
public:
	virtual ~MaskSource() = default;
	virtual ReportMachine get_machine() const = 0;
	/// Traces the reference mask with p_sample_count rays per pixel.
	virtual TracedReference trace_reference(const MaskTask &p_task, uint32_t p_sample_count) = 0;
	/// Draws the lit scene as its camera sees it. Returns RGBA8 pixels, sRGB-encoded, top row
	/// first.
	virtual std::vector<uint8_t> draw_scene(
			const std::shared_ptr<const SceneSnapshot> &p_scene, glm::uvec2 p_size_px) = 0;
	/// Draws the mask with a technique and measures its run time. If MaskTask::light is empty, only
	/// measures the run time of all lights.
	virtual MeasuredMask measure(const MaskTask &p_task, const std::string &p_technique) = 0;
	/// Draws one mask per task, as consecutive frames of one renderer, so that techniques reuse
	/// their caches.
	virtual DrawnMasks draw(std::span<const MaskTask> p_tasks, const std::string &p_technique) = 0;
};

} // namespace gnomon
