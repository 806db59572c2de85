#include "modules/error_report/tests/scripted_masks.h"

#include <doctest/doctest.h>

#include <set>

using namespace gnomon;

namespace {

size_t count_cells(const ReportPlan &p_plan, const std::string &p_setting) {
	size_t count = 0;
	for (const ReportCell &cell : p_plan.report.cells) {
		count += cell.setting == p_setting ? 1 : 0;
	}
	return count;
}

} // namespace

TEST_CASE("[ErrorReport] by default light radii are 0.02, 0.1 and 0.3 of the scene's size") {
	const ReportPlan plan = make_scripted_plan(1);
	REQUIRE(plan.report.configurations.size() == 3);
	CHECK(plan.report.configurations[0].light_size_m == doctest::Approx(0.08));
	CHECK(plan.report.configurations[1].id == "scene_0/Light 1/0.4");
	CHECK(plan.report.configurations[2].light_size_m == doctest::Approx(1.2));
	const MaskTask task = plan.tasks[2]({});
	CHECK(get_light(*task.scene, "Light 1").light_size_m == doctest::Approx(1.2));
	CHECK(task.size_px == glm::uvec2(16u));
}

TEST_CASE("[ErrorReport] an expensive setting is measured only at the middle light size") {
	const ReportPlan plan = make_scripted_plan(2);
	CHECK(count_cells(plan, "default") == 6);
	CHECK(count_cells(plan, "few") == 6);
	CHECK(count_cells(plan, "many") == 2);
	for (const ReportCell &cell : plan.report.cells) {
		if (cell.setting == "many") {
			CHECK(plan.report.configurations[cell.configuration_index].light_size_m ==
					doctest::Approx(0.4));
		}
	}
}

TEST_CASE("[ErrorReport] requested light sizes and types replace those of the scene") {
	ReportOptions options = make_scripted_options();
	options.sizes_m = { 0.5 };
	options.light_types = { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL };
	const ReportPlan plan =
			make_report_plan(options, make_scripted_scenes(1), make_scripted_techniques());
	REQUIRE(plan.report.configurations.size() == 3);
	CHECK(plan.report.configurations[0].light_type == "spot");
	CHECK(plan.report.configurations[1].light_type == "omni");
	CHECK(plan.report.configurations[1].id == "scene_0/Light 1 as omni/0.5");
	CHECK(plan.report.configurations[2].light_type == "directional");
	CHECK(plan.report.configurations[2].light_angular_distance_deg > 0);
	CHECK(plan.report.configurations[2].light_size_m == 0);
}

TEST_CASE("[ErrorReport] a setting sets light properties, and r and t are derived from R") {
	const ReportPlan plan = make_scripted_plan(1);
	for (size_t index = 0; index < plan.report.cells.size(); ++index) {
		const ReportCell &cell = plan.report.cells[index];
		const MaskTask task = plan.tasks[cell.configuration_index](plan.settings[index]);
		const LightSnapshot &light = task.scene->lights.front();
		CHECK(light.penumbra_outer_width_m == light.light_size_m);
		CHECK(light.penumbra_inner_width_m == light.light_size_m);
		CHECK((light.properties.count("soft_taps") == 1) == (cell.technique == "soft"));
		CHECK(cell.properties.count("soft_taps") == light.properties.count("soft_taps"));
	}
}

TEST_CASE("[ErrorReport] a record's name depends on program, samples, size, camera and scene") {
	const auto collect = [](const ReportPlan &p_plan) {
		std::set<std::string> names;
		for (const ReportCell &cell : p_plan.report.cells) {
			names.insert(cell.record);
		}
		for (const ReportConfiguration &configuration : p_plan.report.configurations) {
			names.insert(configuration.record);
		}
		return names;
	};
	const std::set<std::string> names = collect(make_scripted_plan(1));
	CHECK(names.size() == 3 + 7);
	CHECK(collect(make_scripted_plan(1)) == names);
	const auto check_all_new = [&](const ReportOptions &p_options,
									   const std::vector<ReportScene> &p_scenes) {
		for (const std::string &name :
				collect(make_report_plan(p_options, p_scenes, make_scripted_techniques()))) {
			CHECK(names.count(name) == 0);
		}
	};
	ReportOptions options = make_scripted_options();
	options.program = "test 2";
	check_all_new(options, make_scripted_scenes(1));
	options = make_scripted_options();
	options.sample_count = 65;
	check_all_new(options, make_scripted_scenes(1));
	options = make_scripted_options();
	options.size_px.x = 17;
	check_all_new(options, make_scripted_scenes(1));
	std::vector<ReportScene> scenes = make_scripted_scenes(1);
	scenes[0].scene = make_scaling_scene({ .triangle_count = 1100 });
	check_all_new(make_scripted_options(), scenes);
	scenes = make_scripted_scenes(1);
	scenes[0].scene->find_nodes<Camera3D>()[0]->near_m *= 2;
	check_all_new(make_scripted_options(), scenes);
	scenes = make_scripted_scenes(1);
	scenes[0].scene->find_nodes<Light3D>()[0]->properties["other_technique_taps"] = int64_t(3);
	check_all_new(make_scripted_options(), scenes);
}

TEST_CASE("[ErrorReport] a scene that cannot be measured fails without affecting others") {
	std::vector<ReportScene> scenes = make_scripted_scenes(2);
	scenes[0].scene = nullptr;
	scenes[0].failure = "it is gone";
	auto dark = make_scaling_scene({ .triangle_count = 1000 });
	dark->find_nodes<Light3D>()[0]->properties["shadow_enabled"] = false;
	scenes.push_back({ "dark", std::move(dark), /*failure=*/{} });
	const ReportPlan plan =
			make_report_plan(make_scripted_options(), scenes, make_scripted_techniques());
	REQUIRE(plan.report.configurations.size() == 5); // 1 failed, 3 sizes of scene_1, 1 failed
	CHECK(plan.report.configurations[0].status == ReportStatus::FAILED);
	CHECK(plan.report.configurations[0].message == "it is gone");
	CHECK(plan.report.find_cells(0).empty());
	CHECK(plan.report.configurations[4].message.find("no light") != std::string::npos);
	CHECK(plan.report.count(ReportStatus::FAILED) == 2);
	CHECK(plan.report.count(ReportStatus::MISSING) == 3 + 7 + 2);
}

TEST_CASE("[ErrorReport] scaling curves vary one quantity and share the record of common points") {
	ReportOptions options = make_scripted_options();
	options.scaling = ReportExtent::QUICK;
	std::vector<MeasurableTechnique> techniques = make_scripted_techniques();
	techniques[1].info.id = "other";
	techniques[1].get_settings = techniques[0].get_settings;
	techniques.push_back(make_scripted_techniques()[1]); // with an expensive setting: skipped
	const ReportPlan plan = make_report_plan(options, {}, techniques);
	std::set<std::string> groups;
	std::set<std::string> records;
	for (const ReportCell &cell : plan.report.cells) {
		const ReportConfiguration &at = plan.report.configurations[cell.configuration_index];
		groups.insert(at.group);
		records.insert(cell.record);
		CHECK(!at.has_reference());
		CHECK(cell.setting == "default");
		CHECK(cell.technique != "soft");
	}
	CHECK(groups == std::set<std::string>{ "triangles", "light_size", "lights", "resolution" });
	// 2 techniques, 4 curves of 3 points. Images have 16 px here, so that only the other three
	// curves have a point in common.
	CHECK(plan.report.cells.size() == 2 * 12);
	CHECK(records.size() == 2 * 10);
	for (size_t index = 0; index < plan.report.configurations.size(); ++index) {
		const ReportConfiguration &at = plan.report.configurations[index];
		const MaskTask task = plan.tasks[index]({});
		CHECK(task.scene->lights.size() == at.light_count);
		CHECK(task.size_px == at.size_px);
		CHECK(task.light.empty() == (at.light_count > 1));
		if (at.group == TRIANGLES_GROUP) {
			CHECK(double(at.triangle_count) == doctest::Approx(at.value).epsilon(0.02));
		}
	}
}

TEST_CASE("[ErrorReport] an invalid light size fails without affecting other configurations") {
	ReportOptions options = make_scripted_options();
	options.sizes_m = { 0.1, 1000 }; // a directional light of 180 degrees
	options.light_types = { LightType::DIRECTIONAL, LightType::SPOT };
	const ReportPlan plan =
			make_report_plan(options, make_scripted_scenes(1), make_scripted_techniques());
	REQUIRE(plan.report.configurations.size() == 4);
	CHECK(plan.report.configurations[1].id == "scene_0/Light 1 as directional/1000");
	CHECK(plan.report.configurations[1].message.find("light_angular_distance") !=
			std::string::npos);
	CHECK(plan.report.count(ReportStatus::FAILED) == 1);
	CHECK(plan.report.find_cells(3).size() == 3);
}
