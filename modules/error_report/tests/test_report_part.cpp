#include "modules/core/tests/temporary_folder.h"
#include "modules/error_report/report_json.h"
#include "modules/error_report/report_part.h"
#include "modules/error_report/run_report.h"
#include "modules/error_report/tests/scripted_masks.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace gnomon;

namespace {

const char *const PART_ID = "made_up";

/// A part with one configuration, whose cells get half of the reference's visibility as their mask.
class FakePart : public ReportPart {
public:
	std::vector<std::string> list_sweeps() const override { return {}; }
	void plan(const ReportOptions &p_options, const AddConfiguration &p_add) const override {
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
		r_report.cells[p_cell].stability = ReportStability();
		return mask;
	}
	bool is_unusable(const ReportCell & /*p_cell*/) const override { return false; }
	nlohmann::ordered_json to_json(const Report &p_report) const override {
		return p_report.cells.size();
	}
};

/// Registers a FakePart while it exists.
struct RegisteredPart {
	RegisteredPart() { ReportPartRegistry::add({ PART_ID, std::make_shared<FakePart>() }); }
	~RegisteredPart() { ReportPartRegistry::remove(PART_ID); }
};

} // namespace

TEST_CASE("[ReportPart] a registered part is planned, measured and written under its id") {
	const TemporaryFolder folder;
	RecordStore store(folder.path);
	const RegisteredPart registered;
	const ReportPlan plan =
			make_report_plan(make_scripted_options(), {}, make_scripted_techniques());
	REQUIRE(plan.report.configurations.size() == 1);
	CHECK(plan.report.configurations[0].has_reference());
	ScriptedMaskSource masks;
	const Report report = run_report(plan, masks, store, {});
	REQUIRE(report.cells.size() == 2); // "hard" and "soft", each with its default setting
	for (const ReportCell &cell : report.cells) {
		CHECK(cell.is_ok());
		// Half of the reference, whose mean is 3.5 / 8 (see ScriptedMaskSource).
		CHECK(cell.error->all.receiver.mae == doctest::Approx(0.5 * 3.5 / 8));
		CHECK_FALSE(cell.image.empty());
	}
	CHECK(masks.reference_count == 1);
	CHECK(masks.measure_count == 0);		 // cells of a part are not timed
	CHECK(to_json(report).at(PART_ID) == 2); // what FakePart::to_json returns: the cell count
}

TEST_CASE("[ReportPart] without the part a report has neither its configurations nor its key") {
	const ReportPlan plan =
			make_report_plan(make_scripted_options(), {}, make_scripted_techniques());
	CHECK(plan.report.configurations.empty());
	CHECK_FALSE(to_json(plan.report).contains(PART_ID));
	CHECK(ReportPartRegistry::find_part(PART_ID) == nullptr);
}
