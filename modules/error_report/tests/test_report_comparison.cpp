#include "modules/error_report/report_comparison.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <vector>

using namespace gnomon;

namespace {

/// Returns a report with one configuration and two cells: "hard", the baseline, with 2 ms and a
/// penumbra MAE of 0.4, and "soft" with 6 ms and 0.1.
Report make_compared_report() {
	Report report;
	report.sample_count = 1024;
	report.machines = { { "a", "", "", 2 } };
	report.techniques = { { "hard", "", "", "", true }, { "soft", "", "", "" } };
	report.configurations.resize(1);
	report.configurations[0].id = "sphere/Spot/0.4";
	report.configurations[0].size_px = { 64, 64 };
	report.configurations[0].reference.standard_error = 0.002;
	ReportCell cell;
	cell.technique = "hard";
	cell.setting = "default";
	cell.status = ReportStatus::OK;
	cell.time.cost_ms = 2;
	// GPU time and its 90th percentile, then the same of the wall time: no spread.
	cell.time.total = { 2, 2, 3, 3 };
	cell.error = ReportError();
	cell.error->all.penumbra = { .pixel_count = 100, .mae = 0.4 };
	report.cells.push_back(cell);
	cell.technique = "soft";
	cell.setting = "32 taps";
	cell.time.cost_ms = 6;
	cell.time.total = { 6, 6, 7, 7 };
	cell.error->all.penumbra.mae = 0.1;
	report.cells.push_back(cell);
	return report;
}

Report make_compared_report(double p_mae, double p_cost_ms = 6) {
	Report report = make_compared_report();
	report.cells[1].error->all.penumbra.mae = p_mae;
	report.cells[1].time.cost_ms = p_cost_ms;
	return report;
}

size_t count_differences(const Report &p_old, const Report &p_new) {
	return compare_reports(p_old, p_new).differences.size();
}

/// Returns the only difference; fails if there is not exactly one.
ReportDifference find_difference(const Report &p_old, const Report &p_new) {
	const ReportComparison comparison = compare_reports(p_old, p_new);
	REQUIRE(comparison.differences.size() == 1);
	CHECK(comparison.has_regression() ==
			(comparison.differences[0].is_worse && !comparison.differences[0].is_of_time()));
	return comparison.differences[0];
}

} // namespace

TEST_CASE("[ErrorReport] equal reports do not differ") {
	const ReportComparison comparison =
			compare_reports(make_compared_report(), make_compared_report());
	CHECK(comparison.differences.empty());
	CHECK(comparison.compared_count == 2);
	CHECK(comparison.only_old_count + comparison.only_new_count == 0);
	CHECK(comparison.has_same_machine);
	CHECK(to_text(comparison).find("Nothing differs") != std::string::npos);
}

TEST_CASE("[ErrorReport] an error differs beyond 0.0005 plus 1 %, upwards and downwards") {
	const Report old_report = make_compared_report(); // 0.1: a margin of 0.0015
	CHECK(count_differences(old_report, make_compared_report(0.10149)) == 0);
	CHECK(count_differences(old_report, make_compared_report(0.09851)) == 0);
	const ReportDifference worse = find_difference(old_report, make_compared_report(0.10151));
	CHECK(worse.is_worse);
	CHECK(worse.what == "penumbra error");
	CHECK(worse.configuration == "sphere/Spot/0.4");
	CHECK(worse.old_value == 0.1);
	CHECK(worse.new_value == 0.10151);
	CHECK_FALSE(find_difference(old_report, make_compared_report(0.09849)).is_worse);
	// With an old error of 0 the margin is 0.0005.
	CHECK(count_differences(make_compared_report(0), make_compared_report(0.00049)) == 0);
	CHECK(find_difference(make_compared_report(0), make_compared_report(0.00051)).is_worse);
}

TEST_CASE("[ErrorReport] different sample counts widen the margin by both standard errors") {
	Report new_report = make_compared_report(0.1054);
	CHECK(find_difference(make_compared_report(), new_report).is_worse);
	new_report.sample_count = 256; // the margin is now 0.0015 + 0.002 + 0.002
	CHECK(count_differences(make_compared_report(), new_report) == 0);
	new_report.configurations[0].reference.standard_error = 0.0018;
	CHECK(find_difference(make_compared_report(), new_report).is_worse);
	new_report.cells[1].error->all.penumbra.mae = 0.0946;
	CHECK_FALSE(find_difference(make_compared_report(), new_report).is_worse);
}

TEST_CASE("[ErrorReport] a time ratio differs beyond 15 % and is never a regression") {
	const Report old_report = make_compared_report(); // three times the baseline
	CHECK(count_differences(old_report, make_compared_report(0.1, 6.89)) == 0);
	CHECK(count_differences(old_report, make_compared_report(0.1, 5.11)) == 0);
	const ReportDifference worse = find_difference(old_report, make_compared_report(0.1, 6.92));
	CHECK(worse.what == "time ratio");
	CHECK(worse.is_worse);
	CHECK(worse.old_value == 3);
	CHECK(worse.new_value == 3.46);
	CHECK_FALSE(find_difference(old_report, make_compared_report(0.1, 5.08)).is_worse);
}

TEST_CASE("[ErrorReport] a time ratio differs only beyond the spreads of its times") {
	Report old_report = make_compared_report();
	old_report.cells[1].time.total = { 6, 6 * 1.2, 7, 70 };	 // the spread of the GPU time is used
	Report new_report = make_compared_report(0.1, 6 * 1.29); // above 15 % and the spread of 20 %
	CHECK(find_difference(old_report, new_report).is_worse);
	new_report.cells[1].time.total = { 0, 0, 7, 7 * 1.1 }; // without GPU time that of the wall time
	CHECK(count_differences(old_report, new_report) == 0); // the spreads sum up to 30 %
	new_report.cells[1].time.cost_ms = 6 * 1.31;
	CHECK(find_difference(old_report, new_report).is_worse);
}

TEST_CASE("[ErrorReport] a slower machine alone is no difference") {
	Report slow = make_compared_report();
	slow.machines[0].device = "b";
	for (ReportCell &cell : slow.cells) {
		cell.time.cost_ms *= 5;
	}
	const ReportComparison comparison = compare_reports(make_compared_report(), slow);
	CHECK(comparison.differences.empty());
	CHECK_FALSE(comparison.has_same_machine);
	slow.cells[0].time.cost_ms = 2; // the baseline is unchanged, so "soft" is slower
	CHECK(find_difference(make_compared_report(), slow).what == "time ratio");
}

TEST_CASE("[ErrorReport] a cell that newly fails is a regression, one that now works is better") {
	Report failed = make_compared_report();
	failed.cells[1].status = ReportStatus::FAILED;
	failed.cells[1].message = "no memory";
	const ReportDifference worse = find_difference(make_compared_report(), failed);
	CHECK(worse.what == "status");
	CHECK(worse.is_worse);
	CHECK(to_text(compare_reports(make_compared_report(), failed)) ==
			"Against the old report: 1 cells that both measured, 0 only in the old, 0 only in the "
			"new.\n"
			"worse status: sphere/Spot/0.4, soft, 32 taps: fails now: no memory\n");
	CHECK_FALSE(find_difference(failed, make_compared_report()).is_worse);
	CHECK(count_differences(failed, failed) == 0);
	// Cells that were not measured are no difference.
	Report missing = make_compared_report();
	missing.cells[1].status = ReportStatus::MISSING;
	CHECK(count_differences(make_compared_report(), missing) == 0);
	CHECK(count_differences(missing, failed) == 0);
	CHECK(count_differences(failed, missing) == 0);
}

TEST_CASE("[ErrorReport] cells correspond if their names and image sizes are equal") {
	Report other = make_compared_report(0.9);
	const auto check_unmatched = [&] {
		const ReportComparison comparison = compare_reports(make_compared_report(), other);
		CHECK(comparison.differences.empty());
		CHECK(comparison.compared_count == 1); // the baseline
		CHECK(comparison.only_old_count == 1);
		CHECK(comparison.only_new_count == 1);
		other = make_compared_report(0.9); // for the next case
	};
	other.cells[1].setting = "64 taps";
	check_unmatched();
	other.cells[1].technique = "softer";
	check_unmatched();
	other.configurations.push_back(other.configurations[0]);
	other.configurations[1].id = "sphere/Spot/1.2";
	other.cells[1].configuration_index = 1;
	check_unmatched();
	other.configurations.push_back(other.configurations[0]);
	other.configurations[1].size_px = { 64, 32 };
	other.cells[1].configuration_index = 1;
	check_unmatched();
	// The indices of the cells do not matter.
	std::swap(other.cells[0], other.cells[1]);
	CHECK(find_difference(make_compared_report(), other).new_value == 0.9);
	other.cells.clear();
	CHECK(compare_reports(make_compared_report(), other).only_old_count == 2);
	CHECK(compare_reports(other, make_compared_report()).only_new_count == 2);
}

TEST_CASE("[ErrorReport] worse differences come first, in text and JSON") {
	Report new_report = make_compared_report(0.5);
	new_report.cells[0].error->all.penumbra.mae = 0.25; // better, and measured first
	new_report.cells[1].time.cost_ms = 4;				// better too
	const ReportComparison comparison = compare_reports(make_compared_report(), new_report);
	REQUIRE(comparison.differences.size() == 3);
	CHECK(to_text(comparison) ==
			"Against the old report: 2 cells that both measured, 0 only in the old, 0 only in the "
			"new.\n"
			"worse penumbra error: sphere/Spot/0.4, soft, 32 taps: 0.1 -> 0.5\n"
			"better penumbra error: sphere/Spot/0.4, hard, default: 0.4 -> 0.25\n"
			"better time ratio: sphere/Spot/0.4, soft, 32 taps: 3 -> 2 times the baseline\n");
	CHECK(to_json(comparison)["rows"][1].dump() ==
			R"({"configuration":"sphere/Spot/0.4","technique":"hard","setting":"default",)"
			R"("what":"penumbra error","old":0.4,"new":0.25,"change":-0.15000000000000002,)"
			R"("verdict":"better","message":""})");
}

TEST_CASE("[ErrorReport] a grown error outside the penumbra is a regression") {
	Report old_report = make_compared_report();
	Report new_report = make_compared_report();
	old_report.cells[1].error->all.receiver = { .pixel_count = 1000, .mae = 0.01 };
	new_report.cells[1].error->all.receiver = { .pixel_count = 1000, .mae = 0.03 };
	const ReportDifference worse = find_difference(old_report, new_report);
	CHECK(worse.what == "receiver error");
	CHECK(worse.is_worse);
	CHECK(compare_reports(old_report, new_report).has_regression());
}

TEST_CASE("[ErrorReport] the baseline's own time is compared on the same machine, beyond 30 %") {
	Report slow = make_compared_report();
	for (ReportCell &cell : slow.cells) {
		cell.time.cost_ms *= 1.29; // e.g. a slower common pass: no ratio changes
	}
	CHECK(count_differences(make_compared_report(), slow) == 0);
	for (ReportCell &cell : slow.cells) {
		cell.time.cost_ms *= 1.1;
	}
	const ReportDifference worse = find_difference(make_compared_report(), slow);
	CHECK(worse.what == "time");
	CHECK(worse.technique == "hard");
	// The spread of the baseline's time counts for ratios to it.
	Report unsteady = make_compared_report(0.1, 6 * 1.2);
	CHECK(find_difference(make_compared_report(), unsteady).what == "time ratio");
	unsteady.cells[0].time.total = { 2, 2.5, 3, 3 };
	CHECK(count_differences(make_compared_report(), unsteady) == 0);
}
