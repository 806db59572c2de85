#include "modules/error_report/report_json.h"

#include <doctest/doctest.h>

#include <map>
#include <vector>

using namespace gnomon;

namespace {

using Row = std::vector<std::string>;

/// A strict parser for CSV (RFC 4180); rows end with LF or CRLF. Checks fail on invalid CSV.
std::vector<Row> parse_csv(const std::string &p_csv) {
	std::vector<Row> rows(1, Row(1));
	bool is_quoted = false;
	for (size_t at = 0; at < p_csv.size(); ++at) {
		const char letter = p_csv[at];
		const char next = at + 1 < p_csv.size() ? p_csv[at + 1] : '\0';
		if (is_quoted) {
			if (letter != '"') {
				rows.back().back() += letter;
			} else if (next == '"') {
				rows.back().back() += letter;
				++at;
			} else {
				is_quoted = false;
				CHECK((next == ',' || next == '\r' || next == '\n')); // nothing follows the quote
			}
		} else if (letter == '"') {
			CHECK(rows.back().back().empty()); // a quote is only allowed at the start of a field
			is_quoted = true;
		} else if (letter == ',') {
			rows.back().emplace_back();
		} else if (letter == '\n') {
			rows.push_back(Row(1));
		} else if (letter == '\r') {
			CHECK(next == '\n');
		} else {
			rows.back().back() += letter;
		}
	}
	CHECK_FALSE(is_quoted);
	CHECK(rows.back() == Row(1)); // the last row also has a line end
	rows.pop_back();
	return rows;
}

/// Returns the rows as maps from column name to field. All rows must have the same length.
std::vector<std::map<std::string, std::string>> read_rows(const Report &p_report) {
	const std::vector<Row> rows = parse_csv(to_csv(p_report));
	REQUIRE(rows.size() == p_report.cells.size() + 1);
	std::vector<std::map<std::string, std::string>> named(p_report.cells.size());
	for (size_t row = 1; row < rows.size(); ++row) {
		REQUIRE(rows[row].size() == rows[0].size());
		for (size_t column = 0; column < rows[0].size(); ++column) {
			named[row - 1][rows[0][column]] = rows[row][column];
		}
		CHECK(named[row - 1].size() == rows[0].size()); // no name twice
	}
	return named;
}

/// Returns a report with one configuration of the matrix and two cells: the baseline "hard", and
/// "soft".
Report make_listed_report() {
	Report report;
	report.program = "1.0 abc";
	report.sample_count = 1024;
	report.machines = { { "GPU 1", "driver 2", "CPU 3", 4 } };
	report.techniques = { { "hard", "", "", "", true }, { "soft", "", "", "" } };
	ReportConfiguration configuration;
	configuration.id = "sphere/Spot/0.4";
	configuration.scene = "sphere";
	configuration.light = "Spot";
	configuration.light_type = "spot";
	configuration.light_size_m = 0.4;
	configuration.size_px = { 640, 480 };
	configuration.triangle_count = 5132;
	configuration.status = ReportStatus::OK;
	configuration.reference.standard_error = 0.0021;
	report.configurations = { configuration };
	ReportCell cell;
	cell.technique = "hard";
	cell.status = ReportStatus::OK;
	cell.time.cost_ms = 4;
	report.cells.push_back(cell);
	cell.technique = "soft";
	cell.setting = "32 taps";
	cell.properties = { { "soft_bias", "0.5" }, { "soft_taps", "32" } };
	cell.error = ReportError();
	// pixel_count, mae, rmse, p99, bias, wrong
	cell.error->all.receiver = { 100, 0.01, 0.02, 0.03, -0.04, 0.05 };
	cell.error->all.penumbra = { 50, 0.11, 0.12, 0.13, -0.14, 0.15 };
	cell.error->all.umbra_over = 0.25;
	cell.error->whole_light.penumbra = { 40, 0.21, 0.22, 0.23, -0.24, 0.26 };
	cell.time = { .frame_count = 20,
		.passes = {},
		.total = { 9, 10, 11, 12 }, // gpu_ms, gpu_ms_p90, wall_ms, wall_ms_p90
		.cost_ms = 8 };
	cell.bytes = 9314128000;
	report.cells.push_back(cell);
	return report;
}

/// Checks that fields of measured values are empty.
void check_no_numbers(const std::map<std::string, std::string> &p_row) {
	for (const char *name : { "receiver_mae", "receiver_rmse", "receiver_p99", "receiver_bias",
				 "receiver_wrong", "penumbra_wrong", "whole_light_penumbra_wrong", "penumbra_mae",
				 "penumbra_bias", "whole_light_penumbra_mae", "whole_light_penumbra_bias",
				 "umbra_over", "frames", "cost_ms", "gpu_ms", "gpu_ms_p90", "wall_ms",
				 "wall_ms_p90", "bytes", "time_ratio" }) {
		CAPTURE(name);
		CHECK(p_row.at(name).empty());
	}
}

} // namespace

TEST_CASE("[ErrorReport] each value of a cell is in the CSV column of its name") {
	const auto rows = read_rows(make_listed_report());
	const std::map<std::string, std::string> expected = { { "program", "1.0 abc" },
		{ "device", "GPU 1" }, { "driver", "driver 2" }, { "cpu", "CPU 3" }, { "threads", "4" },
		{ "configuration", "sphere/Spot/0.4" }, { "group", "matrix" }, { "sweep", "" },
		{ "value", "0" }, { "scene", "sphere" }, { "light", "Spot" }, { "light_type", "spot" },
		{ "light_size_m", "0.4" }, { "light_angular_distance_deg", "0" }, { "light_count", "1" },
		{ "width_px", "640" }, { "height_px", "480" }, { "triangles", "5132" }, { "edges", "0" },
		{ "technique", "soft" }, { "setting", "32 taps" },
		{ "properties", "soft_bias=0.5 soft_taps=32" }, { "status", "ok" }, { "message", "" },
		{ "samples", "1024" }, { "standard_error", "0.0021" }, { "receiver_pixels", "100" },
		{ "penumbra_pixels", "50" }, { "whole_light_penumbra_pixels", "40" },
		{ "receiver_mae", "0.01" }, { "receiver_rmse", "0.02" }, { "receiver_p99", "0.03" },
		{ "receiver_bias", "-0.04" }, { "receiver_wrong", "0.05" }, { "penumbra_wrong", "0.15" },
		{ "whole_light_penumbra_wrong", "0.26" }, { "penumbra_mae", "0.11" },
		{ "penumbra_rmse", "0.12" }, { "penumbra_p99", "0.13" }, { "penumbra_bias", "-0.14" },
		{ "whole_light_penumbra_mae", "0.21" }, { "whole_light_penumbra_rmse", "0.22" },
		{ "whole_light_penumbra_p99", "0.23" }, { "whole_light_penumbra_bias", "-0.24" },
		{ "umbra_over", "0.25" }, { "frames", "20" }, { "cost_ms", "8" }, { "gpu_ms", "9" },
		{ "gpu_ms_p90", "10" }, { "wall_ms", "11" }, { "wall_ms_p90", "12" },
		{ "bytes", "9314128000" }, { "time_ratio", "2" } };
	for (const auto &[name, value] : rows[1]) {
		CAPTURE(name);
		CHECK(value == expected.at(name));
	}
	CHECK(rows[0].at("penumbra_mae").empty()); // no error was measured
	CHECK(rows[0].at("time_ratio") == "1");
}

TEST_CASE("[ErrorReport] the CSV field of an absent `wrong` is empty") {
	Report report = make_listed_report();
	report.cells[1].error->all.penumbra.wrong.reset();
	const auto row = read_rows(report)[1];
	CHECK(row.at("penumbra_wrong").empty());
	CHECK(row.at("penumbra_bias") == "-0.14");
	CHECK(row.at("receiver_wrong") == "0.05");
}

TEST_CASE("[ErrorReport] only CSV fields with commas, quotes or line ends are quoted") {
	Report report = make_listed_report();
	report.program = "a,b";
	report.cells[1].setting = "the \"best\"";
	report.cells[1].message = "first\nsecond\r\nthird";
	report.configurations[0].light = "\"";
	report.configurations[0].scene = "it's; a\tscene";
	const auto rows = read_rows(report);
	CHECK(rows[1].at("program") == "a,b");
	CHECK(rows[1].at("setting") == "the \"best\"");
	CHECK(rows[1].at("message") == "first\nsecond\r\nthird");
	CHECK(rows[1].at("scene") == "it's; a\tscene");
	const std::string csv = to_csv(report);
	CHECK(csv.find("\"a,b\",GPU 1,") != std::string::npos);
	CHECK(csv.find(",\"the \"\"best\"\"\",") != std::string::npos);
	CHECK(csv.find(",it's; a\tscene,\"\"\"\",") != std::string::npos);
}

TEST_CASE("[ErrorReport] a CSV row with an empty first field has all fields") {
	Report report = make_listed_report();
	report.program.clear();
	report.machines.clear();
	const auto rows = read_rows(report);
	CHECK(rows[1].at("device").empty());
	CHECK(rows[1].at("threads").empty()); // the machine index is out of range
	CHECK(rows[1].at("configuration") == "sphere/Spot/0.4");
}

TEST_CASE("[ErrorReport] the CSV row of a failed cell has a message and no measured values") {
	Report report = make_listed_report();
	report.cells[1].status = ReportStatus::FAILED; // although the cell has an error metric
	report.cells[1].message = "no memory";
	const auto row = read_rows(report)[1];
	CHECK(row.at("status") == "failed");
	CHECK(row.at("message") == "no memory");
	CHECK(row.at("device") == "GPU 1"); // the machine on which it failed
	check_no_numbers(row);
}

TEST_CASE("[ErrorReport] the CSV row of a missing cell has neither values nor a machine") {
	Report report = make_listed_report();
	report.cells[1].status = ReportStatus::MISSING;
	report.configurations[0].status = ReportStatus::MISSING;
	const auto row = read_rows(report)[1];
	CHECK(row.at("status") == "missing");
	for (const char *name : { "device", "threads", "standard_error" }) {
		CAPTURE(name);
		CHECK(row.at(name).empty());
	}
	check_no_numbers(row);
}

TEST_CASE("[ErrorReport] the CSV row of a scaling cell has a time and no reference") {
	Report report = make_listed_report();
	report.configurations[0].group = TRIANGLES_GROUP;
	report.cells[1].error.reset();
	const auto row = read_rows(report)[1];
	CHECK(row.at("samples").empty());
	CHECK(row.at("standard_error").empty());
	CHECK(row.at("cost_ms") == "8");
}
