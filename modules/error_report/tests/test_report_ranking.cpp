#include "modules/error_report/report_ranking.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <vector>

using namespace gnomon;
using Indices = std::vector<size_t>;

namespace {

/// Returns a report without cells: two machines and the techniques "hard" (the baseline), "soft"
/// and "best".
Report make_ranked_report(size_t p_configuration_count = 1) {
	Report report;
	report.machines = { { "a", "", "", 2 }, { "b", "", "", 8 } };
	report.techniques = { { "hard", "", "", "", true }, { "soft", "", "", "" },
		{ "best", "", "", "" } };
	report.configurations.resize(p_configuration_count);
	return report;
}

/// Adds a measured cell whose errors are all proportional to p_mae, its penumbra MAE.
ReportCell &add_cell(Report &r_report, size_t p_configuration, const std::string &p_technique,
		double p_cost_ms, double p_mae, const std::string &p_setting = "default") {
	ReportCell cell;
	cell.configuration_index = p_configuration;
	cell.technique = p_technique;
	cell.setting = p_setting;
	cell.status = ReportStatus::OK;
	cell.time.cost_ms = p_cost_ms;
	cell.error = ReportError();
	// pixel_count, mae, rmse, p99, bias, wrong: different multiples, to detect swapped values.
	cell.error->all.penumbra = { 100, p_mae, p_mae * 2, p_mae * 4, -p_mae, p_mae / 4 };
	cell.error->all.receiver = { 400, p_mae / 4, p_mae / 2, p_mae, -p_mae / 4, p_mae / 8 };
	cell.error->all.umbra_over = p_mae / 2;
	cell.error->whole_light.penumbra = { .pixel_count = 50, .mae = p_mae * 3 };
	r_report.cells.push_back(cell);
	return r_report.cells.back();
}

} // namespace

TEST_CASE("[ErrorReport] no cell is both cheaper and closer than one on the Pareto front") {
	Report report = make_ranked_report(2);
	add_cell(report, 0, "hard", 8, 0.1); // dominated by the cell of 4 ms
	add_cell(report, 0, "hard", 1, 0.4);
	add_cell(report, 1, "hard", 0.5, 0.001); // in another configuration
	add_cell(report, 0, "soft", 4, 0.1);
	add_cell(report, 0, "best", 16, 0.05);
	CHECK(find_pareto_front(report, 0) == Indices{ 1, 3, 4 });
}

TEST_CASE("[ErrorReport] of cells with equal cost the front has the closest, on a tie the first") {
	Report report = make_ranked_report();
	add_cell(report, 0, "hard", 2, 0.3);
	add_cell(report, 0, "soft", 2, 0.2);
	add_cell(report, 0, "best", 2, 0.2);
	add_cell(report, 0, "best", 3, 0.2); // equal error, higher cost
	CHECK(find_pareto_front(report, 0) == Indices{ 1 });
}

TEST_CASE("[ErrorReport] cells without a penumbra error are in no front and no ranking") {
	Report report = make_ranked_report();
	add_cell(report, 0, "hard", 1, 0.01).status = ReportStatus::FAILED;
	add_cell(report, 0, "hard", 1, 0.01, "later").status = ReportStatus::MISSING;
	add_cell(report, 0, "soft", 1, 0).error.reset();
	add_cell(report, 0, "soft", 1, 0, "no penumbra").error->all.penumbra.pixel_count = 0;
	CHECK(find_pareto_front(report, 0).empty());
	CHECK_FALSE(find_within_budget(report, 0, 100));
	CHECK(rank_settings(report).empty());
	CHECK(rank_best_settings(report).empty());
}

TEST_CASE("[ErrorReport] find_within_budget returns the closest cell within the budget") {
	Report report = make_ranked_report();
	add_cell(report, 0, "hard", 1, 0.4);
	add_cell(report, 0, "soft", 4, 0.1);
	add_cell(report, 0, "soft", 5, 0.3); // within a budget of 5, and not the closest
	add_cell(report, 0, "best", 16, 0.05);
	CHECK_FALSE(find_within_budget(report, 0, 0.999));
	CHECK(find_within_budget(report, 0, 1) == 0);
	CHECK(find_within_budget(report, 0, 5) == 1);
	CHECK(find_within_budget(report, 0, 1000) == 3);
}

TEST_CASE("[ErrorReport] settings are ranked by mean error, and rows have median times") {
	Report report = make_ranked_report(3);
	const double costs_ms[] = { 1, 2, 10 };
	for (size_t at = 0; at < 3; ++at) {
		add_cell(report, at, "hard", costs_ms[at], 0.5);
		add_cell(report, at, "soft", costs_ms[at] * (at + 2.0), 0.1 * double(at + 1));
	}
	add_cell(report, 1, "soft", 100, 0.05, "expensive").error->whole_light.penumbra.pixel_count = 0;
	// This cell is ignored only in whole_light_penumbra_mae.
	report.cells[1].error->whole_light.penumbra.pixel_count = 0;
	const std::vector<RankingRow> rows = rank_settings(report);
	REQUIRE(rows.size() == 3);
	CHECK(rows[0].setting == "expensive");
	CHECK(rows[0].time_ratio == 50);
	CHECK(rows[1].configuration_count == 3);
	CHECK(rows[1].penumbra_mae == doctest::Approx(0.2));
	CHECK(rows[1].penumbra_rmse == doctest::Approx(0.4));
	CHECK(rows[1].penumbra_p99 == doctest::Approx(0.8));
	CHECK(rows[1].penumbra_bias == doctest::Approx(-0.2));
	CHECK(rows[1].umbra_over == doctest::Approx(0.1));
	CHECK(rows[1].penumbra_wrong == doctest::Approx(0.05));
	CHECK(rows[1].receiver_wrong == doctest::Approx(0.025));
	REQUIRE(rows[1].whole_light_penumbra_mae);
	CHECK(*rows[1].whole_light_penumbra_mae == doctest::Approx(0.75)); // of 0.6 and 0.9
	CHECK(rows[1].cost_ms == 6);									   // of 2, 6, 40
	CHECK(rows[1].time_ratio == 3);									   // of 2, 3, 4
	CHECK(rows[2].technique == "hard");
}

TEST_CASE("[ErrorReport] the mean of `wrong` is unset if one cell has no value") {
	Report report = make_ranked_report(2);
	add_cell(report, 0, "soft", 1, 0.4);
	add_cell(report, 1, "soft", 1, 0.4).error->all.penumbra.wrong.reset();
	const std::vector<RankingRow> rows = rank_settings(report);
	REQUIRE(rows.size() == 1);
	CHECK_FALSE(rows[0].penumbra_wrong);
	CHECK(rows[0].receiver_wrong == doctest::Approx(0.05));
}

TEST_CASE("[ErrorReport] the best setting is chosen separately in each configuration") {
	Report report = make_ranked_report(2);
	add_cell(report, 0, "soft", 1, 0.3, "few");
	add_cell(report, 0, "soft", 9, 0.1, "many");
	add_cell(report, 1, "soft", 3, 0.2, "few");
	add_cell(report, 1, "soft", 7, 0.4, "many");
	add_cell(report, 1, "best", 7, 0.1);
	const std::vector<RankingRow> rows = rank_best_settings(report);
	REQUIRE(rows.size() == 2);
	CHECK(rows[1].technique == "soft");
	CHECK(rows[1].setting == "best in each");
	CHECK(rows[1].configuration_count == 2);
	CHECK(rows[1].penumbra_mae == doctest::Approx(0.15)); // of 0.1 and 0.2
	CHECK(rows[1].cost_ms == 6);						  // of 9 and 3
	CHECK_FALSE(rows[1].time_ratio);					  // there is no baseline
}

TEST_CASE("[ErrorReport] time ratios are relative to the baseline in the same configuration") {
	Report report = make_ranked_report(2);
	add_cell(report, 0, "soft", 6, 0.1);
	add_cell(report, 0, "hard", 4, 0.4);
	add_cell(report, 1, "hard", 2, 0.4);
	add_cell(report, 1, "soft", 1, 0.4);
	CHECK(report.compute_time_ratio(report.cells[0]) == 1.5);
	CHECK(report.compute_time_ratio(report.cells[1]) == 1);
	CHECK(report.compute_time_ratio(report.cells[3]) == 0.5);
}

TEST_CASE("[ErrorReport] without a baseline of the same machine there is no time ratio") {
	Report report = make_ranked_report();
	add_cell(report, 0, "hard", 4, 0.4);
	add_cell(report, 0, "soft", 6, 0.1);
	ReportCell &hard = report.cells[0];
	ReportCell &soft = report.cells[1];
	soft.machine_index = 1;
	CHECK_FALSE(report.compute_time_ratio(soft));
	hard.machine_index = 1;
	CHECK(report.compute_time_ratio(soft) == 1.5);
	hard.status = ReportStatus::FAILED;
	CHECK_FALSE(report.compute_time_ratio(soft));
	hard.status = ReportStatus::OK;
	hard.time.cost_ms = 0;
	CHECK_FALSE(report.compute_time_ratio(soft));
	hard.time.cost_ms = 4;
	report.techniques[0].is_baseline = false;
	CHECK_FALSE(report.compute_time_ratio(soft));
}

TEST_CASE("[ErrorReport] count() includes references, but not of configurations that have none") {
	Report report = make_ranked_report(4);
	report.configurations[0].status = ReportStatus::OK;
	report.configurations[1].status = ReportStatus::FAILED;
	report.configurations[3].group = LIGHTS_GROUP; // has no reference
	add_cell(report, 0, "hard", 1, 0.1);
	add_cell(report, 0, "soft", 1, 0.1).status = ReportStatus::FAILED;
	add_cell(report, 0, "best", 1, 0.1).status = ReportStatus::MISSING;
	CHECK(report.count(ReportStatus::OK) == 2);
	CHECK(report.count(ReportStatus::FAILED) == 2);
	CHECK(report.count(ReportStatus::MISSING) == 2);
}

TEST_CASE("[ErrorReport] points of scaling curves are sorted by value, without failed cells") {
	Report report = make_ranked_report(5);
	const std::pair<const char *, double> groups[] = { { LIGHTS_GROUP, 16 }, { LIGHTS_GROUP, 1 },
		{ LIGHTS_GROUP, 4 }, { TRIANGLES_GROUP, 2000 }, { MATRIX_GROUP, 0.4 } };
	for (size_t at = 0; at < 5; ++at) {
		report.configurations[at].group = groups[at].first;
		report.configurations[at].value = groups[at].second;
		add_cell(report, at, "soft", 1.0 + double(at), 0).error.reset();
	}
	add_cell(report, 2, "hard", 9, 0).error.reset();
	add_cell(report, 3, "hard", 9, 0).status = ReportStatus::FAILED;
	CHECK(scaling_to_json(report).dump() ==
			R"([{"name":"triangles","unit":"triangles","series":[{"technique":"soft",)"
			R"("points":[{"value":2000.0,"cost_ms":4.0,"cell":3}]}]},)"
			R"({"name":"lights","unit":"lights","series":[{"technique":"hard",)"
			R"("points":[{"value":4.0,"cost_ms":9.0,"cell":5}]},{"technique":"soft",)"
			R"("points":[{"value":1.0,"cost_ms":2.0,"cell":1},)"
			R"({"value":4.0,"cost_ms":3.0,"cell":2},{"value":16.0,"cost_ms":1.0,"cell":0}]}]}])");
	CHECK(scaling_to_json(make_ranked_report()).empty());
}

TEST_CASE("[ErrorReport] ranking rows have the documented keys, and omit unset values") {
	RankingRow row = { .technique = "soft",
		.setting = "32 taps",
		.configuration_count = 33,
		.penumbra_mae = 0.5,
		.penumbra_rmse = 0.25,
		.penumbra_p99 = 1,
		.penumbra_bias = -0.5,
		.penumbra_wrong = 0.25,
		.receiver_wrong = 0.5,
		.umbra_over = 0.125,
		.whole_light_penumbra_mae = 0.75,
		.cost_ms = 12,
		.time_ratio = 2.5 };
	const std::string expected =
			R"([{"technique":"soft","setting":"32 taps","configuration_count":33,)"
			R"("penumbra_mae":0.5,"penumbra_rmse":0.25,"penumbra_p99":1.0,"penumbra_bias":-0.5,)"
			R"("umbra_over":0.125,"cost_ms":12.0)";
	CHECK(to_json(std::vector<RankingRow>{ row }).dump() ==
			expected + R"(,"penumbra_wrong":0.25,"receiver_wrong":0.5,)" +
					R"("whole_light_penumbra_mae":0.75,"time_ratio":2.5}])");
	row.time_ratio.reset();
	row.penumbra_wrong.reset();
	row.receiver_wrong.reset();
	row.whole_light_penumbra_mae.reset();
	CHECK(to_json(std::vector<RankingRow>{ row }).dump() == expected + "}]");
}
