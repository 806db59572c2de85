#pragma once

#include "modules/error_report/report_part.h"

namespace gnomon {

/// The report's part that takes techniques into stiff and extreme cases (doc/stability.md).
class StabilityPart : public ReportPart {
public:
	std::vector<std::string> list_sweeps() const override;
	void plan(const ReportOptions &p_options, const Add &p_add) const override;
	std::vector<TracedTruth> trace_truths(MaskSource &r_source, const MaskQuestion &p_question,
			uint32_t p_sample_count) const override;
	MaskImage run_cell(MaskSource &r_source, const MaskQuestion &p_question,
			std::span<const TracedTruth> p_truths, Report &r_report, size_t p_cell) const override;
	bool is_unusable(const ReportCell &p_cell) const override;
	nlohmann::ordered_json to_json(const Report &p_report) const override;
};

} // namespace gnomon
