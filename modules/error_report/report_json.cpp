#include "modules/error_report/report_json.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/error_report/report_ranking.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

const char *const FORMAT = "gnomon_report";
const int VERSION = 1;

ReportStatus parse_status(const std::string &p_name) {
	for (const ReportStatus status :
			{ ReportStatus::OK, ReportStatus::FAILED, ReportStatus::MISSING }) {
		if (p_name == get_status_name(status)) {
			return status;
		}
	}
	fail("status is \"", p_name, "\", must be ok, failed or missing");
}

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

ErrorMetrics read_metrics(const Json &p_json, uint64_t p_pixel_count) {
	return { p_pixel_count, p_json.at("mae"), p_json.at("rmse"), p_json.at("p99"),
		p_json.at("bias") };
}

MaskMetrics read_error(const Json &p_json) {
	MaskMetrics metrics;
	if (p_json.contains("receiver")) {
		metrics.receiver = read_metrics(p_json.at("receiver"), p_json.at("pixels"));
	}
	if (p_json.contains("penumbra")) {
		const Json &penumbra = p_json.at("penumbra");
		metrics.penumbra = read_metrics(penumbra, penumbra.at("pixels"));
		metrics.umbra_over = penumbra.at("umbra_over");
	}
	return metrics;
}

Json time_to_json(const MaskTiming &p_time) {
	Json json = { { "frames", p_time.frame_count }, { "cost_ms", p_time.cost_ms } };
	json.update(to_json(p_time.total));
	json["passes"] = to_json(p_time.passes);
	return json;
}

MaskTiming read_time(const Json &p_json) {
	MaskTiming time;
	time.frame_count = p_json.at("frames");
	time.cost_ms = p_json.at("cost_ms");
	time.total = { p_json.at("gpu_ms"), p_json.at("gpu_ms_p90"), p_json.at("wall_ms"),
		p_json.at("wall_ms_p90") };
	for (const Json &pass : p_json.at("passes")) {
		time.passes.push_back({ pass.at("name"), pass.at("gpu_ms"), pass.at("wall_ms"),
				pass.at("is_on_host"), pass.at("gpu_ms_p90"), pass.at("wall_ms_p90") });
	}
	return time;
}

Json machine_to_json(const ReportMachine &p_machine) {
	return { { "device", p_machine.device }, { "driver", p_machine.driver },
		{ "cpu", p_machine.cpu }, { "threads", p_machine.threads } };
}

ReportMachine read_machine(const Json &p_json) {
	return { p_json.at("device"), p_json.at("driver"), p_json.at("cpu"), p_json.at("threads") };
}

size_t find_or_add_machine(Report &r_report, const ReportMachine &p_machine) {
	auto &machines = r_report.machines;
	const auto found = std::find(machines.begin(), machines.end(), p_machine);
	if (found != machines.end()) {
		return static_cast<size_t>(found - machines.begin());
	}
	machines.push_back(p_machine);
	return machines.size() - 1;
}

/// Everything of a cell but which cell it is.
void add_result(const ReportCell &p_cell, Json &r_json) {
	r_json["status"] = get_status_name(p_cell.status);
	r_json["message"] = p_cell.message;
	if (p_cell.error) {
		r_json["error"] = { { "all", error_to_json(p_cell.error->all) },
			{ "whole_light", error_to_json(p_cell.error->whole_light) } };
	}
	if (p_cell.is_ok()) {
		r_json["time"] = time_to_json(p_cell.time);
		r_json["bytes"] = p_cell.bytes;
		r_json["image"] = p_cell.image;
	}
}

void read_result(const Json &p_json, ReportCell &r_cell) {
	ReportCell cell = r_cell;
	cell.status = parse_status(p_json.at("status"));
	cell.message = p_json.at("message");
	if (p_json.contains("error")) {
		const Json &error = p_json.at("error");
		cell.error =
				ReportError{ read_error(error.at("all")), read_error(error.at("whole_light")) };
	}
	if (cell.is_ok()) {
		cell.time = read_time(p_json.at("time"));
		cell.bytes = p_json.at("bytes");
		cell.image = p_json.at("image");
	}
	r_cell = std::move(cell);
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

ReportCell read_cell(const Json &p_json) {
	ReportCell cell;
	cell.configuration_index = p_json.at("configuration");
	cell.technique = p_json.at("technique");
	cell.setting = p_json.at("setting");
	cell.properties = p_json.at("properties").get<std::map<std::string, std::string>>();
	cell.record = p_json.at("record");
	cell.machine_index = p_json.at("machine");
	read_result(p_json, cell);
	return cell;
}

Json configuration_to_json(const ReportConfiguration &p_configuration) {
	Json json = { { "id", p_configuration.id }, { "group", p_configuration.group },
		{ "value", p_configuration.value }, { "scene", p_configuration.scene },
		{ "light", p_configuration.light }, { "light_type", p_configuration.light_type },
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

ReportConfiguration read_configuration(const Json &p_json) {
	ReportConfiguration configuration;
	configuration.id = p_json.at("id");
	configuration.group = p_json.at("group");
	configuration.value = p_json.at("value");
	configuration.scene = p_json.at("scene");
	configuration.light = p_json.at("light");
	configuration.light_type = p_json.at("light_type");
	configuration.light_size_m = p_json.at("light_size_m");
	configuration.light_angular_distance_deg = p_json.at("light_angular_distance_deg");
	configuration.light_count = p_json.at("light_count");
	configuration.scene_size_m = p_json.at("scene_size_m");
	configuration.size_px = { p_json.at("size_px").at(0), p_json.at("size_px").at(1) };
	configuration.triangle_count = p_json.at("triangles");
	configuration.edge_count = p_json.at("edges");
	configuration.record = p_json.at("record");
	read_truth_result(p_json, configuration);
	return configuration;
}

Json technique_to_json(const ReportTechnique &p_technique) {
	return { { "id", p_technique.id }, { "name", p_technique.name },
		{ "source", p_technique.source }, { "color", p_technique.color },
		{ "is_baseline", p_technique.is_baseline } };
}

Report read_report(const Json &p_json) {
	if (p_json.value("format", "") != FORMAT || p_json.value("version", 0) != VERSION) {
		fail("its format is not ", FORMAT, " of version ", VERSION);
	}
	Report report;
	report.project = p_json.at("project");
	report.program = p_json.at("program");
	report.sample_count = p_json.at("samples");
	report.precision_percent = p_json.at("precision_percent");
	for (const Json &machine : p_json.at("machines")) {
		report.machines.push_back(read_machine(machine));
	}
	for (const Json &technique : p_json.at("techniques")) {
		report.techniques.push_back({ technique.at("id"), technique.at("name"),
				technique.at("source"), technique.at("color"), technique.at("is_baseline") });
	}
	for (const Json &configuration : p_json.at("configurations")) {
		report.configurations.push_back(read_configuration(configuration));
	}
	for (const Json &cell : p_json.at("cells")) {
		report.cells.push_back(read_cell(cell));
		const ReportCell &last = report.cells.back();
		const bool has_machine = !last.is_ok() || last.machine_index < report.machines.size();
		if (last.configuration_index >= report.configurations.size() || !has_machine) {
			fail("cell ", report.cells.size() - 1, " names configuration ",
					last.configuration_index, " of ", report.configurations.size(), " and machine ",
					last.machine_index, " of ", report.machines.size());
		}
	}
	return report;
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

ReportMachine read_cell_machine(const Json &p_json) {
	try {
		return read_machine(p_json.at("machine"));
	} catch (const Json::exception &error) {
		fail("A record has another form: ", error.what());
	}
}

void read_cell_result(const Json &p_json, Report &r_report, ReportCell &r_cell) {
	try {
		const ReportMachine machine = read_machine(p_json.at("machine"));
		read_result(p_json, r_cell);
		r_cell.machine_index = find_or_add_machine(r_report, machine);
	} catch (const Json::exception &error) {
		fail("Record \"", r_cell.record, "\" has another form: ", error.what());
	}
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
	}
	return json;
}

void read_truth_result(const Json &p_json, ReportConfiguration &r_configuration) {
	try {
		ReportConfiguration configuration = r_configuration;
		configuration.status = parse_status(p_json.at("status"));
		configuration.message = p_json.at("message");
		if (p_json.contains("truth")) {
			const Json &truth = p_json.at("truth");
			configuration.truth = { truth.at("standard_error"), truth.at("wall_ms"),
				truth.at("image"), p_json.at("receiver_pixels"), p_json.at("penumbra_pixels") };
		}
		r_configuration = std::move(configuration);
	} catch (const Json::exception &error) {
		fail("Record \"", r_configuration.record, "\" has another form: ", error.what());
	}
}

Json to_json(const Report &p_report) {
	Json json = { { "format", FORMAT }, { "version", VERSION }, { "project", p_report.project },
		{ "samples", p_report.sample_count }, { "precision_percent", p_report.precision_percent },
		{ "program", p_report.program }, { "failed_count", p_report.count(ReportStatus::FAILED) },
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
		json["configurations"].back()["pareto"] = find_pareto_front(p_report, index);
	}
	for (const ReportCell &cell : p_report.cells) {
		json["cells"].push_back(cell_to_json(p_report, cell));
	}
	json["ranking"] = to_json(rank_settings(p_report));
	json["best_settings"] = to_json(rank_best_settings(p_report));
	json["scaling"] = to_json(p_report, find_scaling_curves(p_report));
	json["stability"] = Json::array();
	return json;
}

Report load_report(const std::filesystem::path &p_path) {
	try {
		return read_report(Json::parse(load_text_file(p_path)));
	} catch (const Json::exception &error) {
		fail("Report ", p_path, " cannot be read: ", error.what(),
				". It must be a report.json or plan.json of this version of `gnomon report`.");
	} catch (const Error &error) {
		fail("Report ", p_path, " cannot be read: ", error.what(), ".");
	}
}

} // namespace gnomon
