#include "modules/error_report/report_json.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/error_report/report_part.h"
#include "modules/error_report/report_ranking.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <concepts>
#include <type_traits>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

/// Matches Plain and const Plain: a Writer visits const values, a Reader non-const ones.
template <typename T, typename Plain>
concept MaybeConst = std::same_as<std::remove_const_t<T>, Plain>;

/// Key of ReportCell::part_result, named after the first part that had results.
const char *const PART_RESULT_KEY = "stability";

/// The result of a cell whose part this build lacks, and of each cell until read_part_result(). It
/// is kept unchanged.
class UnknownResult : public PartResult {
public:
	explicit UnknownResult(Json p_json) : json(std::move(p_json)) {}
	Json to_json() const override { return json; }

private:
	Json json;
};

/// Writes fields to JSON. Writer and Reader are visitors with the same interface: each overload of
/// describe() below lists the fields of a struct once, for both directions.
struct Writer {
	Json &json;

	/// Returns whether an optional field is written: if it is set.
	bool has(const char * /*p_name*/, bool p_is_set) const { return p_is_set; }
	/// Writes a derived value, which the Reader ignores.
	void add_computed(const char *p_name, const Json &p_value) const { json[p_name] = p_value; }

	template <typename Describe> void part(const char *p_name, Describe p_describe) const {
		p_describe(Writer{ json[p_name] = Json::object() });
	}
	template <typename T>
	void operator()(const char *p_name, const std::optional<T> &p_value) const {
		if (p_value) {
			(*this)(p_name, *p_value);
		}
	}
	void operator()(const char *p_name, const std::shared_ptr<const PartResult> &p_result) const {
		if (p_result) {
			json[p_name] = p_result->to_json();
		}
	}
	void operator()(const char *p_name, const glm::uvec2 &p_value) const {
		json[p_name] = { p_value.x, p_value.y };
	}
	template <typename T> void operator()(const char *p_name, const T &p_value) const {
		if constexpr (std::is_enum_v<T>) {
			json[p_name] = get_name(p_value);
		} else if constexpr (requires { describe(*this, p_value); }) {
			describe(Writer{ json[p_name] = Json::object() }, p_value);
		} else if constexpr (requires { describe(*this, p_value.front()); }) {
			json[p_name] = Json::array();
			for (const auto &value : p_value) {
				describe(Writer{ json[p_name].emplace_back(Json::object()) }, value);
			}
		} else {
			json[p_name] = p_value;
		}
	}
};

/// Reads fields from JSON. A missing field or another type is a Json::exception.
struct Reader {
	const Json &json;

	bool has(const char *p_name, bool /*p_is_set*/) const { return json.contains(p_name); }
	void add_computed(const char * /*p_name*/, const Json & /*p_value*/) const {}

	template <typename Describe> void part(const char *p_name, Describe p_describe) const {
		p_describe(Reader{ json.at(p_name) });
	}
	template <typename T> void operator()(const char *p_name, std::optional<T> &r_value) const {
		r_value.reset();
		if (json.contains(p_name)) {
			(*this)(p_name, r_value.emplace());
		}
	}
	void operator()(const char *p_name, std::shared_ptr<const PartResult> &r_result) const {
		r_result =
				json.contains(p_name) ? std::make_shared<UnknownResult>(json.at(p_name)) : nullptr;
	}
	void operator()(const char *p_name, glm::uvec2 &r_value) const {
		r_value = { json.at(p_name).at(0), json.at(p_name).at(1) };
	}
	template <typename T> void operator()(const char *p_name, T &r_value) const {
		const Json &value = json.at(p_name);
		if constexpr (std::is_enum_v<T>) {
			r_value = find_value<T>(p_name, value);
		} else if constexpr (requires { describe(*this, r_value); }) {
			describe(Reader{ value }, r_value);
		} else if constexpr (requires { describe(*this, r_value.front()); }) {
			r_value.clear();
			for (const Json &item : value) {
				describe(Reader{ item }, r_value.emplace_back());
			}
		} else {
			value.get_to(r_value);
		}
	}

private:
	/// Returns the enum value with that name. All enums of the format have three values.
	template <typename T> static T find_value(const char *p_field, const std::string &p_name) {
		for (const T value : { T(0), T(1), T(2) }) {
			if (p_name == get_name(value)) {
				return value;
			}
		}
		fail(p_field, " is \"", p_name, "\", must be ", get_name(T(0)), ", ", get_name(T(1)),
				" or ", get_name(T(2)), ".");
	}
};

/// Visits several fields; the arguments are names and fields in turn.
template <typename Visitor, typename Value, typename... Rest>
void describe_fields(
		const Visitor &p_visitor, const char *p_name, Value &r_value, Rest &...r_rest) {
	p_visitor(p_name, r_value);
	if constexpr (sizeof...(Rest) > 0) {
		describe_fields(p_visitor, r_rest...);
	}
}

void describe_values(const auto &p_visitor, MaybeConst<ErrorMetrics> auto &r_metrics) {
	describe_fields(p_visitor, "mae", r_metrics.mae, "rmse", r_metrics.rmse, "p99", r_metrics.p99,
			"bias", r_metrics.bias, "wrong", r_metrics.wrong); // absent in older reports
}

/// The form that `gnomon compare` prints, but without the metrics of an empty set of pixels.
void describe(const auto &p_visitor, MaybeConst<MaskMetrics> auto &r_metrics) {
	p_visitor("pixels", r_metrics.receiver.pixel_count);
	if (p_visitor.has("receiver", r_metrics.receiver.pixel_count > 0)) {
		p_visitor.part("receiver",
				[&](const auto &p_part) { describe_values(p_part, r_metrics.receiver); });
	}
	if (p_visitor.has("penumbra", r_metrics.penumbra.pixel_count > 0)) {
		p_visitor.part("penumbra", [&](const auto &p_part) {
			p_part("pixels", r_metrics.penumbra.pixel_count);
			describe_values(p_part, r_metrics.penumbra);
			p_part("umbra_over", r_metrics.umbra_over);
		});
	}
}

void describe(const auto &p_visitor, MaybeConst<ReportError> auto &r_error) {
	describe_fields(p_visitor, "all", r_error.all, "whole_light", r_error.whole_light);
}

void describe(const auto &p_visitor, MaybeConst<FrameCost> auto &r_cost) {
	describe_fields(p_visitor, "gpu_ms", r_cost.gpu_ms, "gpu_ms_p90", r_cost.gpu_ms_p90, "wall_ms",
			r_cost.wall_ms, "wall_ms_p90", r_cost.wall_ms_p90);
}

void describe(const auto &p_visitor, MaybeConst<PassMedians> auto &r_pass) {
	p_visitor("name", r_pass.name);
	describe(p_visitor, r_pass.cost);
	p_visitor("is_on_host", r_pass.is_on_host);
}

void describe(const auto &p_visitor, MaybeConst<MaskTiming> auto &r_time) {
	describe_fields(p_visitor, "frames", r_time.frame_count, "cost_ms", r_time.cost_ms);
	describe(p_visitor, r_time.total);
	p_visitor("passes", r_time.passes);
}

void describe(const auto &p_visitor, MaybeConst<ReportMachine> auto &r_machine) {
	describe_fields(p_visitor, "device", r_machine.device, "driver", r_machine.driver, "cpu",
			r_machine.cpu, "threads", r_machine.threads);
}

void describe(const auto &p_visitor, MaybeConst<ReportTechnique> auto &r_technique) {
	describe_fields(p_visitor, "id", r_technique.id, "name", r_technique.name, "source",
			r_technique.source, "color", r_technique.color, "is_baseline", r_technique.is_baseline);
}

/// The fields of a cell that its record contains: results, without the identification.
void describe_result(const auto &p_visitor, MaybeConst<ReportCell> auto &r_cell) {
	describe_fields(p_visitor, "status", r_cell.status, "message", r_cell.message, "error",
			r_cell.error, PART_RESULT_KEY, r_cell.part_result);
	if (r_cell.is_ok() && !r_cell.part_result) { // cells of report parts are not timed
		describe_fields(p_visitor, "time", r_cell.time, "bytes", r_cell.bytes);
	}
	if (r_cell.is_ok()) {
		p_visitor("image", r_cell.image);
	}
}

void describe(const auto &p_visitor, MaybeConst<ReportCell> auto &r_cell) {
	describe_fields(p_visitor, "configuration", r_cell.configuration_index, "technique",
			r_cell.technique, "setting", r_cell.setting, "properties", r_cell.properties, "record",
			r_cell.record, "machine", r_cell.machine_index);
	describe_result(p_visitor, r_cell);
}

/// The fields of a configuration that the record of its reference contains.
void describe_result(const auto &p_visitor, MaybeConst<ReportConfiguration> auto &r_configuration) {
	describe_fields(
			p_visitor, "status", r_configuration.status, "message", r_configuration.message);
	const bool has_reference =
			r_configuration.has_reference() && r_configuration.status == ReportStatus::OK;
	if (p_visitor.has("reference_mask", has_reference)) {
		auto &reference = r_configuration.reference;
		describe_fields(p_visitor, "receiver_pixels", reference.receiver_pixel_count,
				"penumbra_pixels", reference.penumbra_pixel_count);
		p_visitor.part("reference_mask", [&](const auto &p_part) {
			describe_fields(p_part, "standard_error", reference.standard_error, "wall_ms",
					reference.wall_ms, "image", reference.image);
			if (p_part.has("is_double", reference.is_double)) {
				p_part("is_double", reference.is_double);
			}
		});
	}
}

void describe(const auto &p_visitor, MaybeConst<ReportConfiguration> auto &r_configuration) {
	describe_fields(p_visitor, "id", r_configuration.id, "group", r_configuration.group);
	if (p_visitor.has("sweep", /*p_is_set=*/true)) { // absent in older reports
		p_visitor("sweep", r_configuration.sweep);
	}
	describe_fields(p_visitor, "value", r_configuration.value, "scene", r_configuration.scene,
			"light", r_configuration.light, "light_type", r_configuration.light_type,
			"light_size_m", r_configuration.light_size_m, "light_angular_distance_deg",
			r_configuration.light_angular_distance_deg, "light_count", r_configuration.light_count,
			"scene_size_m", r_configuration.scene_size_m, "size_px", r_configuration.size_px,
			"triangles", r_configuration.triangle_count, "edges", r_configuration.edge_count,
			"record", r_configuration.record);
	describe_result(p_visitor, r_configuration);
}

/// The fields of a scene image that its record contains.
void describe_result(const auto &p_visitor, MaybeConst<ReportSceneImage> auto &r_image) {
	describe_fields(p_visitor, "status", r_image.status, "message", r_image.message, "image",
			r_image.image);
}

void describe(const auto &p_visitor, MaybeConst<ReportSceneImage> auto &r_image) {
	describe_fields(p_visitor, "scene", r_image.scene, "has_shadows", r_image.has_shadows, "record",
			r_image.record);
	describe_result(p_visitor, r_image);
}

void describe(const auto &p_visitor, MaybeConst<Report> auto &r_report) {
	describe_fields(p_visitor, "project", r_report.project, "samples", r_report.sample_count,
			"precision_percent", r_report.precision_percent, "program", r_report.program);
	p_visitor.add_computed("failed_count", r_report.count(ReportStatus::FAILED));
	p_visitor.add_computed("missing_count", r_report.count(ReportStatus::MISSING));
	if (p_visitor.has("scene_images", /*p_is_set=*/true)) { // absent in version 1
		p_visitor("scene_images", r_report.scene_images);
	}
	describe_fields(p_visitor, "machines", r_report.machines, "techniques", r_report.techniques,
			"configurations", r_report.configurations, "cells", r_report.cells);
}

void rename_key(Json &r_json, const char *p_old, const char *p_new) {
	if (r_json.is_object() && r_json.contains(p_old)) {
		r_json[p_new] = r_json[p_old];
		r_json.erase(p_old);
	}
}

/// Converts a record or a whole report of version 1, which called the reference "truth". The
/// results of report parts are converted by ReportPart::read_result.
void upgrade(Json &r_json) {
	rename_key(r_json, "truth", "reference_mask");
	if (!r_json.is_object()) {
		return;
	}
	for (const char *list : { "configurations", "cells" }) {
		if (r_json.contains(list)) {
			for (Json &item : r_json[list]) {
				upgrade(item);
			}
		}
	}
}

/// Replaces the UnknownResult of a cell by what the ReportPart of its group reads from it.
void read_part_result(const Report &p_report, ReportCell &r_cell) {
	const std::string &group = p_report.configurations[r_cell.configuration_index].group;
	const ReportPart *part = ReportPartRegistry::find_part(group);
	if (part != nullptr && r_cell.part_result) {
		r_cell.part_result = part->read_result(r_cell.part_result->to_json());
	}
}

Report read_report(Json p_json) {
	const int version = p_json.value("version", 0);
	if (p_json.value("format", "") != REPORT_FORMAT || version < 1 || version > REPORT_VERSION) {
		fail("its format is not ", REPORT_FORMAT, " of version 1..", REPORT_VERSION, ".");
	}
	upgrade(p_json);
	Report report;
	describe(Reader{ p_json }, report);
	for (size_t index = 0; index < report.cells.size(); ++index) {
		ReportCell &cell = report.cells[index];
		const bool has_machine = !cell.is_ok() || cell.machine_index < report.machines.size();
		if (cell.configuration_index >= report.configurations.size() || !has_machine) {
			fail("cell ", index, " has configuration ", cell.configuration_index, " of ",
					report.configurations.size(), " and machine ", cell.machine_index, " of ",
					report.machines.size(), "; the indices must be below these counts.");
		}
		read_part_result(report, cell);
	}
	return report;
}

/// Reads the results of a cell, configuration or scene image into r_owner; p_finish(owner) is
/// called last. If the JSON has another format, throws an Error and leaves r_owner unchanged.
template <typename Owner> void read_result(Json p_json, Owner &r_owner, auto p_finish) {
	try {
		upgrade(p_json);
		Owner owner = r_owner;
		describe_result(Reader{ p_json }, owner);
		p_finish(owner);
		r_owner = std::move(owner);
	} catch (const Json::exception &error) {
		fail("Record \"", r_owner.record, "\" has another form: ", error.what(), ".");
	}
}

} // namespace

std::string dump_json(const Json &p_json) {
	return p_json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json cell_result_to_json(const ReportCell &p_cell, const ReportMachine &p_machine) {
	Json json;
	describe_result(Writer{ json }, p_cell);
	Writer{ json }("machine", p_machine);
	return json;
}

ReportMachine read_cell_machine(const Json &p_json) {
	try {
		ReportMachine machine;
		Reader{ p_json }("machine", machine);
		return machine;
	} catch (const Json::exception &error) {
		fail("A record has another form: ", error.what(), ".");
	}
}

void read_cell_result(const Json &p_json, Report &r_report, ReportCell &r_cell) {
	const ReportMachine machine = read_cell_machine(p_json);
	read_result(p_json, r_cell, [&](ReportCell &r_read) { read_part_result(r_report, r_read); });
	auto &machines = r_report.machines;
	const auto found = std::ranges::find(machines, machine);
	r_cell.machine_index = static_cast<size_t>(found - machines.begin());
	if (found == machines.end()) {
		machines.push_back(machine);
	}
}

Json reference_result_to_json(const ReportConfiguration &p_configuration) {
	Json json;
	describe_result(Writer{ json }, p_configuration);
	return json;
}

Json scene_image_result_to_json(const ReportSceneImage &p_image) {
	Json json;
	describe_result(Writer{ json }, p_image);
	return json;
}

void read_scene_image_result(const Json &p_json, ReportSceneImage &r_image) {
	read_result(p_json, r_image, [](const ReportSceneImage &) {});
}

void read_reference_result(const Json &p_json, ReportConfiguration &r_configuration) {
	read_result(p_json, r_configuration, [](const ReportConfiguration &) {});
}

Json to_json(const Report &p_report) {
	Json json = { { "format", REPORT_FORMAT }, { "version", REPORT_VERSION } };
	describe(Writer{ json }, p_report);
	for (size_t index = 0; index < p_report.configurations.size(); ++index) {
		if (p_report.configurations[index].is_matrix()) {
			json["configurations"][index]["pareto"] = find_pareto_front(p_report, index);
		}
	}
	for (size_t index = 0; index < p_report.cells.size(); ++index) {
		if (const auto ratio = p_report.compute_time_ratio(p_report.cells[index])) {
			json["cells"][index]["time_ratio"] = *ratio;
		}
	}
	json["ranking"] = to_json(rank_settings(p_report));
	json["best_settings"] = to_json(rank_best_settings(p_report));
	json["scaling"] = scaling_to_json(p_report);
	for (const ReportPartInfo &info : ReportPartRegistry::get_all()) {
		json[info.id] = info.part->to_json(p_report);
	}
	return json;
}

Report load_report(const std::filesystem::path &p_path) {
	try {
		return read_report(Json::parse(load_text_file(p_path)));
	} catch (const Json::exception &error) {
		fail("Report ", p_path, " cannot be read: ", error.what(),
				". It must be a report.json or plan.json that `gnomon report` wrote.");
	} catch (const Error &error) {
		fail("Report ", p_path, " cannot be read: ", error.what());
	}
}

} // namespace gnomon
