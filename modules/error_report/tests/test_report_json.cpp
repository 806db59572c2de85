#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/error_report/report_folder.h"
#include "modules/error_report/report_json.h"
#include "modules/error_report/report_page.h"
#include "modules/error_report/run_report.h"
#include "modules/error_report/tests/scripted_masks.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace gnomon;
using Json = nlohmann::ordered_json;

namespace {

/// Measures a scripted plan with one scene: 3 configurations and 7 cells (see make_scripted_plan).
Report make_scripted_report(const std::filesystem::path &p_folder) {
	const ReportPlan plan = make_scripted_plan(1);
	ScriptedMaskSource masks;
	RecordStore store(get_record_folder(p_folder));
	return run_report(plan, masks, store, {});
}

} // namespace

TEST_CASE("[ErrorReport] a loaded report.json equals the saved report") {
	TemporaryFolder folder;
	const Report report = make_scripted_report(folder.path);
	const Json json = to_json(report);
	save_file_atomically(folder.path / "report.json", json.dump());
	CHECK(to_json(load_report(folder.path / "report.json")) == json);
	CHECK(json.at("failed_count") == 0);
	CHECK(json.at("cells").size() == 7);
	CHECK(json.at("ranking").size() == 3); // "hard", "soft" with "few" and with "many"
	CHECK(json.at("ranking")[0].at("technique") == "soft");
	CHECK(json.at("configurations")[0].at("pareto").size() == 1);
}

TEST_CASE("[ErrorReport] an older report without `wrong` is loaded with unset values") {
	TemporaryFolder folder;
	const Json json = to_json(make_scripted_report(folder.path));
	CHECK(json.at("cells")[0].at("error").at("all").at("receiver").contains("wrong"));
	CHECK(json.at("ranking")[0].contains("penumbra_wrong"));
	Json older = json;
	for (Json &cell : older["cells"]) {
		for (Json &population : cell["error"]) {
			population["receiver"].erase("wrong");
			population["penumbra"].erase("wrong");
		}
	}
	for (const char *list : { "ranking", "best_settings" }) {
		for (Json &row : older[list]) {
			row.erase("penumbra_wrong");
			row.erase("receiver_wrong");
		}
	}
	save_file_atomically(folder.path / "report.json", older.dump());
	const Report report = load_report(folder.path / "report.json");
	CHECK_FALSE(report.cells[0].error->all.receiver.wrong);
	CHECK(to_json(report) == older);
}

TEST_CASE("[ErrorReport] a report of version 1 is loaded with its old key names") {
	TemporaryFolder folder;
	const std::filesystem::path path = folder.path / "report.json";
	std::string written = to_json(make_scripted_report(folder.path)).dump();
	const auto replace = [&](const std::string &p_new, const std::string &p_old) {
		REQUIRE(written.find(p_new) != std::string::npos);
		for (size_t at = 0; (at = written.find(p_new, at)) != std::string::npos;) {
			written.replace(at, p_new.size(), p_old);
		}
	};
	save_file_atomically(path, written);
	const Json current = to_json(load_report(path));
	CHECK(current.at("version") == 2);
	replace("\"version\":2", "\"version\":1");
	replace("\"reference_mask\":", "\"truth\":");
	save_file_atomically(path, written);
	const bool is_same = to_json(load_report(path)) == current; // CHECK would print both
	CHECK(is_same);
	replace("\"version\":1", "\"version\":3");
	save_file_atomically(path, written);
	CHECK_THROWS_WITH_AS(load_report(path), doctest::Contains("version 1..2"), Error);
}

TEST_CASE("[ErrorReport] an invalid report file is an Error that names the file") {
	TemporaryFolder folder;
	const std::filesystem::path path = folder.path / "report.json";
	const Json whole = to_json(make_scripted_report(folder.path));
	const auto check_refused = [&](const std::string &p_text) {
		save_file_atomically(path, p_text);
		CHECK_THROWS_WITH_AS(load_report(path), doctest::Contains("report.json"), Error);
	};
	check_refused("");
	check_refused("{}");
	check_refused("[1]");
	check_refused(whole.dump().substr(0, 1000));
	for (const char *key : { "format", "version", "machines", "configurations", "cells" }) {
		Json part = whole;
		part.erase(key);
		check_refused(part.dump());
	}
	Json wrong = whole;
	wrong["cells"][0]["configuration"] = 99;
	check_refused(wrong.dump());
	wrong = whole;
	wrong["cells"][0]["machine"] = 1; // the only machine is 0
	check_refused(wrong.dump());
	wrong = whole;
	wrong["cells"][0]["time"]["cost_ms"] = "fast";
	check_refused(wrong.dump());
	CHECK_THROWS_AS(load_report(folder.path / "absent.json"), Error);
}

TEST_CASE("[ErrorReport] the page contains library, data and images, and escapes names") {
	TemporaryFolder folder;
	Report report = make_scripted_report(folder.path);
	report.project = "<b>&</script><script>alert(1)</script>";
	report.cells[0].setting = "</script>";
	const RecordStore store(get_record_folder(folder.path));
	const std::string page = build_report_page(to_json(report), store);
	for (const char *marker : { "{{TITLE}}", "{{STYLE}}", "{{LIBRARIES}}", "{{SCRIPT}}", "{{DATA}}",
				 "{{LICENSES}}" }) {
		CHECK(page.find(marker) == std::string::npos);
	}
	CHECK(page.find("<script>alert") == std::string::npos);
	CHECK(page.find("&lt;b&gt;&amp;&lt;/script&gt;") != std::string::npos);
	CHECK(page.find("Permission to use, copy, modify") != std::string::npos);
	const size_t begin = page.find('{', page.find("id=\"report-data\""));
	const Json data = Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
	CHECK(data.at("project") == report.project);
	CHECK(data.at("cells")[0].at("setting") == "</script>");
	CHECK(data.at("images").size() == 3 + 7 + 2); // of references, cells and scenes
	const std::string image = data.at("images").at(report.cells[0].image);
	CHECK(image.rfind("data:image/png;base64,iVBORw0KGgo", 0) == 0);
	CHECK(image.size() % 4 == 22 % 4); // groups of 4 base64 characters after a prefix of 22
	CHECK(data.at("heat_map").at("colors").size() % 2 == 1); // the middle colour is for 0
}

TEST_CASE("[ErrorReport] empty pixel sets have no metrics, and names may be invalid UTF-8") {
	TemporaryFolder folder;
	Report report = make_scripted_report(folder.path);
	report.cells[0].error->all.penumbra = {};
	report.configurations[0].scene = "caf\xe9";
	const Json json = to_json(report);
	CHECK(!json.at("cells")[0].at("error").at("all").contains("penumbra"));
	save_file_atomically(folder.path / "report.json", dump_json(json));
	const Report again = load_report(folder.path / "report.json");
	CHECK(again.cells[0].error->all.penumbra.pixel_count == 0);
	CHECK(again.configurations[0].scene == "caf\xef\xbf\xbd");
	CHECK(!build_report_page(json, RecordStore(get_record_folder(folder.path))).empty());
}
