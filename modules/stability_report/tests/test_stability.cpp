#include "modules/core/files.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/error_report/report_json.h"
#include "modules/error_report/run_report.h"
#include "modules/error_report/tests/scripted_masks.h"
#include "modules/stability_report/stability_curves.h"
#include "modules/stability_report/stability_part.h"
#include "modules/stability_report/stability_result.h"
#include "modules/stability_report/stability_sweeps.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

using namespace gnomon;

namespace {

bool contains(const std::vector<double> &p_values, double p_value) {
	return std::find(p_values.begin(), p_values.end(), p_value) != p_values.end();
}

ReportOptions make_options(const std::vector<std::string> &p_sweeps) {
	ReportOptions options = make_scripted_options();
	options.part_options = { { STABILITY_OPTION, { "quick" } }, { SWEEPS_OPTION, p_sweeps } };
	return options;
}

Report run(const ReportOptions &p_options, ScriptedMaskSource &r_masks) {
	const TemporaryFolder folder;
	RecordStore store(folder.path);
	return run_report(
			make_report_plan(p_options, {}, make_scripted_techniques()), r_masks, store, {});
}

/// Returns a report with the first points of the sweep light_size for one technique. p_errors:
/// their penumbra MAE.
Report make_light_size_report(const std::vector<double> &p_errors) {
	Report report;
	report.techniques.push_back({ "soft", "Soft", "Test", "#ff0000", false });
	const StabilitySweep &sweep = *find_stability_sweep("light_size");
	for (size_t index = 0; index < p_errors.size(); ++index) {
		ReportConfiguration configuration;
		configuration.group = STABILITY_GROUP;
		configuration.sweep = sweep.id;
		configuration.light_type = "spot";
		configuration.value = sweep.values.at(index);
		report.configurations.push_back(configuration);
		ReportCell cell;
		cell.configuration_index = index;
		cell.technique = "soft";
		cell.status = ReportStatus::OK;
		cell.error = ReportError();
		cell.error->all.receiver.pixel_count = 1000;
		cell.error->all.penumbra = { .pixel_count = 500, .mae = p_errors[index] };
		cell.part_result = std::make_shared<StabilityResult>();
		report.cells.push_back(cell);
	}
	return report;
}

} // namespace

TEST_CASE("[Stability] sweeps contain their centre and quick values, whose scenes can be built") {
	std::set<std::string> ids;
	for (const StabilitySweep &sweep : get_stability_sweeps()) {
		CAPTURE(sweep.id);
		CHECK(ids.insert(sweep.id).second);
		CHECK(find_stability_sweep(sweep.id) == &sweep);
		if (sweep.has_project_scenes) {
			CHECK(sweep.values.empty());
			continue;
		}
		CHECK(contains(sweep.values, sweep.center));
		CHECK(contains(sweep.quick_values, sweep.center));
		CHECK_FALSE(sweep.quantity.empty());
		for (const double value : sweep.quick_values) {
			CHECK(contains(sweep.values, value));
			for (const LightType type : sweep.types) {
				const StabilitySetup point =
						make_stability_setup(sweep, type, value, ReportExtent::QUICK);
				const auto snapshot =
						build_snapshot(*point.scene, *point.scene->find_nodes<Camera3D>().front());
				REQUIRE(snapshot->find_light(point.light) != nullptr);
				CHECK(snapshot->find_light(point.light)->type == type);
				CHECK(point.size_px.x > 0);
			}
		}
	}
	CHECK(find_stability_sweep("no such sweep") == nullptr);
}

TEST_CASE("[Stability] the sweep scale multiplies lengths, and offset moves everything in the "
		  "scene") {
	const auto snap = [](const char *p_sweep, double p_value) {
		const StabilitySetup point = make_stability_setup(
				*find_stability_sweep(p_sweep), LightType::SPOT, p_value, ReportExtent::QUICK);
		return build_snapshot(*point.scene, *point.scene->find_nodes<Camera3D>().front());
	};
	const auto start = snap("scale", 1);
	const auto large = snap("scale", 1e3);
	CHECK(large->scene_size_m == doctest::Approx(1e3 * start->scene_size_m));
	CHECK(large->lights[0].light_size_m == doctest::Approx(1e3 * start->lights[0].light_size_m));
	CHECK(large->camera.near_m == doctest::Approx(1e3 * start->camera.near_m));
	CHECK(glm::distance(large->lights[0].position_world, 1e3 * start->lights[0].position_world) <
			1e-6);
	const auto moved = snap("offset", 1e6);
	const glm::dvec3 offset = moved->camera.position_world - start->camera.position_world;
	CHECK(glm::length(offset) == doctest::Approx(1e6));
	CHECK(glm::distance(moved->lights[0].position_world - offset, start->lights[0].position_world) <
			1e-8);
	for (size_t index = 0; index < start->instances.size(); ++index) {
		CHECK(glm::distance(glm::dvec3(moved->instances[index].world_from_node[3]) - offset,
					  glm::dvec3(start->instances[index].world_from_node[3])) < 1e-8);
	}
}

TEST_CASE("[Stability] move_light moves the light by a thousandth of its radius") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		const StabilitySetup point =
				make_stability_setup(get_stability_sweeps()[0], type, 0.05, ReportExtent::QUICK);
		const MaskTask task = { build_snapshot(
										*point.scene, *point.scene->find_nodes<Camera3D>().front()),
			point.light, point.size_px };
		const MaskTask moved = move_light(task);
		const LightSnapshot &before = task.scene->lights[0];
		const LightSnapshot &after = moved.scene->lights[0];
		if (type == LightType::DIRECTIONAL) {
			// Near 1, acos loses digits, so the tolerance is 1 %.
			const double angle = std::acos(std::min(
					1.0, glm::dot(before.get_direction_world(), after.get_direction_world())));
			CHECK(angle ==
					doctest::Approx(1e-3 * std::atan(before.get_disc_radius())).epsilon(0.01));
		} else {
			CHECK(glm::distance(before.position_world, after.position_world) ==
					doctest::Approx(1e-3 * before.light_size_m));
		}
		CHECK(moved.scene->camera.position_world == task.scene->camera.position_world);
	}
}

TEST_CASE("[Stability] a curve breaks where its error exceeds twice that of the centre") {
	// Values 1e-6 .. 1, the centre 0.05 is the seventh of 13.
	std::vector<double> errors(13, 0.01);
	errors[2] = 0.03;
	errors[10] = 0.021;
	errors[12] = 0.03;
	const Report report = make_light_size_report(errors);
	const std::vector<StabilityPlot> plots = find_stability_plots(report);
	REQUIRE(plots.size() == 1);
	REQUIRE(plots[0].curves.size() == 1);
	const StabilityCurve &curve = plots[0].curves[0];
	CHECK(curve.break_before == 1e-4);
	CHECK(curve.break_after == 0.5);
	CHECK(curve.points[6].state == StabilityState::OK);
	CHECK(curve.points[10].state == StabilityState::DOUBLED);
	CHECK(curve.points[11].state == StabilityState::OK);
	const nlohmann::ordered_json json = StabilityPart().to_json(report);
	CHECK(json[0]["series"][0]["break_after"] == "0.5");
	CHECK(json[0]["series"][0]["points"][10]["state"] == "doubled");
	// An error that an 8-bit image does not show is no break.
	CHECK_FALSE(find_stability_plots(make_light_size_report({ 0, 0, 0, 0, 0, 0, 1e-5, 1e-3 }))[0]
						.curves[0]
						.break_after);
}

TEST_CASE("[Stability] nonsense, refusals and failures are distinguished") {
	Report report = make_light_size_report({ 0.01, 0.01 });
	ReportCell &cell = report.cells[0];
	StabilityResult result;
	// Not owned, so that the cell sees each change of the result.
	cell.part_result = std::shared_ptr<const PartResult>(std::shared_ptr<void>(), &result);
	const auto judge = [&] { return classify_stability(cell, {}, &report.cells[1]); };
	CHECK(judge() == StabilityState::OK);
	result.wrong_share = 0.05;
	CHECK(judge() == StabilityState::NONSENSE);
	result.refusal = "too large";
	CHECK(judge() == StabilityState::REFUSED);
	cell.status = ReportStatus::FAILED;
	CHECK(judge() == StabilityState::FAILED);
	cell.status = ReportStatus::MISSING;
	CHECK(judge() == StabilityState::MISSING);
}

TEST_CASE("[Stability] a run measures every point and stores its results") {
	ScriptedMaskSource masks;
	masks.warnings = { "that is wide" };
	const Report report = run(make_options({ "light_size", "guards" }), masks);
	CHECK(report.count(ReportStatus::OK) > 40);
	CHECK(report.count(ReportStatus::FAILED) == 0);
	CHECK(report.count(ReportStatus::MISSING) == 0);
	for (const ReportCell &cell : report.cells) {
		const StabilityResult *result = cell.find_result<StabilityResult>();
		REQUIRE(result != nullptr);
		CHECK(cell.error);
		CHECK(result->warnings == masks.warnings);
		CHECK(result->temporal_rmse == 0.0); // scripted: nothing moves
	}
	// The saved report can be loaded again.
	const TemporaryFolder folder;
	const auto path = folder.path / "report.json";
	save_file_atomically(path, dump_json(to_json(report)));
	const Report read = load_report(path);
	CHECK(to_json(read) == to_json(report));
}

TEST_CASE("[Stability] a result is read as it was written, also that of version 1") {
	const StabilityPart part;
	StabilityResult result;
	result.temporal_rmse = 0.5;
	result.wrong_share = 0.25;
	result.warnings = { "that is wide" };
	result.condition = { 4.0, 0.5, 0.25, 0.125, ErrorCause::REFERENCE };
	nlohmann::ordered_json json = result.to_json();
	CHECK(part.read_result(json)->to_json() == json);
	const nlohmann::ordered_json current = json;
	nlohmann::ordered_json &condition = json["condition"];
	condition["truth_error"] = condition["reference_error"];
	condition.erase("reference_error");
	condition["cause"] = "truth";
	CHECK(part.read_result(json)->to_json() == current);
	condition["cause"] = "weather";
	CHECK_THROWS_WITH_AS(part.read_result(json), doctest::Contains("weather"), Error);
}

TEST_CASE("[Stability] NaN, visibility outside 0..1 and validation messages are failures") {
	for (const float value : { std::numeric_limits<float>::quiet_NaN(), -0.01f, 1.01f }) {
		ScriptedMaskSource masks;
		masks.invalid_value = value;
		const Report report = run(make_options({ "scale" }), masks);
		for (const ReportCell &cell : report.cells) {
			CHECK(cell.status == ReportStatus::FAILED);
			CHECK(cell.message.find("not finite or outside 0..1") != std::string::npos);
		}
	}
	ScriptedMaskSource noisy;
	noisy.validation_message_count = 3;
	const Report report = run(make_options({ "scale" }), noisy);
	CHECK(report.cells.front().status == ReportStatus::FAILED);
	CHECK(report.cells.front().message == "3 validation messages.");
}

TEST_CASE("[Stability] an Error of the technique is a refusal with its message, not a failure") {
	ScriptedMaskSource masks;
	masks.failing_technique = "soft";
	const Report report = run(make_options({ "scale" }), masks);
	CHECK(report.count(ReportStatus::FAILED) == 0);
	for (const ReportCell &cell : report.cells) {
		CHECK(cell.find_result<StabilityResult>()->refusal ==
				(cell.technique == "soft" ? "the device is sad" : ""));
		CHECK(cell.error.has_value() == (cell.technique != "soft"));
	}
	// The second curve is that of "soft".
	CHECK(find_stability_plots(report)[0].curves[1].points[0].state == StabilityState::REFUSED);
}

TEST_CASE("[Stability] a lost device ends the run, and a resumed run measures the rest") {
	const TemporaryFolder folder;
	RecordStore store(folder.path);
	const ReportPlan plan =
			make_report_plan(make_options({ "scale" }), {}, make_scripted_techniques());
	ScriptedMaskSource masks;
	masks.lose_device_after_draw_count = 2;
	CHECK_THROWS_AS(run_report(plan, masks, store, {}), DeviceLost);
	ScriptedMaskSource rest;
	const Report report = run_report(plan, rest, store, { .resumes = true });
	CHECK(report.count(ReportStatus::OK) > 5);
	CHECK(report.count(ReportStatus::MISSING) == 0);
	CHECK(rest.draw_count == plan.report.cells.size() - 2);
	for (const ReportCell &cell : report.cells) {
		CHECK(cell.find_result<StabilityResult>()->refusal.empty());
	}
}

TEST_CASE("[Stability] each curve is measured by a single shard") {
	const ReportPlan plan = make_report_plan(
			make_options({ "light_size", "scale", "offset" }), {}, make_scripted_techniques());
	std::map<std::pair<std::string, std::string>, std::set<size_t>> shards;
	for (uint32_t shard = 0; shard < 3; ++shard) {
		const TemporaryFolder folder;
		RecordStore store(folder.path);
		ScriptedMaskSource masks;
		const Report report = run_report(
				plan, masks, store, { .resumes = false, .shard_index = shard, .shard_count = 3 });
		for (const ReportCell &cell : report.cells) {
			const ReportConfiguration &at = report.configurations[cell.configuration_index];
			if (cell.is_ok()) {
				shards[{ at.sweep, at.light_type }].insert(shard);
			}
		}
	}
	CHECK(shards.size() == 5); // light_size with three types of light, the others with one
	for (const auto &[curve, own] : shards) {
		CHECK(own.size() == 1);
	}
}

TEST_CASE("[Stability] the sweep scenes has a point per light of the project's scenes") {
	ReportOptions options = make_options({ PROJECT_SCENES_SWEEP });
	// Of each scene: triangles, lights, light size in metres. {}: loading did not fail.
	options.part_scenes[STABILITY_GROUP] = { { "yard", make_scaling_scene({ 1000, 2, 0.4 }), {} },
		{ "gone", nullptr, "the file is not there" },
		{ "hall", make_scaling_scene({ 1100, 1, 0.3 }), {} } };
	ScriptedMaskSource masks;
	const Report report = run(options, masks);
	REQUIRE(report.configurations.size() == 4);
	CHECK(report.configurations[0].id == "stability/scenes/spot/yard/Light 1");
	CHECK(report.configurations[1].light == "Light 2");
	CHECK(report.configurations[1].light_size_m == doctest::Approx(0.4));
	CHECK(report.configurations[2].message == "the file is not there");
	CHECK(report.configurations[2].status == ReportStatus::FAILED);
	CHECK(report.configurations[3].light_size_m == doctest::Approx(0.3));
	// Of 3 lights: cells (two techniques) and references.
	CHECK(report.count(ReportStatus::OK) == 6 + 3);

	// Without a centre no error counts as doubled.
	const std::vector<StabilityPlot> plots = find_stability_plots(report);
	REQUIRE(plots.size() == 1);
	REQUIRE(plots[0].curves.size() == 2);
	std::vector<std::string> labels;
	for (const StabilityPoint &point : plots[0].curves[0].points) {
		CHECK(point.state == StabilityState::OK);
		labels.push_back(point.label);
	}
	CHECK(labels == std::vector<std::string>{ "yard/Light 1", "yard/Light 2", "hall/Light 1" });
	const nlohmann::ordered_json json = StabilityPart().to_json(report);
	CHECK(json[0]["has_cases"] == true);
	CHECK(json[0]["series"][1]["points"][2]["label"] == "hall/Light 1");
}

TEST_CASE("[Stability] scenes of the project are planned only if the sweep scenes is requested") {
	ReportOptions options = make_options({ "scale" });
	options.part_scenes[STABILITY_GROUP] = { { "yard", make_scaling_scene({ 1000, 2, 0.4 }),
			/*failure=*/{} } };
	for (const ReportConfiguration &configuration :
			make_report_plan(options, {}, make_scripted_techniques()).report.configurations) {
		CHECK(configuration.sweep == "scale");
	}
	options.part_options = { { STABILITY_OPTION, { "none" } } };
	CHECK(make_report_plan(options, {}, make_scripted_techniques()).report.configurations.empty());
}
