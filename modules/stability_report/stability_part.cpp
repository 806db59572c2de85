#include "modules/stability_report/stability_part.h"

#include "modules/stability_report/stability_curves.h"
#include "modules/stability_report/stability_plan.h"
#include "modules/stability_report/stability_run.h"
#include "modules/stability_report/stability_sweeps.h"

#include <nlohmann/json.hpp>

namespace gnomon {

std::vector<std::string> StabilityPart::list_sweeps() const {
	std::vector<std::string> ids;
	for (const StabilitySweep &sweep : get_stability_sweeps()) {
		ids.push_back(sweep.id);
	}
	return ids;
}

void StabilityPart::plan(const ReportOptions &p_options, const Add &p_add) const {
	plan_stability(p_options, p_add);
}

std::vector<TracedTruth> StabilityPart::trace_truths(
		MaskSource &r_source, const MaskQuestion &p_question, uint32_t p_sample_count) const {
	return trace_stability_truths(r_source, p_question, p_sample_count);
}

MaskImage StabilityPart::run_cell(MaskSource &r_source, const MaskQuestion &p_question,
		std::span<const TracedTruth> p_truths, Report &r_report, size_t p_cell) const {
	ReportCell &cell = r_report.cells[p_cell];
	const std::optional<size_t> center = find_stability_center(r_report, cell);
	return run_stability_cell(r_source, p_question, p_truths,
			r_report.configurations[cell.configuration_index].truth,
			center ? &r_report.cells[*center] : nullptr, cell);
}

bool StabilityPart::is_unusable(const ReportCell &p_cell) const {
	const StabilityState state = judge_stability(p_cell, {}, nullptr);
	return state == StabilityState::REFUSED || state == StabilityState::NONSENSE;
}

nlohmann::ordered_json StabilityPart::to_json(const Report &p_report) const {
	return gnomon::to_json(find_stability_plots(p_report));
}

} // namespace gnomon
