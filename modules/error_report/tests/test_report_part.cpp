#include "modules/core/files.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/error_report/report_comparison.h"
#include "modules/error_report/report_json.h"
#include "modules/error_report/report_page.h"
#include "modules/error_report/report_part.h"
#include "modules/error_report/run_report.h"
#include "modules/error_report/tests/scripted_masks.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace gnomon;

namespace {

const char *const PART_ID = "made_up";

/// What FakePart stores in each cell.
class FakeResult : public PartResult {
public:
	int64_t number = 7;
	nlohmann::ordered_json to_json() const override { return { { "number", number } }; }
};

/// A part with one configuration, whose cells get half of the reference's visibility as their mask.
class FakePart : public ReportPart {
public:
	void plan(const ReportOptions &p_options, std::span<const ReportScene> /*p_scenes*/,
			const AddConfiguration &p_add) const override {
		const auto scene = make_scripted_scenes(1)[0].scene;
		const MaskTask task = { build_snapshot(*scene, *scene->find_nodes<Camera3D>().front()),
			"Light 1", p_options.size_px };
		ReportConfiguration configuration;
		configuration.id = "made_up/only";
		configuration.group = PART_ID;
		configuration.light = task.light;
		p_add(configuration, [task](const PropertyValues &) { return task; });
	}
	std::vector<TracedReference> trace_references(
			MaskSource &r_source, const MaskTask &p_task, uint32_t p_sample_count) const override {
		return { r_source.trace_reference(p_task, p_sample_count) };
	}
	MaskImage run_cell(MaskSource & /*r_source*/, const MaskTask & /*p_task*/,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const override {
		MaskImage mask = p_references.front().mask;
		for (float &visibility : mask.visibility) {
			visibility *= 0.5f;
		}
		r_report.cells[p_cell].error = ReportError();
		r_report.cells[p_cell].error->all = compute_mask_metrics(p_references.front().mask, mask);
		r_report.cells[p_cell].part_result = std::make_shared<FakeResult>();
		return mask;
	}
	std::shared_ptr<const PartResult> read_result(
			const nlohmann::ordered_json &p_json) const override {
		auto result = std::make_shared<FakeResult>();
		result->number = p_json.at("number");
		return result;
	}
	/// Numbers below 0 are unusable.
	std::optional<std::string> find_problem(const ReportCell &p_cell) const override {
		return p_cell.find_result<FakeResult>()->number < 0 ? std::optional<std::string>("minus")
															: std::nullopt;
	}
	nlohmann::ordered_json to_json(const Report &p_report) const override {
		return p_report.cells.size();
	}
	std::span<const PageFile> get_page_files() const override {
		static const PageFile FILES[] = { { "made_up.js", "/* the section of made_up */" } };
		return FILES;
	}
};

/// Registers a FakePart while it exists.
struct RegisteredPart {
	RegisteredPart() { ReportPartRegistry::add({ PART_ID, std::make_shared<FakePart>() }); }
	~RegisteredPart() { ReportPartRegistry::remove(PART_ID); }
};

/// Measures the configuration of FakePart with "hard" and "soft".
Report run_fake_part(const std::filesystem::path &p_folder, ScriptedMaskSource &r_masks) {
	RecordStore store(p_folder);
	return run_report(make_report_plan(make_scripted_options(), {}, make_scripted_techniques()),
			r_masks, store, {});
}

} // namespace

TEST_CASE("[ReportPart] a registered part is planned, measured and written under its id") {
	const TemporaryFolder folder;
	const RegisteredPart registered;
	ScriptedMaskSource masks;
	const Report report = run_fake_part(folder.path, masks);
	REQUIRE(report.configurations.size() == 1);
	CHECK(report.configurations[0].has_reference());
	REQUIRE(report.cells.size() == 2); // "hard" and "soft", each with its default setting
	for (const ReportCell &cell : report.cells) {
		CHECK(cell.is_ok());
		// Half of the reference, whose mean is 3.5 / 8 (see ScriptedMaskSource).
		CHECK(cell.error->all.receiver.mae == doctest::Approx(0.5 * 3.5 / 8));
		CHECK_FALSE(cell.image.empty());
	}
	CHECK(masks.reference_count == 1);
	CHECK(masks.measure_count == 0); // cells of a part are not timed
	const nlohmann::ordered_json json = to_json(report);
	CHECK(json.at(PART_ID) == 2); // what FakePart::to_json returns: the cell count
	CHECK_FALSE(json.at("cells")[0].contains("time"));
	const std::string page = build_report_page(json, RecordStore(folder.path));
	CHECK(page.find("/* the section of made_up */") != std::string::npos);
}

TEST_CASE(
		"[ReportPart] results of a part are loaded, and preserved by a build that lacks the part") {
	const TemporaryFolder folder;
	const std::filesystem::path path = folder.path / "report.json";
	ScriptedMaskSource masks;
	nlohmann::ordered_json json;
	{
		const RegisteredPart registered;
		json = to_json(run_fake_part(folder.path, masks));
		save_file_atomically(path, dump_json(json));
		const Report report = load_report(path);
		REQUIRE(report.cells[0].find_result<FakeResult>() != nullptr);
		CHECK(report.cells[0].find_result<FakeResult>()->number == 7);
		CHECK(to_json(report) == json);
		json["cells"][0]["stability"] = { { "digits", 7 } }; // not what FakePart writes
		save_file_atomically(folder.path / "wrong.json", dump_json(json));
		CHECK_THROWS_WITH_AS(
				load_report(folder.path / "wrong.json"), doctest::Contains("wrong.json"), Error);
	}
	const Report report = load_report(path);
	CHECK(report.cells[0].find_result<FakeResult>() == nullptr);
	const nlohmann::ordered_json preserved = to_json(report);
	CHECK(preserved.at("cells")[0].at("stability").at("number") == 7);
	CHECK(preserved.at("cells")[1] == json.at("cells")[1]);
	CHECK_FALSE(preserved.contains(PART_ID));
}

TEST_CASE("[ReportPart] a result that became unusable is a regression with its message") {
	const TemporaryFolder folder;
	const RegisteredPart registered;
	ScriptedMaskSource masks;
	const Report before = run_fake_part(folder.path, masks);
	CHECK_FALSE(compare_reports(before, before).has_regression());
	Report after = before;
	auto result = std::make_shared<FakeResult>();
	result->number = -1;
	after.cells[1].part_result = result;
	const ReportComparison comparison = compare_reports(before, after);
	CHECK(comparison.has_regression());
	REQUIRE(comparison.differences.size() == 1);
	CHECK(comparison.differences[0].what == "status");
	CHECK(comparison.differences[0].message == "minus");
	CHECK_FALSE(compare_reports(after, before).has_regression());
}

TEST_CASE("[ReportPart] without the part a report has neither its configurations nor its key") {
	const ReportPlan plan =
			make_report_plan(make_scripted_options(), {}, make_scripted_techniques());
	CHECK(plan.report.configurations.empty());
	CHECK_FALSE(to_json(plan.report).contains(PART_ID));
	CHECK(ReportPartRegistry::find_part(PART_ID) == nullptr);
}
