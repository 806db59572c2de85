// Debian has no C++ library that writes CSV; that for C (libcsv) would save few of these lines.
#include "modules/core/text.h"
#include "modules/error_report/report_json.h"

#include <vector>

namespace gnomon {

namespace {

/// Quotes a field as RFC 4180 requires.
std::string quote(const std::string &p_text) {
	if (p_text.find_first_of(",\"\r\n") == std::string::npos) {
		return p_text;
	}
	std::string quoted = "\"";
	for (const char letter : p_text) {
		quoted += letter;
		if (letter == '"') {
			quoted += letter;
		}
	}
	return quoted + "\"";
}

std::string join(const std::vector<std::string> &p_fields) {
	std::string row;
	for (size_t index = 0; index < p_fields.size(); ++index) {
		row += (index == 0 ? "" : ",") + quote(p_fields[index]);
	}
	return row + "\n";
}

std::string join(const std::map<std::string, std::string> &p_properties) {
	std::string joined;
	for (const auto &[name, value] : p_properties) {
		joined += (joined.empty() ? "" : " ") + name + "=" + value;
	}
	return joined;
}

void add_metrics(const ErrorMetrics *p_metrics, std::vector<std::string> &r_fields) {
	r_fields.push_back(p_metrics ? text(p_metrics->pixel_count) : "");
	if (!p_metrics || p_metrics->pixel_count == 0) {
		r_fields.insert(r_fields.end(), 5, ""); // no pixels, none of the five values below
		return;
	}
	for (const double value :
			{ p_metrics->mae, p_metrics->rmse, p_metrics->p99, p_metrics->bias }) {
		r_fields.push_back(text(value));
	}
	r_fields.push_back(p_metrics->wrong ? text(*p_metrics->wrong) : "");
}

void add_times(const ReportCell &p_cell, std::vector<std::string> &r_fields) {
	if (!p_cell.is_ok() || p_cell.part_result) {
		// Instead of the seven values below: cells of report parts are not timed.
		r_fields.insert(r_fields.end(), 7, "");
		return;
	}
	const FrameCost &total = p_cell.time.total;
	r_fields.push_back(text(p_cell.time.frame_count));
	for (const double value : { p_cell.time.cost_ms, total.gpu_ms, total.gpu_ms_p90, total.wall_ms,
				 total.wall_ms_p90 }) {
		r_fields.push_back(text(value));
	}
	r_fields.push_back(text(p_cell.bytes));
}

} // namespace

std::string to_csv(const Report &p_report) {
	std::vector<std::string> names = { "program", "device", "driver", "cpu", "threads",
		"configuration", "group", "sweep", "value", "scene", "light", "light_type", "light_size_m",
		"light_angular_distance_deg", "light_count", "width_px", "height_px", "triangles", "edges",
		"technique", "setting", "properties", "status", "message", "samples", "standard_error" };
	for (const char *set : { "receiver", "penumbra", "whole_light_penumbra" }) {
		for (const char *metric : { "pixels", "mae", "rmse", "p99", "bias", "wrong" }) {
			names.push_back(text(set, "_", metric));
		}
	}
	names.insert(names.end(),
			{ "umbra_over", "frames", "cost_ms", "gpu_ms", "gpu_ms_p90", "wall_ms", "wall_ms_p90",
					"bytes", "time_ratio" });
	std::string csv = join(names);
	for (const ReportCell &cell : p_report.cells) {
		const ReportConfiguration &at = p_report.configurations[cell.configuration_index];
		const bool has_machine = cell.status != ReportStatus::MISSING &&
				cell.machine_index < p_report.machines.size();
		const ReportMachine machine =
				has_machine ? p_report.machines[cell.machine_index] : ReportMachine();
		const bool has_reference = at.has_reference() && at.status == ReportStatus::OK;
		const ReportError *error = cell.is_ok() && cell.error ? &*cell.error : nullptr;
		std::vector<std::string> fields = { p_report.program, machine.device, machine.driver,
			machine.cpu, has_machine ? text(machine.threads) : "", at.id, at.group, at.sweep,
			text(at.value), at.scene, at.light, at.light_type, text(at.light_size_m),
			text(at.light_angular_distance_deg), text(at.light_count), text(at.size_px.x),
			text(at.size_px.y), text(at.triangle_count), text(at.edge_count), cell.technique,
			cell.setting, join(cell.properties), get_name(cell.status), cell.message,
			at.has_reference() ? text(p_report.sample_count) : "",
			has_reference ? text(at.reference.standard_error) : "" };
		add_metrics(error ? &error->all.receiver : nullptr, fields);
		add_metrics(error ? &error->all.penumbra : nullptr, fields);
		add_metrics(error ? &error->whole_light.penumbra : nullptr, fields);
		fields.push_back(error ? text(error->all.umbra_over) : "");
		add_times(cell, fields);
		const std::optional<double> ratio = p_report.compute_time_ratio(cell);
		fields.push_back(ratio ? text(*ratio) : "");
		csv += join(fields);
	}
	return csv;
}

} // namespace gnomon
