#include "modules/error_report/report.h"

#include <cstdio>

namespace gnomon {

const char *get_name(ReportStatus p_status) {
	static const char *const NAMES[] = { "ok", "failed", "missing" };
	return NAMES[static_cast<int>(p_status)];
}

std::vector<size_t> Report::find_cells(size_t p_configuration) const {
	std::vector<size_t> found;
	for (size_t index = 0; index < cells.size(); ++index) {
		if (cells[index].configuration_index == p_configuration) {
			found.push_back(index);
		}
	}
	return found;
}

const ReportCell *Report::find_baseline(const ReportCell &p_cell) const {
	for (const ReportTechnique &technique : techniques) {
		if (!technique.is_baseline) {
			continue;
		}
		for (const ReportCell &cell : cells) {
			if (cell.configuration_index == p_cell.configuration_index &&
					cell.technique == technique.id) {
				return cell.is_ok() ? &cell : nullptr;
			}
		}
	}
	return nullptr;
}

std::optional<double> Report::compute_time_ratio(const ReportCell &p_cell) const {
	const ReportCell *baseline = find_baseline(p_cell);
	// Times of different machines are not comparable.
	if (!baseline || !p_cell.is_ok() || baseline->machine_index != p_cell.machine_index ||
			baseline->time.cost_ms <= 0) {
		return std::nullopt;
	}
	return p_cell.time.cost_ms / baseline->time.cost_ms;
}

size_t Report::count(ReportStatus p_status) const {
	size_t found = 0;
	for (const ReportConfiguration &configuration : configurations) {
		found += configuration.has_reference() && configuration.status == p_status ? 1 : 0;
	}
	for (const ReportSceneImage &image : scene_images) {
		found += image.status == p_status ? 1 : 0;
	}
	for (const ReportCell &cell : cells) {
		found += cell.status == p_status ? 1 : 0;
	}
	return found;
}

} // namespace gnomon
