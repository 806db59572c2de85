#pragma once

#include "modules/error_report/report_plan.h"
#include "modules/scene/nodes.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// One quantity taken from harmless to extreme while all else stays: a curve for each technique.
struct StabilitySweep {
	std::string id;		  // "light_size"
	std::string quantity; // what the values are: "light radius, S"
	std::vector<LightType> types;
	std::vector<double> values;		  // in the order of the curve
	double center = 0;				  // of the values: what the others' errors are compared with
	std::vector<double> quick_values; // of the values
	/// Names of the values, where they are cases and no quantity; else empty.
	std::vector<std::string> labels = {};
	/// Its values count the lights of ReportOptions::stability_scenes; it has no centre.
	bool has_project_scenes = false;

	/// Scenes one by one, which are no curve.
	bool has_cases() const { return has_project_scenes || !labels.empty(); }
	/// "1e-06", or the value's own label.
	std::string describe_value(double p_value) const;
};
/// All that there are; the last but one, "guards", holds scenes that once broke something or might,
/// the last, "scenes", those of a project.
const std::vector<StabilitySweep> &get_stability_sweeps();
/// Null: there is none of that name.
const StabilitySweep *find_stability_sweep(const std::string &p_id);

/// What is drawn at one point of a sweep. The light is "Light", or "Light 1" among several.
struct StabilityCase {
	std::unique_ptr<Scene> scene;
	std::string light;
	glm::uvec2 size_px = glm::uvec2(0u);
};
/// Width and height of masks.
uint32_t get_stability_size_px(ReportExtent p_extent);
/// Of a sweep without project scenes. S is 4 m, but where the scale is what is swept.
StabilityCase make_stability_case(
		const StabilitySweep &p_sweep, LightType p_type, double p_value, ReportExtent p_extent);

} // namespace gnomon
