#include "modules/animation_report/animation_part.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/error_report/run_report.h"
#include "modules/error_report/tests/scripted_masks.h"
#include "modules/scene/animation.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <set>

using namespace gnomon;

namespace {

/// The first scripted scene, with an animation that moves its first mesh along x from 0 to 1 m in
/// 2 s.
std::vector<ReportScene> make_animated_scenes() {
	std::vector<ReportScene> scenes = make_scripted_scenes(1);
	auto scene = std::const_pointer_cast<Scene>(scenes[0].scene);
	Node3D *node = scene->find_nodes<MeshInstance3D>().front();
	node->file_index = 7;
	auto animation = std::make_shared<Animation>();
	animation->name = "Move";
	animation->channels = { { 7, AnimatedPath::TRANSLATION,
			{ Interpolation::LINEAR, { 0, 2 }, 3, { 0, 0, 0, 1, 0, 0 } } } };
	animation->nodes = { AnimatedNode{ 7 } };
	animation->duration_s = 2;
	scene->animations = { animation };
	return scenes;
}

ReportPlan make_plan(ReportExtent p_extent, const std::vector<ReportScene> &p_scenes,
		const std::vector<MeasurableTechnique> &p_techniques) {
	ReportOptions options;
	options.scaling = ReportExtent::NONE;
	options.part_options[CHANGE_OPTION] = { EXTENT_NAMES[size_t(p_extent)] };
	options.size_px = glm::uvec2(8);
	return make_report_plan(options, p_scenes, p_techniques);
}

size_t count_points(const ReportPlan &p_plan) {
	size_t count = 0;
	for (const ReportConfiguration &configuration : p_plan.report.configurations) {
		count += configuration.group == ANIMATION_GROUP ? 1 : 0;
	}
	return count;
}

} // namespace

TEST_CASE("[AnimationPart] each light of an animated scene is measured at times within the "
		  "animation") {
	const std::vector<ReportScene> scenes = make_animated_scenes();
	const size_t light_count = find_report_view(scenes[0]).lights.size();
	// QUICK measures 4 times for each light, FULL 16.
	CHECK(count_points(make_plan(ReportExtent::NONE, scenes, {})) == 0);
	CHECK(count_points(make_plan(ReportExtent::QUICK, scenes, {})) == 4 * light_count);
	CHECK(count_points(make_plan(ReportExtent::FULL, scenes, {})) == 16 * light_count);
	CHECK(count_points(make_plan(ReportExtent::QUICK, make_scripted_scenes(1), {})) == 0);
	const ReportPlan plan = make_plan(ReportExtent::QUICK, scenes, {});
	std::set<std::string> records;
	for (size_t index = 0; index < plan.report.configurations.size(); ++index) {
		const ReportConfiguration &configuration = plan.report.configurations[index];
		if (configuration.group != ANIMATION_GROUP) {
			continue;
		}
		CHECK(configuration.value > 0);
		CHECK(configuration.value < 2);
		CHECK(records.insert(configuration.record).second);
		const MaskTask task = plan.tasks[index]({});
		REQUIRE(task.next_scene);
		const auto get_x = [](const SceneSnapshot &p_scene) {
			return p_scene.instances[0].world_from_node[3].x;
		};
		CHECK(get_x(*task.scene) == doctest::Approx(configuration.value / 2));
		// One frame, 1/30 s, later.
		CHECK(get_x(*task.next_scene) == doctest::Approx((configuration.value + 1.0 / 30) / 2));
	}
	// Measuring leaves the scene at rest.
	CHECK_FALSE(scenes[0].scene->find_nodes<MeshInstance3D>().front()->posed_parent_from_node);
}

TEST_CASE("[AnimationPart] cells have an error and a temporal error, and series a point per time") {
	const TemporaryFolder folder;
	ScriptedMaskSource masks;
	const ReportPlan plan =
			make_plan(ReportExtent::QUICK, make_animated_scenes(), make_scripted_techniques());
	RecordStore store(folder.path);
	const Report report = run_report(plan, masks, store, {});
	const AnimationPart part;
	const nlohmann::ordered_json json = part.to_json(report);
	REQUIRE(!json.empty());
	for (const auto &plot : json) {
		REQUIRE(!plot["series"].empty());
		for (const auto &series : plot["series"]) {
			const std::string technique = series["technique"].get<std::string>();
			CHECK(series["points"].size() == 4);
			for (const auto &point : series["points"]) {
				// The scripted masks do not change. The mean of their reference is 0.5 in the
				// penumbra, and `errors` are fractions of it.
				CHECK(point["temporal_rmse"].get<double>() == 0);
				CHECK(point["mae"].get<double>() ==
						doctest::Approx(0.5 * masks.errors.at(technique)));
			}
		}
	}
}
