#include "modules/error_report/stability_plan.h"

#include "modules/core/text.h"

#include <algorithm>
#include <memory>

namespace gnomon {

namespace {

const char *const SCENE_NAME = "stability, generated";

/// The last question that was built: all techniques of a point ask the same one.
class QuestionCache {
public:
	MaskQuestion get(const StabilitySweep &p_sweep, LightType p_type, double p_value,
			const ReportOptions &p_options) {
		const Key key = { &p_sweep, p_type, p_value };
		if (!is_there || key != last) {
			question = {}; // before the next one takes memory
			const StabilityCase point =
					make_stability_case(p_sweep, p_type, p_value, p_options.stability);
			question = { build_snapshot(*point.scene, *point.scene->find_nodes<Camera3D>().front()),
				point.light, point.size_px, p_options.filter_hash };
			last = key;
			is_there = true;
		}
		return question;
	}

private:
	using Key = std::tuple<const StabilitySweep *, LightType, double>;
	bool is_there = false;
	Key last;
	MaskQuestion question;
};

} // namespace

void plan_stability(const ReportOptions &p_options,
		const std::function<void(ReportConfiguration, ReportPlan::Ask)> &p_add) {
	if (p_options.stability == StabilityExtent::NONE) {
		return;
	}
	const bool is_quick = p_options.stability == StabilityExtent::QUICK;
	const auto cache = std::make_shared<QuestionCache>();
	for (const StabilitySweep &sweep : get_stability_sweeps()) {
		const auto &wanted = p_options.sweeps;
		if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), sweep.id) == wanted.end()) {
			continue;
		}
		std::vector<double> values = is_quick ? sweep.quick_values : sweep.values;
		std::stable_partition(values.begin(), values.end(),
				[&](double p_value) { return p_value == sweep.center; });
		for (const LightType type : sweep.types) {
			// The other types' sweeps take their own time; of these the quick form asks the sizes.
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
				const MaskQuestion question = cache->get(sweep, type, value, p_options);
				configuration.light = question.light;
				configuration.light_count = uint32_t(question.scene->lights.size());
				configuration.size_px = question.size_px;
				p_add(configuration, [=, &sweep](const PropertyValues &) {
					return cache->get(sweep, type, value, p_options);
				});
			}
		}
	}
}

} // namespace gnomon
