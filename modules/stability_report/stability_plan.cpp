#include "modules/core/error.h"
#include "modules/core/text.h"
#include "modules/stability_report/stability_part.h"
#include "modules/stability_report/stability_sweeps.h"

#include <algorithm>
#include <memory>

namespace gnomon {

namespace {

const char *const SCENE_NAME = "stability, generated";

/// Returns whether the options request the sweep.
bool has_sweep(const ReportOptions &p_options, const std::string &p_id) {
	const std::vector<std::string> ids = p_options.get_part_option(SWEEPS_OPTION);
	return p_options.get_part_extent(STABILITY_OPTION) != ReportExtent::NONE &&
			(ids.empty() || std::ranges::find(ids, p_id) != ids.end());
}

using TaskCache = LastValue<std::tuple<const StabilitySweep *, LightType, double>, MaskTask>;

/// Returns the task of a point. The cache avoids building its scene again for each technique.
MaskTask get_task(TaskCache &r_cache, const StabilitySweep &p_sweep, LightType p_type,
		double p_value, const ReportOptions &p_options) {
	return r_cache.get({ &p_sweep, p_type, p_value }, [&] {
		const StabilitySetup point = make_stability_setup(
				p_sweep, p_type, p_value, p_options.get_part_extent(STABILITY_OPTION));
		return MaskTask{ build_snapshot(*point.scene, *point.scene->find_nodes<Camera3D>().front()),
			point.light, point.size_px, p_options.filter_hash };
	});
}

/// Plans the sweep "scenes": each light of the project's stability scenes, unchanged.
void plan_project_scenes(
		const ReportOptions &p_options, const ReportPart::AddConfiguration &p_add) {
	const auto scenes = p_options.part_scenes.find(STABILITY_GROUP);
	if (scenes == p_options.part_scenes.end()) {
		return;
	}
	ReportConfiguration configuration;
	configuration.group = STABILITY_GROUP;
	configuration.sweep = PROJECT_SCENES_SWEEP;
	configuration.size_px =
			glm::uvec2(get_stability_size_px(p_options.get_part_extent(STABILITY_OPTION)));
	for (const ReportScene &item : scenes->second) {
		configuration.scene = item.name;
		try {
			const ReportView view = find_report_view(item);
			const auto snapshot = build_snapshot(*item.scene, *view.camera);
			configuration.light_count = uint32_t(snapshot->lights.size());
			for (const Light3D *light : view.lights) {
				configuration.light = light->name;
				configuration.id = text("stability/", PROJECT_SCENES_SWEEP, "/",
						get_light_type_name(light->type), "/", item.name, "/", light->name);
				const MaskTask task = { snapshot, light->name, configuration.size_px,
					p_options.filter_hash };
				p_add(configuration, [=](const PropertyValues &) { return task; });
				configuration.value += 1;
			}
		} catch (const Error &error) {
			configuration.light.clear();
			configuration.id = text("stability/", PROJECT_SCENES_SWEEP, "/", item.name);
			p_add(configuration,
					[message = std::string(error.what())](
							const PropertyValues &) -> MaskTask { fail(message); });
		}
	}
}

} // namespace

std::vector<ReportPartOption> StabilityPart::list_options() const {
	ReportPartOption sweeps = { SWEEPS_OPTION, "A,B: only these sweeps of --stability" };
	sweeps.is_list = true;
	for (const StabilitySweep &sweep : get_stability_sweeps()) {
		sweeps.values.push_back(sweep.id);
	}
	return { make_extent_option(STABILITY_OPTION,
					 "Sweeps into stiff and extreme cases: none, quick (default) or full"),
		sweeps };
}

bool StabilityPart::needs_own_scenes(const ReportOptions &p_options) const {
	return has_sweep(p_options, PROJECT_SCENES_SWEEP);
}

void StabilityPart::plan(const ReportOptions &p_options, std::span<const ReportScene> /*p_scenes*/,
		const AddConfiguration &p_add) const {
	const bool is_quick = p_options.get_part_extent(STABILITY_OPTION) == ReportExtent::QUICK;
	const auto cache = std::make_shared<TaskCache>();
	for (const StabilitySweep &sweep : get_stability_sweeps()) {
		if (!has_sweep(p_options, sweep.id)) {
			continue;
		}
		if (sweep.has_project_scenes) {
			plan_project_scenes(p_options, p_add);
			continue;
		}
		std::vector<double> values = is_quick ? sweep.quick_values : sweep.values;
		// The centre first, because the states of all other points depend on its error.
		std::stable_partition(values.begin(), values.end(),
				[&](double p_value) { return p_value == sweep.center; });
		for (const LightType type : sweep.types) {
			// To save time, a quick report measures only the first type of light, except in the
			// first sweep (light_size).
			if (is_quick && type != sweep.types.front() && &sweep != &get_stability_sweeps()[0]) {
				continue;
			}
			for (const double value : values) {
				ReportConfiguration configuration;
				configuration.group = STABILITY_GROUP;
				configuration.sweep = sweep.id;
				configuration.value = value;
				configuration.scene = SCENE_NAME;
				configuration.id = text("stability/", sweep.id, "/", get_light_type_name(type), "/",
						sweep.describe_value(value));
				const MaskTask task = get_task(*cache, sweep, type, value, p_options);
				configuration.light = task.light;
				configuration.light_count = uint32_t(task.scene->lights.size());
				configuration.size_px = task.size_px;
				p_add(configuration, [=, &sweep](const PropertyValues &) {
					return get_task(*cache, sweep, type, value, p_options);
				});
			}
		}
	}
}

} // namespace gnomon
