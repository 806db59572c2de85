#include "modules/animation_report/animation_part.h"

#include "modules/core/error.h"
#include "modules/scene/animation.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

const double FRAME_S = 1.0 / 30; // time between the two frames of a temporal error
// Number of measured times per animation.
const size_t QUICK_TIME_COUNT = 4;
const size_t FULL_TIME_COUNT = 16;

/// Returns times in seconds: the midpoints of equal intervals of the animation.
std::vector<double> list_times(const Animation &p_animation, ReportExtent p_extent) {
	const size_t count = p_extent == ReportExtent::FULL ? FULL_TIME_COUNT : QUICK_TIME_COUNT;
	std::vector<double> times_s;
	for (size_t index = 0; index < count; ++index) {
		times_s.push_back(p_animation.duration_s * (double(index) + 0.5) / double(count));
	}
	return times_s;
}

MaskTask make_task(const ReportScene &p_scene, const Animation &p_animation,
		const std::string &p_light, double p_time_s, glm::uvec2 p_size_px, uint64_t p_filter_hash) {
	const Camera3D &camera = *find_report_view(p_scene).camera;
	MaskTask task;
	task.scene = build_posed_snapshot(*p_scene.scene, camera, &p_animation, p_time_s);
	task.next_scene = build_posed_snapshot(
			*p_scene.scene, camera, &p_animation, p_animation.wrap_time(p_time_s + FRAME_S));
	task.light = p_light;
	task.size_px = p_size_px;
	task.filter_hash = p_filter_hash;
	return task;
}

/// Returns the same task for the next frame.
MaskTask get_next(const MaskTask &p_task) {
	MaskTask next = p_task;
	next.scene = p_task.next_scene;
	next.next_scene = nullptr;
	return next;
}

} // namespace

Json AnimationResult::to_json() const {
	// The constants are the fields of a stability sweep, which readers of version 2 expect here
	// too.
	return { { "wrong_share", 0.0 }, { "warnings", warnings }, { "refusal", "" },
		{ "temporal_rmse", temporal_rmse } };
}

std::vector<ReportPartOption> AnimationPart::list_options() const {
	return { make_extent_option(CHANGE_OPTION,
			"Errors of change while each scene's animation plays: none, quick (default) or "
			"full") };
}

void AnimationPart::plan(const ReportOptions &p_options, std::span<const ReportScene> p_scenes,
		const AddConfiguration &p_add) const {
	const ReportExtent extent = p_options.get_part_extent(CHANGE_OPTION);
	if (extent == ReportExtent::NONE) {
		return;
	}
	for (const ReportScene &item : p_scenes) {
		if (!item.scene || item.scene->animations.empty() ||
				!(item.scene->animations[0]->duration_s > 0)) {
			continue; // no animation, or not loaded, which the group "matrix" reports
		}
		const std::shared_ptr<const Animation> animation = item.scene->animations[0];
		ReportConfiguration configuration;
		configuration.group = ANIMATION_GROUP;
		configuration.scene = item.name;
		configuration.size_px = p_options.size_px;
		std::vector<std::string> lights;
		try {
			for (const Light3D *light : find_report_view(item).lights) {
				lights.push_back(light->name);
			}
		} catch (const Error &) {
			continue; // no camera or light, which the group "matrix" reports
		}
		configuration.light_count = uint32_t(lights.size());
		for (const std::string &light : lights) {
			configuration.light = light;
			for (const double time_s : list_times(*animation, extent)) {
				configuration.value = time_s;
				configuration.id =
						text(ANIMATION_GROUP, "/", item.name, "/", light, "/", time_s, " s");
				p_add(configuration,
						[=, size_px = p_options.size_px, filter_hash = p_options.filter_hash](
								const PropertyValues &) {
							// Lights keep their own penumbra widths: an animation is measured as
							// the project has it.
							return make_task(item, *animation, light, time_s, size_px, filter_hash);
						});
			}
		}
	}
}

std::vector<TracedReference> AnimationPart::trace_references(
		MaskSource &r_source, const MaskTask &p_task, uint32_t p_sample_count) const {
	std::vector<TracedReference> references;
	references.push_back(r_source.trace_reference(p_task, p_sample_count));
	references.push_back(r_source.trace_reference(get_next(p_task), p_sample_count));
	return references;
}

MaskImage AnimationPart::run_cell(MaskSource &r_source, const MaskTask &p_task,
		std::span<const TracedReference> p_references, Report &r_report, size_t p_cell) const {
	ReportCell &cell = r_report.cells[p_cell];
	const MaskTask tasks[] = { p_task, get_next(p_task) };
	const DrawnMasks drawn = r_source.draw(tasks, cell.technique);
	if (drawn.validation_message_count > 0) {
		fail(drawn.validation_message_count, " validation messages.");
	}
	const MaskImage references[] = { p_references[0].mask, p_references[1].mask };
	cell.error = ReportError{ compute_mask_metrics(references[0], drawn.frames[0]), {} };
	cell.error->whole_light = cell.error->all; // see doc/report_format.md
	const auto result = std::make_shared<AnimationResult>();
	result->temporal_rmse = compute_temporal_metrics(references, drawn.frames).penumbra_rmse;
	result->warnings = drawn.warnings;
	cell.part_result = result;
	return {};
}

std::shared_ptr<const PartResult> AnimationPart::read_result(const Json &p_json) const {
	auto result = std::make_shared<AnimationResult>();
	result->temporal_rmse = p_json.at("temporal_rmse");
	p_json.at("warnings").get_to(result->warnings);
	return result;
}

Json AnimationPart::to_json(const Report &p_report) const {
	Json json = Json::array();
	std::map<std::pair<std::string, std::string>, size_t> plots; // by scene and light
	for (size_t index = 0; index < p_report.cells.size(); ++index) {
		const ReportCell &cell = p_report.cells[index];
		const ReportConfiguration &configuration =
				p_report.configurations[cell.configuration_index];
		const AnimationResult *result = cell.find_result<AnimationResult>();
		if (configuration.group != ANIMATION_GROUP || !cell.is_ok() || !cell.error ||
				result == nullptr) {
			continue;
		}
		const auto [entry, is_new] =
				plots.try_emplace({ configuration.scene, configuration.light }, json.size());
		if (is_new) {
			json.push_back({ { "scene", configuration.scene }, { "light", configuration.light },
					{ "series", Json::array() } });
		}
		Json &series = json[entry->second]["series"];
		auto found = std::find_if(series.begin(), series.end(),
				[&](const Json &p_one) { return p_one["technique"] == cell.technique; });
		if (found == series.end()) {
			series.push_back({ { "technique", cell.technique }, { "points", Json::array() } });
			found = series.end() - 1;
		}
		(*found)["points"].push_back({ { "time_s", configuration.value }, { "cell", index },
				{ "temporal_rmse", result->temporal_rmse },
				{ "mae", cell.error->all.penumbra.mae } });
	}
	return json;
}

} // namespace gnomon
