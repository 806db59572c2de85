// Reading the forms that report_json.cpp writes.

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/error_report/report_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

ReportStatus parse_status(const std::string &p_name) {
	for (const ReportStatus status :
			{ ReportStatus::OK, ReportStatus::FAILED, ReportStatus::MISSING }) {
		if (p_name == get_status_name(status)) {
			return status;
		}
	}
	fail("status is \"", p_name, "\", must be ok, failed or missing");
}

ErrorCause parse_cause(const std::string &p_name) {
	for (const ErrorCause cause : { ErrorCause::METHOD, ErrorCause::ROUNDING, ErrorCause::TRUTH }) {
		if (p_name == get_cause_name(cause)) {
			return cause;
		}
	}
	fail("cause is \"", p_name, "\", must be method, rounding or truth");
}

ErrorMetrics read_metrics(const Json &p_json, uint64_t p_pixel_count) {
	ErrorMetrics metrics = { p_pixel_count, p_json.at("mae"), p_json.at("rmse"), p_json.at("p99"),
		p_json.at("bias"), std::nullopt };
	if (p_json.contains("wrong")) { // absent in older reports
		metrics.wrong = p_json.at("wrong").get<double>();
	}
	return metrics;
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

ReportStability read_stability(const Json &p_json) {
	ReportStability stability;
	stability.wrong_share = p_json.at("wrong_share");
	stability.warnings = p_json.at("warnings").get<std::vector<std::string>>();
	stability.refusal = p_json.at("refusal");
	if (p_json.contains("temporal_rmse")) {
		stability.temporal_rmse = p_json.at("temporal_rmse").get<double>();
	}
	if (p_json.contains("condition")) {
		const Json &json = p_json.at("condition");
		stability.condition = VisibilityCondition{ json.at("number"), json.at("rounding"),
			json.at("truth_error"), json.at("error"), parse_cause(json.at("cause")) };
	}
	return stability;
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
	if (p_json.contains("stability")) {
		cell.stability = read_stability(p_json.at("stability"));
	}
	if (cell.is_ok() && !cell.stability) {
		cell.time = read_time(p_json.at("time"));
		cell.bytes = p_json.at("bytes");
	}
	if (cell.is_ok()) {
		cell.image = p_json.at("image");
	}
	r_cell = std::move(cell);
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

ReportConfiguration read_configuration(const Json &p_json) {
	ReportConfiguration configuration;
	configuration.id = p_json.at("id");
	configuration.group = p_json.at("group");
	configuration.value = p_json.at("value");
	configuration.sweep = p_json.value("sweep", ""); // absent in older reports
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

Report read_report(const Json &p_json) {
	if (p_json.value("format", "") != REPORT_FORMAT ||
			p_json.value("version", 0) != REPORT_VERSION) {
		fail("its format is not ", REPORT_FORMAT, " of version ", REPORT_VERSION);
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

void read_truth_result(const Json &p_json, ReportConfiguration &r_configuration) {
	try {
		ReportConfiguration configuration = r_configuration;
		configuration.status = parse_status(p_json.at("status"));
		configuration.message = p_json.at("message");
		if (p_json.contains("truth")) {
			const Json &truth = p_json.at("truth");
			configuration.truth = { truth.at("standard_error"), truth.value("is_double", false),
				truth.at("wall_ms"), truth.at("image"), p_json.at("receiver_pixels"),
				p_json.at("penumbra_pixels") };
		}
		r_configuration = std::move(configuration);
	} catch (const Json::exception &error) {
		fail("Record \"", r_configuration.record, "\" has another form: ", error.what());
	}
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
