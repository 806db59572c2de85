#include "modules/error_report/report_json.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/error_report/report_part.h"
#include "modules/error_report/report_ranking.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

/// As `gnomon compare` prints it, but without the numbers of an empty set.
Json error_to_json(const MaskMetrics &p_metrics) {
	Json json = Json::parse(to_json(p_metrics));
	if (p_metrics.receiver.pixel_count == 0) {
		json.erase("receiver");
	}
	if (p_metrics.penumbra.pixel_count == 0) {
		json.erase("penumbra");
	}
	return json;
}

Json time_to_json(const MaskTiming &p_time) {
	Json json = { { "frames", p_time.frame_count }, { "cost_ms", p_time.cost_ms } };
	json.update(to_json(p_time.total));
	json["passes"] = to_json(p_time.passes);
	return json;
}

Json machine_to_json(const ReportMachine &p_machine) {
	return { { "device", p_machine.device }, { "driver", p_machine.driver },
		{ "cpu", p_machine.cpu }, { "threads", p_machine.threads } };
}

Json stability_to_json(const ReportStability &p_stability) {
	Json json = { { "wrong_share", p_stability.wrong_share }, { "warnings", p_stability.warnings },
		{ "refusal", p_stability.refusal } };
	if (p_stability.temporal_rmse) {
		json["temporal_rmse"] = *p_stability.temporal_rmse;
	}
	if (p_stability.condition) {
		const VisibilityCondition &condition = *p_stability.condition;
		json["condition"] = { { "number", condition.number }, { "rounding", condition.rounding },
			{ "truth_error", condition.truth_error }, { "error", condition.error },
			{ "cause", get_cause_name(condition.cause) } };
	}
	return json;
}

/// Everything of a cell but which cell it is.
void add_result(const ReportCell &p_cell, Json &r_json) {
	r_json["status"] = get_status_name(p_cell.status);
	r_json["message"] = p_cell.message;
	if (p_cell.error) {
		r_json["error"] = { { "all", error_to_json(p_cell.error->all) },
			{ "whole_light", error_to_json(p_cell.error->whole_light) } };
	}
	if (p_cell.stability) {
		r_json["stability"] = stability_to_json(*p_cell.stability);
	}
	if (p_cell.is_ok() && !p_cell.stability) { // a sweep's points are drawn, not timed
		r_json["time"] = time_to_json(p_cell.time);
		r_json["bytes"] = p_cell.bytes;
	}
	if (p_cell.is_ok()) {
		r_json["image"] = p_cell.image;
	}
}

Json cell_to_json(const Report &p_report, const ReportCell &p_cell) {
	Json json = { { "configuration", p_cell.configuration_index },
		{ "technique", p_cell.technique }, { "setting", p_cell.setting },
		{ "properties", p_cell.properties }, { "record", p_cell.record },
		{ "machine", p_cell.machine_index } };
	add_result(p_cell, json);
	if (const std::optional<double> ratio = p_report.compute_time_ratio(p_cell)) {
		json["time_ratio"] = *ratio;
	}
	return json;
}

Json configuration_to_json(const ReportConfiguration &p_configuration) {
	Json json = { { "id", p_configuration.id }, { "group", p_configuration.group },
		{ "sweep", p_configuration.sweep }, { "value", p_configuration.value },
		{ "scene", p_configuration.scene }, { "light", p_configuration.light },
		{ "light_type", p_configuration.light_type },
		{ "light_size_m", p_configuration.light_size_m },
		{ "light_angular_distance_deg", p_configuration.light_angular_distance_deg },
		{ "light_count", p_configuration.light_count },
		{ "scene_size_m", p_configuration.scene_size_m },
		{ "size_px", { p_configuration.size_px.x, p_configuration.size_px.y } },
		{ "triangles", p_configuration.triangle_count }, { "edges", p_configuration.edge_count },
		{ "record", p_configuration.record } };
	json.update(truth_result_to_json(p_configuration));
	return json;
}

Json technique_to_json(const ReportTechnique &p_technique) {
	return { { "id", p_technique.id }, { "name", p_technique.name },
		{ "source", p_technique.source }, { "color", p_technique.color },
		{ "is_baseline", p_technique.is_baseline } };
}

} // namespace

Json cell_result_to_json(const ReportCell &p_cell, const ReportMachine &p_machine) {
	Json json;
	add_result(p_cell, json);
	json["machine"] = machine_to_json(p_machine);
	return json;
}

std::string dump_json(const Json &p_json) {
	return p_json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json truth_result_to_json(const ReportConfiguration &p_configuration) {
	Json json = { { "status", get_status_name(p_configuration.status) },
		{ "message", p_configuration.message } };
	if (p_configuration.has_truth() && p_configuration.status == ReportStatus::OK) {
		const ReportTruth &truth = p_configuration.truth;
		json["receiver_pixels"] = truth.receiver_pixel_count;
		json["penumbra_pixels"] = truth.penumbra_pixel_count;
		json["truth"] = { { "standard_error", truth.standard_error }, { "wall_ms", truth.wall_ms },
			{ "image", truth.image } };
		if (truth.is_double) {
			json["truth"]["is_double"] = true;
		}
	}
	return json;
}

Json to_json(const Report &p_report) {
	Json json = { { "format", REPORT_FORMAT }, { "version", REPORT_VERSION },
		{ "project", p_report.project }, { "samples", p_report.sample_count },
		{ "precision_percent", p_report.precision_percent }, { "program", p_report.program },
		{ "failed_count", p_report.count(ReportStatus::FAILED) },
		{ "missing_count", p_report.count(ReportStatus::MISSING) } };
	for (const char *list : { "machines", "techniques", "configurations", "cells" }) {
		json[list] = Json::array();
	}
	for (const ReportMachine &machine : p_report.machines) {
		json["machines"].push_back(machine_to_json(machine));
	}
	for (const ReportTechnique &technique : p_report.techniques) {
		json["techniques"].push_back(technique_to_json(technique));
	}
	for (size_t index = 0; index < p_report.configurations.size(); ++index) {
		json["configurations"].push_back(configuration_to_json(p_report.configurations[index]));
		if (!p_report.configurations[index].is_stability()) {
			json["configurations"].back()["pareto"] = find_pareto_front(p_report, index);
		}
	}
	for (const ReportCell &cell : p_report.cells) {
		json["cells"].push_back(cell_to_json(p_report, cell));
	}
	json["ranking"] = to_json(rank_settings(p_report));
	json["best_settings"] = to_json(rank_best_settings(p_report));
	json["scaling"] = to_json(p_report, find_scaling_curves(p_report));
	for (const ReportPartInfo &info : ReportPartRegistry::get_all()) {
		json[info.id] = info.part->to_json(p_report);
	}
	return json;
}

} // namespace gnomon
