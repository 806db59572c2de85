#pragma once

#include "modules/error_report/light_variant.h"
#include "modules/error_report/mask_source.h"
#include "modules/error_report/report.h"
#include "modules/error_report/report_scene.h"
#include "modules/error_report/scaling_scenes.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// How much of the stability sweeps a report draws; NONE where no module adds them.
enum class StabilityExtent {
	NONE,
	QUICK, // the ends of each sweep and its centre, 64 x 64 pixels
	FULL,
};
inline constexpr const char *PROJECT_SCENES_SWEEP = "scenes"; // see ReportOptions::stability_scenes

struct ReportOptions {
	std::string project;
	std::string program;		 // version and hash of this program: others measure anew
	std::vector<double> sizes_m; // R; empty: 0.02, 0.1 and 0.3 S of each scene
	/// Types that the first shadow-casting light of each scene takes in turn. Empty: all lights
	/// that cast shadows, as they are.
	std::vector<LightType> light_types;
	glm::uvec2 size_px = glm::uvec2(256u);
	uint32_t sample_count = 1024; // of the truth
	double precision_percent = 5; // see Report
	uint64_t filter_hash = 0;	  // see MaskQuestion
	ScalingExtent scaling = ScalingExtent::QUICK;
	StabilityExtent stability = StabilityExtent::QUICK;
	std::vector<std::string> sweeps;		   // of stability; empty: all
	std::vector<ReportScene> stability_scenes; // of the sweep "scenes"

	bool has_sweep(const std::string &p_id) const;
};

/// What is to be measured: a report whose truths and cells are still missing, and how to ask for
/// each. Questions are built when they are asked, since a scene may hold a million triangles.
struct ReportPlan {
	Report report;
	/// One per configuration; throws an Error where the scene cannot be shown. The properties
	/// replace those of the light.
	using Ask = std::function<MaskQuestion(const PropertyValues &)>;
	std::vector<Ask> questions;
	std::vector<PropertyValues> settings; // one per cell
};

/// Plans the whole matrix in a fixed order: scenes, lights, sizes, techniques, settings. Names each
/// record after what it depends on, so that a later run finds it again.
ReportPlan make_report_plan(const ReportOptions &p_options,
		const std::vector<ReportScene> &p_scenes, const std::vector<TechniqueSource> &p_techniques);

} // namespace gnomon
