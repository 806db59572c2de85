#include "modules/stability_report/stability_sweeps.h"

#include "modules/core/error.h"
#include "modules/error_report/scaling_scenes.h"
#include "modules/stability_report/stability_scenes.h"

#include <algorithm>

namespace gnomon {

namespace {

const uint32_t QUICK_SIZE_PX = 64;
const uint32_t FULL_SIZE_PX = 128;

const std::vector<LightType> ALL_TYPES = { LightType::SPOT, LightType::OMNI,
	LightType::DIRECTIONAL };
const std::vector<LightType> WITH_POSITION = { LightType::SPOT, LightType::OMNI };
const std::vector<LightType> SPOT = { LightType::SPOT };

std::vector<StabilitySweep> build_sweeps() {
	// Each: id, quantity, types of light, values, centre, quick values.
	std::vector<StabilitySweep> sweeps = {
		{ "light_size", "light radius, S", ALL_TYPES,
				{ 1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1 }, 0.05,
				{ 1e-6, 0.05, 0.75 } },
		{ "depth_range", "far : near", WITH_POSITION, { 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7 }, 10,
				{ 10, 1e4, 1e7 } },
		{ "near_caster", "distance of a caster before the light, R", WITH_POSITION,
				{ 20, 10, 7, 5, 4, 3, 2, 1.5, 1.1 }, 10, { 10, 3, 1.1 } },
		{ "scale", "size of the scene, times", ALL_TYPES, { 1e-3, 0.01, 0.1, 1, 10, 100, 1e3 }, 1,
				{ 1e-3, 1, 1e3 } },
		{ "offset", "distance from the origin, m", ALL_TYPES, { 0, 1, 100, 1e3, 1e4, 1e5, 1e6 }, 0,
				{ 0, 1e5, 1e6 } },
		{ "slope", "angle of the receiver to the light, degrees", ALL_TYPES,
				{ 0, 30, 45, 60, 75, 85, 88, 89, 89.9, 89.99 }, 60, { 60, 85, 89.99 } },
		{ "gap", "gap between caster and receiver, S", ALL_TYPES,
				{ 1, 0.5, 0.2, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6 }, 0.1, { 1, 0.1, 1e-6 } },
		{ "thickness", "thickness of the caster, S", ALL_TYPES,
				{ 0.1, 0.01, 1e-3, 1e-4, 1e-5, 1e-6, 0 }, 0.01, { 0.1, 0.01, 0 } },
		{ "aspect", "aspect ratio of triangles", ALL_TYPES, { 1, 10, 100, 1e3, 1e4, 1e5, 1e6 }, 1,
				{ 1, 1e3, 1e6 } },
		{ "end_on", "angle of a rod's edges to the light, degrees", ALL_TYPES,
				{ 30, 10, 3, 1, 0.3, 0.1, 0.01, 1e-3, 1e-4, 0 }, 10, { 10, 0.1, 0 } },
		{ "layers", "casters behind one another", ALL_TYPES, { 1, 2, 3, 4, 8, 16, 32, 64 }, 2,
				{ 2, 16, 64 } },
		{ "fin_width", "penumbra widths r = t, S", SPOT,
				{ 0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 10, 100 }, 0.05, { 0.05, 1, 100 } },
		{ "inside", "distance of the light below a caster, S (negative: inside)", WITH_POSITION,
				{ 0.25, 0.1, 0.05, 0.02, 0.01, 1e-3, 0, -1e-3, -0.01, -0.05, -0.1 }, 0.1,
				{ 0.1, 0, -0.1 } },
		{ TRIANGLES_GROUP, "triangles", SPOT, { 1e3, 1e4, 3e4, 1e5, 5e5, 2e6 }, 3e4, { 1e3, 3e4 } },
		{ LIGHTS_GROUP, "lights", SPOT, { 1, 4, 16, 64, 256 }, 1, { 1, 4 } },
		{ RESOLUTION_GROUP, "width and height of the mask, pixels", SPOT,
				{ 16, 32, 64, 128, 256, 512, 1024, 2048, 4096 }, 128, { 16, 128 } },
	};
	StabilitySweep guards = { "guards", "hostile scenes", ALL_TYPES, /*values=*/{}, /*center=*/0,
		/*quick_values=*/{} };
	guards.labels = list_hostile_scene_names();
	for (size_t index = 0; index < guards.labels.size(); ++index) {
		guards.values.push_back(double(index));
	}
	guards.quick_values = guards.values;
	sweeps.push_back(std::move(guards));
	sweeps.push_back({ .id = PROJECT_SCENES_SWEEP,
			.quantity = "scenes of the project",
			.types = ALL_TYPES,
			.center = -1, // none
			.has_project_scenes = true });
	return sweeps;
}

bool uses_scaling_scene(const StabilitySweep &p_sweep) {
	return p_sweep.id == TRIANGLES_GROUP || p_sweep.id == LIGHTS_GROUP;
}

} // namespace

std::string StabilitySweep::describe_value(double p_value) const {
	if (!labels.empty()) {
		return labels.at(static_cast<size_t>(p_value));
	}
	return format_number(p_value);
}

const std::vector<StabilitySweep> &get_stability_sweeps() {
	static const std::vector<StabilitySweep> SWEEPS = build_sweeps();
	return SWEEPS;
}

const StabilitySweep *find_stability_sweep(const std::string &p_id) {
	const std::vector<StabilitySweep> &sweeps = get_stability_sweeps();
	const auto found = std::ranges::find(sweeps, p_id, &StabilitySweep::id);
	return found == sweeps.end() ? nullptr : &*found;
}

uint32_t get_stability_size_px(ReportExtent p_extent) {
	return p_extent == ReportExtent::QUICK ? QUICK_SIZE_PX : FULL_SIZE_PX;
}

StabilitySetup make_stability_setup(
		const StabilitySweep &p_sweep, LightType p_type, double p_value, ReportExtent p_extent) {
	StabilitySetup result;
	result.light = STABILITY_LIGHT_NAME;
	result.size_px = glm::uvec2(get_stability_size_px(p_extent));
	if (uses_scaling_scene(p_sweep)) {
		ScalingScene description;
		description.light_size_m = 0.2; // 0.05 S, as in the other sweeps
		if (p_sweep.id == TRIANGLES_GROUP) {
			description.triangle_count = static_cast<uint32_t>(p_value);
		} else {
			description.triangle_count = 1000;
			description.light_count = static_cast<uint32_t>(p_value);
		}
		result.scene = make_scaling_scene(description);
		result.light = "Light 1";
		return result;
	}
	if (p_sweep.id == RESOLUTION_GROUP) {
		result.size_px = glm::uvec2(static_cast<uint32_t>(p_value));
	}
	result.scene = make_stability_scene(p_sweep.id, p_type, p_value);
	return result;
}

} // namespace gnomon
