#pragma once

#include "modules/error_report/report_plan.h"
#include "modules/scene/nodes.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// Id of the sweep over the scenes that the project lists for StabilityPart.
inline constexpr const char *PROJECT_SCENES_SWEEP = "scenes";

/// A sweep: generated scenes in which one quantity varies from harmless to extreme and everything
/// else is constant (exceptions: has_cases). The report shows one curve per technique and light
/// type.
struct StabilitySweep {
	std::string id;				  // "light_size"
	std::string quantity;		  // name and unit of the values: "light radius, S"
	std::vector<LightType> types; // of the light; each gets a curve of its own
	std::vector<double> values;	  // in the order of the curve
	double center = 0; // harmless element of `values`: errors are compared with the error there
	std::vector<double> quick_values; // subset of `values` for ReportExtent::QUICK
	/// Names of separate scenes, whose indices are `values`. Empty if the values are a quantity.
	std::vector<std::string> labels = {};
	/// True: the points are the lights of ReportOptions::part_scenes, numbered from 0, and there is
	/// no centre.
	bool has_project_scenes = false;

	/// True: the points are separate scenes, which form no curve.
	bool has_cases() const { return has_project_scenes || !labels.empty(); }
	/// Returns the label of a value: the number as text ("1e-06"), or its name in `labels`.
	std::string describe_value(double p_value) const;
};
/// Returns all sweeps. The last two are no curves: "guards" has generated scenes that once broke a
/// technique or might, and "scenes" has the scenes of the project.
const std::vector<StabilitySweep> &get_stability_sweeps();
/// Returns the sweep with that id; null if there is none.
const StabilitySweep *find_stability_sweep(const std::string &p_id);

/// The scene of one point of a sweep, the name of the light whose mask is measured ("Light", or
/// "Light 1" in sweeps that use make_scaling_scene), and the size of the mask.
struct StabilitySetup {
	std::unique_ptr<Scene> scene;
	std::string light;
	glm::uvec2 size_px = glm::uvec2(0u);
};
/// Returns the width and height of masks in pixels. Only the sweep "resolution" has other sizes.
uint32_t get_stability_size_px(ReportExtent p_extent);
/// Builds a point of a sweep that has no project scenes. The scene size S is 4 m, except in the
/// sweep "scale".
StabilitySetup make_stability_setup(
		const StabilitySweep &p_sweep, LightType p_type, double p_value, ReportExtent p_extent);

} // namespace gnomon
