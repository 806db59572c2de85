#include "modules/core/error.h"
#include "modules/core/text.h"
#include "modules/stability_report/stability_part.h"
#include "modules/stability_report/stability_sweeps.h"

#include <algorithm>
#include <memory>

namespace gnomon {

namespace {

const char *const SCENE_NAME = "stability, generated";

using QuestionCache =
		LastValue<std::tuple<const StabilitySweep *, LightType, double>, MaskQuestion>;

/// All techniques of a point answer the same question.
MaskQuestion get_question(QuestionCache &r_cache, const StabilitySweep &p_sweep, LightType p_type,
		double p_value, const ReportOptions &p_options) {
	return r_cache.get({ &p_sweep, p_type, p_value }, [&] {
		const StabilityCase point =
				make_stability_case(p_sweep, p_type, p_value, p_options.stability);
		return MaskQuestion{ build_snapshot(
									 *point.scene, *point.scene->find_nodes<Camera3D>().front()),
			point.light, point.size_px, p_options.filter_hash };
	});
}

/// The lights of the project's own scenes, as they are.
void plan_project_scenes(const ReportOptions &p_options, const ReportPart::Add &p_add) {
	ReportConfiguration configuration;
	configuration.group = STABILITY_GROUP;
	configuration.sweep = PROJECT_SCENES_SWEEP;
	configuration.size_px = glm::uvec2(get_stability_size_px(p_options.stability));
	for (const ReportScene &item : p_options.stability_scenes) {
		configuration.scene = item.name;
		try {
			const ReportView view = find_report_view(item);
			const auto snapshot = build_snapshot(*item.scene, *view.camera);
			configuration.light_count = uint32_t(snapshot->lights.size());
			for (const Light3D *light : view.lights) {
				configuration.light = light->name;
				configuration.id = text("stability/", PROJECT_SCENES_SWEEP, "/",
						get_light_type_name(light->type), "/", item.name, "/", light->name);
				const MaskQuestion question = { snapshot, light->name, configuration.size_px,
					p_options.filter_hash };
				p_add(configuration, [=](const PropertyValues &) { return question; });
				configuration.value += 1;
			}
		} catch (const Error &error) {
			configuration.light.clear();
			configuration.id = text("stability/", PROJECT_SCENES_SWEEP, "/", item.name);
			p_add(configuration,
					[message = std::string(error.what())](
							const PropertyValues &) -> MaskQuestion { fail(message); });
		}
	}
}

} // namespace

std::vector<std::string> StabilityPart::list_sweeps() const {
	std::vector<std::string> ids;
	for (const StabilitySweep &sweep : get_stability_sweeps()) {
		ids.push_back(sweep.id);
	}
	return ids;
}

void StabilityPart::plan(const ReportOptions &p_options, const Add &p_add) const {
	const bool is_quick = p_options.stability == ReportExtent::QUICK;
	const auto cache = std::make_shared<QuestionCache>();
	for (const StabilitySweep &sweep : get_stability_sweeps()) {
		if (!p_options.has_sweep(sweep.id)) {
			continue;
		}
		if (sweep.has_project_scenes) {
			plan_project_scenes(p_options, p_add);
			continue;
		}
		std::vector<double> values = is_quick ? sweep.quick_values : sweep.values;
		std::stable_partition(values.begin(), values.end(),
				[&](double p_value) { return p_value == sweep.center; });
		for (const LightType type : sweep.types) {
			// The other types' sweeps take their own time; of these the quick form measures the
			// sizes.
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
				const MaskQuestion question = get_question(*cache, sweep, type, value, p_options);
				configuration.light = question.light;
				configuration.light_count = uint32_t(question.scene->lights.size());
				configuration.size_px = question.size_px;
				p_add(configuration, [=, &sweep](const PropertyValues &) {
					return get_question(*cache, sweep, type, value, p_options);
				});
			}
		}
	}
}

} // namespace gnomon
