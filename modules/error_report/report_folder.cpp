#include "modules/error_report/report_folder.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/error_report/report_json.h"

#include <nlohmann/json.hpp>

#include <optional>

namespace gnomon {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// Calls p_read with the content of a record, unless it is absent or its name is empty. If p_read
/// throws an Error, it is logged and the record is treated as absent.
template <typename Read>
void read_record(const RecordStore &p_store, const std::string &p_name, Read p_read) {
	if (p_name.empty()) {
		return;
	}
	if (const std::optional<Json> content = p_store.load(p_name)) {
		try {
			p_read(*content);
		} catch (const Error &error) {
			log_warning(error.what(), " Record \"", p_name, "\" counts as absent.");
		}
	}
}

bool is_same_folder(const fs::path &p_first, const fs::path &p_second) {
	std::error_code code;
	return fs::equivalent(p_first, p_second, code) && !code;
}

/// Returns the first store in which the record did not fail, else the first that has the record;
/// null if none has it.
const RecordStore *choose_store(
		const std::vector<RecordStore> &p_stores, const std::string &p_name) {
	const RecordStore *failed = nullptr;
	for (const RecordStore &store : p_stores) {
		const std::optional<Json> content = store.load(p_name);
		if (content && content->value("status", "") == get_name(ReportStatus::OK)) {
			return &store;
		}
		failed = content && !failed ? &store : failed;
	}
	return failed;
}

} // namespace

fs::path get_plan_path(const fs::path &p_folder) {
	return p_folder / "plan.json";
}

fs::path get_record_folder(const fs::path &p_folder) {
	return p_folder / "cells";
}

std::vector<std::string> list_records(const Report &p_plan) {
	std::vector<std::string> names;
	for (const ReportConfiguration &configuration : p_plan.configurations) {
		if (!configuration.record.empty()) {
			names.push_back(configuration.record);
		}
	}
	for (const ReportSceneImage &image : p_plan.scene_images) {
		names.push_back(image.record);
	}
	for (const ReportCell &cell : p_plan.cells) {
		names.push_back(cell.record);
	}
	return names;
}

void save_plan(const fs::path &p_folder, const Report &p_plan) {
	save_file_atomically(get_plan_path(p_folder), dump_json(to_json(p_plan)));
}

void check_resumable(const fs::path &p_folder, const Report &p_plan) {
	std::error_code code;
	if (!fs::exists(get_plan_path(p_folder), code)) {
		return;
	}
	const Report earlier = load_report(get_plan_path(p_folder));
	if (dump_json(to_json(earlier)) != dump_json(to_json(p_plan))) {
		fail("Report ", p_folder, " was planned by another program or with other options (",
				earlier.cells.size(), " cells, program ", earlier.program, "; now ",
				p_plan.cells.size(), ", ", p_plan.program,
				"). Resume it with the same ones, choose another --out, or omit --resume to ",
				"replace it.");
	}
}

Report collect_report(
		const Report &p_plan, const RecordStore &p_store, const ReportMachine *p_machine) {
	Report report = p_plan;
	for (ReportConfiguration &configuration : report.configurations) {
		read_record(p_store, configuration.record,
				[&](const Json &p_content) { read_reference_result(p_content, configuration); });
	}
	for (ReportSceneImage &image : report.scene_images) {
		read_record(p_store, image.record,
				[&](const Json &p_content) { read_scene_image_result(p_content, image); });
	}
	for (ReportCell &cell : report.cells) {
		read_record(p_store, cell.record, [&](const Json &p_content) {
			if (!p_machine || read_cell_machine(p_content) == *p_machine) {
				read_cell_result(p_content, report, cell);
			}
		});
	}
	return report;
}

Report merge_reports(const std::vector<fs::path> &p_folders, const fs::path &p_out) {
	GNOMON_ASSERT(!p_folders.empty(), "nothing to merge");
	const Report plan = load_report(get_plan_path(p_folders.front()));
	std::vector<RecordStore> stores;
	bool is_output_an_input = false; // p_out is also one of p_folders
	for (const fs::path &folder : p_folders) {
		if (dump_json(to_json(load_report(get_plan_path(folder)))) != dump_json(to_json(plan))) {
			fail("Reports ", p_folders.front(), " and ", folder,
					" were not planned alike. Run all shards with the same program, project and ",
					"options.");
		}
		stores.emplace_back(get_record_folder(folder));
		is_output_an_input = is_output_an_input || is_same_folder(folder, p_out);
	}
	RecordStore merged(get_record_folder(p_out));
	for (const std::string &name : list_records(plan)) {
		const RecordStore *store = choose_store(stores, name);
		if (store && !is_same_folder(store->get_folder(), merged.get_folder())) {
			merged.copy_from(*store, name);
		} else if (!store && !is_output_an_input) {
			merged.remove(name); // left from an earlier merge
		}
	}
	save_plan(p_out, plan);
	return collect_report(plan, merged);
}

} // namespace gnomon
