#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/error_report/report_folder.h"
#include "modules/error_report/report_json.h"
#include "modules/error_report/run_report.h"
#include "modules/error_report/tests/scripted_masks.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

/// Suppresses log messages of expected failures in the output of the tests.
struct QuietLog {
	LogSink before = set_log_sink([](LogLevel, const std::string &) {});
	~QuietLog() { set_log_sink(before); }
};

Report run(const ReportPlan &p_plan, MaskSource &r_source, const fs::path &p_folder,
		const ReportRunOptions &p_options = {}) {
	RecordStore store(get_record_folder(p_folder));
	save_plan(p_folder, p_plan.report);
	return run_report(p_plan, r_source, store, p_options);
}

std::string to_text(const Report &p_report) {
	return to_json(p_report).dump(1);
}

} // namespace

TEST_CASE("[ErrorReport] a run compares every cell with its reference") {
	TemporaryFolder folder;
	const ReportPlan plan = make_scripted_plan(2);
	ScriptedMaskSource masks;
	const Report report = run(plan, masks, folder.path);
	CHECK(masks.reference_count == 6);
	CHECK(masks.measure_count == plan.report.cells.size());
	CHECK(report.count(ReportStatus::OK) == 6 + 14 + 4); // references, cells, scene images
	REQUIRE(report.machines.size() == 1);
	CHECK(report.machines[0].device == "scripted");
	for (const ReportCell &cell : report.cells) {
		REQUIRE(cell.error);
		// The reference is a ramp of eighths, and the error a constant fraction of it. Pixels with
		// reference 0 are not penumbra; the mean of the others is 0.5.
		const double fraction = cell.technique == "hard" ? 0.25 : 0.125;
		CHECK(cell.error->all.penumbra.mae == doctest::Approx(0.5 * fraction));
		CHECK(cell.error->all.penumbra.pixel_count == 16 * 14);
		CHECK(cell.error->whole_light.receiver.pixel_count == 16 * 16 - 1);
		CHECK(cell.time.cost_ms == doctest::Approx(1.0));
		CHECK(report.compute_time_ratio(cell) == doctest::Approx(1.0));
		CHECK(fs::exists(get_record_folder(folder.path) / cell.image));
	}
	CHECK(report.configurations[0].reference.standard_error == doctest::Approx(1.0 / 64));
	CHECK(report.configurations[0].reference.penumbra_pixel_count == 16 * 14);
}

TEST_CASE("[ErrorReport] a run killed before any one cell and then resumed gives the same report") {
	const ReportPlan plan = make_scripted_plan(2);
	const size_t cell_count = plan.report.cells.size();
	TemporaryFolder whole_folder;
	ScriptedMaskSource whole_masks;
	const std::string whole = to_text(run(plan, whole_masks, whole_folder.path));
	QuietLog quiet;
	for (size_t kill_after_count = 0; kill_after_count < cell_count; ++kill_after_count) {
		CAPTURE(kill_after_count);
		TemporaryFolder folder;
		ScriptedMaskSource masks;
		masks.kill_after_count = kill_after_count;
		CHECK_THROWS_AS(run(plan, masks, folder.path), Killed);
		ScriptedMaskSource rest;
		ReportRunOptions options;
		options.resumes = true;
		CHECK(to_text(run(plan, rest, folder.path, options)) == whole);
		CHECK(rest.measure_count == cell_count - kill_after_count);
	}
}

TEST_CASE("[ErrorReport] a finished run that is resumed measures nothing") {
	TemporaryFolder folder;
	QuietLog quiet;
	const ReportPlan plan = make_scripted_plan(1);
	ScriptedMaskSource masks;
	const std::string whole = to_text(run(plan, masks, folder.path));
	ScriptedMaskSource none;
	CHECK(to_text(run(plan, none, folder.path, { .resumes = true })) == whole);
	CHECK(none.reference_count == 0);
	CHECK(none.measure_count == 0);
}

TEST_CASE("[ErrorReport] without resume everything is measured again") {
	TemporaryFolder folder;
	const ReportPlan plan = make_scripted_plan(1);
	ScriptedMaskSource masks;
	run(plan, masks, folder.path);
	ScriptedMaskSource again;
	run(plan, again, folder.path);
	CHECK(again.measure_count == plan.report.cells.size());
	CHECK(again.reference_count == masks.reference_count);
}

TEST_CASE("[ErrorReport] a resumed run measures only damaged records again") {
	TemporaryFolder folder;
	QuietLog quiet;
	const ReportPlan plan = make_scripted_plan(2);
	ScriptedMaskSource masks;
	const std::string whole = to_text(run(plan, masks, folder.path));
	const fs::path cells = get_record_folder(folder.path);
	const fs::path json = cells / (plan.report.cells[3].record + ".json");
	std::string record = load_text_file(json);
	const size_t offset = record.find("\"mae\":");
	REQUIRE(offset != std::string::npos);
	// Changes the first decimal of the value, which begins with "0.".
	record[offset + 8] = record[offset + 8] == '5' ? '6' : '5';
	save_file_atomically(json, record);
	const fs::path png = cells / (plan.report.cells[9].record + ".png");
	save_file_atomically(png, load_text_file(png).substr(0, 20));
	ScriptedMaskSource rest;
	CHECK(to_text(run(plan, rest, folder.path, { .resumes = true })) == whole);
	CHECK(rest.measure_count == 2);
}

TEST_CASE("[ErrorReport] a resumed run traces a reference again if its record is damaged") {
	TemporaryFolder folder;
	QuietLog quiet;
	const ReportPlan plan = make_scripted_plan(1);
	ScriptedMaskSource masks;
	const std::string whole = to_text(run(plan, masks, folder.path));
	const std::string &name = plan.report.configurations[1].record;
	save_file_atomically(get_record_folder(folder.path) / (name + ".json"), "{}");
	ScriptedMaskSource rest;
	CHECK(to_text(run(plan, rest, folder.path, { .resumes = true })) == whole);
	CHECK(rest.reference_count == 1);
	CHECK(rest.measure_count == 0);
}

TEST_CASE("[ErrorReport] a failed cell does not end the run, and a resumed run measures it again") {
	TemporaryFolder folder;
	QuietLog quiet;
	const ReportPlan plan = make_scripted_plan(1);
	ScriptedMaskSource masks;
	masks.failing_technique = "soft";
	const Report report = run(plan, masks, folder.path);
	CHECK(report.count(ReportStatus::FAILED) == 4);
	CHECK(report.count(ReportStatus::OK) == 3 + 3 + 2);
	for (const ReportCell &cell : report.cells) {
		CHECK((cell.message == "the device is sad") == (cell.technique == "soft"));
	}
	ScriptedMaskSource fixed_masks;
	const Report second = run(plan, fixed_masks, folder.path, { .resumes = true });
	CHECK(fixed_masks.measure_count == 4);
	CHECK(second.count(ReportStatus::OK) == 3 + 7 + 2);
	CHECK(std::all_of(second.cells.begin(), second.cells.end(),
			[](const ReportCell &p_cell) { return p_cell.message.empty(); }));
}

TEST_CASE("[ErrorReport] running out of memory fails only that cell, with advice in its message") {
	TemporaryFolder folder;
	QuietLog quiet;
	const ReportPlan plan = make_scripted_plan(1);
	ScriptedMaskSource masks;
	masks.failing_technique = "hard"; // the first cell of each configuration
	masks.runs_out_of_memory = true;
	const Report report = run(plan, masks, folder.path);
	CHECK(report.count(ReportStatus::FAILED) == 3);
	CHECK(report.count(ReportStatus::OK) == 3 + 4 + 2);
	CHECK(report.cells[0].message.starts_with("Out of memory. Close other programs"));
}

TEST_CASE("[ErrorReport] a lost device ends the run, and a resumed run measures the rest") {
	TemporaryFolder folder;
	QuietLog quiet;
	const ReportPlan plan = make_scripted_plan(2);
	TemporaryFolder whole_folder;
	ScriptedMaskSource whole_masks;
	const std::string whole = to_text(run(plan, whole_masks, whole_folder.path));
	ScriptedMaskSource masks;
	masks.lose_device_after_count = 5;
	CHECK_THROWS_WITH_AS(run(plan, masks, folder.path),
			"The device was lost. Restart it. What was measured is saved: go on with --resume.",
			DeviceLost);
	ScriptedMaskSource rest;
	CHECK(to_text(run(plan, rest, folder.path, { .resumes = true })) == whole);
	CHECK(rest.measure_count == plan.report.cells.size() - 5);
}

TEST_CASE("[ErrorReport] if a reference fails, its cells fail with its message") {
	TemporaryFolder folder;
	QuietLog quiet;
	const ReportPlan plan = make_scripted_plan(1);
	ScriptedMaskSource masks;
	masks.fails_reference = true;
	const Report report = run(plan, masks, folder.path);
	CHECK(report.count(ReportStatus::FAILED) == 3 + 7);
	CHECK(report.configurations[0].message == "no rays today");
	CHECK(report.cells[0].message == "Its reference failed: no rays today");
	CHECK(masks.measure_count == 0);
}

TEST_CASE("[ErrorReport] merged shards equal the report of a single run") {
	const ReportPlan plan = make_scripted_plan(2);
	TemporaryFolder whole_folder;
	ScriptedMaskSource whole_masks;
	const std::string whole = to_text(run(plan, whole_masks, whole_folder.path));
	TemporaryFolder folder;
	std::vector<fs::path> shard_folders;
	size_t measure_count = 0;
	for (uint32_t index = 0; index < 4; ++index) {
		shard_folders.push_back(folder.path / std::to_string(index));
		ScriptedMaskSource masks;
		const Report shard_report =
				run(plan, masks, shard_folders.back(), { .shard_index = index, .shard_count = 4 });
		CHECK(shard_report.count(ReportStatus::MISSING) > 0);
		measure_count += masks.measure_count;
	}
	CHECK(measure_count == plan.report.cells.size());
	CHECK(to_text(merge_reports(shard_folders, folder.path / "all")) == whole);
	CHECK(to_text(merge_reports({ folder.path / "all" }, folder.path / "all")) == whole);
	shard_folders.pop_back();
	CHECK(merge_reports(shard_folders, folder.path / "three").count(ReportStatus::MISSING) > 0);
}

TEST_CASE("[ErrorReport] shards of different plans are not merged") {
	TemporaryFolder folder;
	ScriptedMaskSource masks;
	run(make_scripted_plan(1), masks, folder.path / "a");
	run(make_scripted_plan(2), masks, folder.path / "b");
	CHECK_THROWS_WITH_AS(merge_reports({ folder.path / "a", folder.path / "b" }, folder.path / "c"),
			doctest::Contains("not planned alike"), Error);
	CHECK_THROWS_WITH_AS(merge_reports({ folder.path / "none" }, folder.path / "c"),
			doctest::Contains("plan.json"), Error);
}

TEST_CASE("[ErrorReport] a resumed run measures cells of another machine again") {
	TemporaryFolder folder;
	QuietLog quiet;
	const ReportPlan plan = make_scripted_plan(1);
	ScriptedMaskSource other;
	other.device = "another";
	other.kill_after_count = 3;
	CHECK_THROWS_AS(run(plan, other, folder.path), Killed);
	ScriptedMaskSource masks;
	const Report report = run(plan, masks, folder.path, { .resumes = true });
	CHECK(masks.measure_count == plan.report.cells.size());
	REQUIRE(report.machines.size() == 1);
	CHECK(report.machines[0].device == "scripted");
}

TEST_CASE("[ErrorReport] resuming a folder of another plan is an Error and keeps its records") {
	TemporaryFolder folder;
	ScriptedMaskSource masks;
	run(make_scripted_plan(1), masks, folder.path);
	check_resumable(folder.path, make_scripted_plan(1).report);
	check_resumable(folder.path / "new", make_scripted_plan(2).report);
	CHECK_THROWS_WITH_AS(check_resumable(folder.path, make_scripted_plan(2).report),
			doctest::Contains("with other options"), Error);
	const RecordStore store(get_record_folder(folder.path));
	CHECK(collect_report(make_scripted_plan(1).report, store).count(ReportStatus::MISSING) == 0);
}

TEST_CASE("[ErrorReport] shards may write to the same folder, in any order") {
	const ReportPlan plan = make_scripted_plan(2);
	TemporaryFolder whole_folder;
	ScriptedMaskSource whole_masks;
	const std::string whole = to_text(run(plan, whole_masks, whole_folder.path));
	TemporaryFolder folder;
	for (const uint32_t index : { 2u, 0u, 1u }) {
		ScriptedMaskSource masks;
		run(plan, masks, folder.path, { .shard_index = index, .shard_count = 3 });
	}
	const RecordStore store(get_record_folder(folder.path));
	CHECK(to_text(collect_report(plan.report, store)) == whole);
}

TEST_CASE("[ErrorReport] expensive settings are distributed over all shards") {
	const ReportPlan plan = make_scripted_plan(3); // one expensive cell per scene
	for (uint32_t index = 0; index < 3; ++index) {
		TemporaryFolder folder;
		ScriptedMaskSource masks;
		const Report shard_report =
				run(plan, masks, folder.path, { .shard_index = index, .shard_count = 3 });
		CHECK(std::count_if(shard_report.cells.begin(), shard_report.cells.end(),
					  [](const ReportCell &p_cell) {
						  return p_cell.is_ok() && p_cell.setting == "many";
					  }) == 1);
	}
}

TEST_CASE("[ErrorReport] a merge prefers successful records and replaces an earlier merge") {
	TemporaryFolder folder;
	QuietLog quiet;
	const ReportPlan plan = make_scripted_plan(1);
	ScriptedMaskSource failing;
	failing.failing_technique = "soft";
	run(plan, failing, folder.path / "a");
	const std::vector<fs::path> one = { folder.path / "a" };
	CHECK(merge_reports(one, folder.path / "all").count(ReportStatus::FAILED) == 4);
	ScriptedMaskSource fixed_masks;
	run(plan, fixed_masks, folder.path / "b");
	const std::vector<fs::path> both = { folder.path / "a", folder.path / "b" };
	CHECK(merge_reports(both, folder.path / "all").count(ReportStatus::FAILED) == 0);
	CHECK(merge_reports(one, folder.path / "all").count(ReportStatus::FAILED) == 4);
}
