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

/// The task for a technique: compute one light's mask as the camera sees it.
struct MaskQuestion {
	std::shared_ptr<const SceneSnapshot> scene;
	std::string light; // name; empty: all lights at once, for their cost only
	glm::uvec2 size_px = glm::uvec2(0u);
	uint64_t filter_hash =
			0; // hash of the registered mask filters, on which masks and references depend
	/// The scene a frame later, for errors of change; null: not requested.
	std::shared_ptr<const SceneSnapshot> next_scene = nullptr;
};

struct TracedReference {
	MaskImage mask;
	std::vector<uint8_t> sees_whole_light; // per pixel, see sees_whole_disc; 0 where no receiver
	std::vector<glm::vec3> positions;	   // per pixel, camera-relative, metres
	std::vector<glm::vec3> normals;		   // per pixel, of the face; 0 where nothing is
	bool is_double = false;				   // in double precision, as float32 was not enough
	double standard_error = 0;
	double wall_ms = 0;
};

struct MeasuredMask {
	MaskImage mask; // empty where the question is for the cost only
	MaskTiming time;
	uint64_t bytes = 0; // of device memory in use
};

/// Frames that are drawn for their content, not for their time.
struct DrawnMasks {
	std::vector<MaskImage> frames;
	std::vector<std::string> warnings;
	unsigned validation_message_count = 0; // where the layers are on
};

/// A technique that the report can measure, or a mask filter applied after one.
struct TechniqueSource {
	ReportTechnique info;
	std::function<std::vector<QualitySetting>(const LightSnapshot &)> get_settings;
	/// Returns false when it has no effect in the scene, which then gets no rows. Empty: always
	/// true.
	std::function<bool(const MaskQuestion &)> applies = {};
};

/// Interface to what draws masks: the program with its renderer, or a test double. Throws Errors.
class MaskSource {
public:
	virtual ~MaskSource() = default;
	virtual ReportMachine get_machine() const = 0;
	virtual TracedReference trace_reference(
			const MaskQuestion &p_question, uint32_t p_sample_count) = 0;
	/// The scene as its camera sees it: RGBA8, sRGB-encoded, rows from the top.
	virtual std::vector<uint8_t> draw_scene(
			const std::shared_ptr<const SceneSnapshot> &p_scene, glm::uvec2 p_size_px) = 0;
	virtual MeasuredMask measure(
			const MaskQuestion &p_question, const std::string &p_technique) = 0;
	/// Draws the questions as consecutive frames of one run, so that techniques reuse their caches.
	virtual DrawnMasks draw(
			std::span<const MaskQuestion> p_questions, const std::string &p_technique) = 0;
};

} // namespace gnomon
