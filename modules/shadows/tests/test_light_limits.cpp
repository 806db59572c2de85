#include "modules/core/log.h"
#include "modules/shadows/light_limits.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

std::string describe_problem(const SmallScene &p_scene) {
	const auto snapshot = p_scene.snap();
	return describe_scene_size_problem(snapshot->scene_size_m, SceneSummary(snapshot->instances));
}

std::vector<ExceededLimit> find_exceeded(const SmallScene &p_scene, const ShadowLimits &p_limits) {
	const auto snapshot = p_scene.snap();
	return LightLimits().find_exceeded(
			*snapshot, SceneSummary(snapshot->instances), snapshot->lights[0], "some", p_limits);
}

bool holds(const std::string &p_text, const std::string &p_part) {
	return p_text.find(p_part) != std::string::npos;
}

} // namespace

TEST_CASE(
		"[LightLimits] a caster that touches the light's sphere is named, one next to it is not") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		SmallScene scene(type);
		CHECK(find_exceeded(scene, {}).empty());
		// The light has a radius of 0.2 m and is at (1.2, 4.0, 0.8).
		MeshInstance3D &shade = add_mesh(
				scene.scene, "Shade", make_box_mesh("shade", glm::vec3(0.1f)), { 1.2, 4.25, 0.8 });
		const std::vector<ExceededLimit> exceeded = find_exceeded(scene, {}); // 0.15 m away
		REQUIRE(exceeded.size() == 1);
		CAPTURE(exceeded[0].warning);
		CHECK(holds(exceeded[0].warning, "Light \"Light\": caster \"Shade\""));
		CHECK(holds(exceeded[0].warning, "1 x light_size = 0.2"));
		CHECK(holds(exceeded[0].warning, "Lower light_size"));
		shade.parent_from_node[3].y = 4.35; // 0.25 m
		CHECK(find_exceeded(scene, {}).empty());
		CHECK(find_exceeded(scene, { .min_caster_distance_radii = 2 }).size() == 1);
		// The light inside a wide lamp shade: no face of it is near.
		shade.parent_from_node = glm::scale(
				glm::translate(glm::dmat4(1.0), glm::dvec3(1.2, 4.0, 0.8)), glm::dvec3(3.0));
		CHECK(find_exceeded(scene, {}).empty());
		shade.casts_shadow = false;
		CHECK(find_exceeded(scene, { .min_caster_distance_radii = 2 }).empty());
	}
	SmallScene sunny(LightType::DIRECTIONAL); // has no position
	add_mesh(sunny.scene, "Shade", make_box_mesh("shade", glm::vec3(0.1f)), { 1.2, 4.1, 0.8 });
	CHECK(find_exceeded(sunny, {}).empty());
}

TEST_CASE("[LightLimits] widths beyond a technique's limit are reported with their values") {
	SmallScene scene;
	scene.scene.scene_size_m = 4.0;
	scene.light->properties["penumbra_outer_width"] = 0.3;
	scene.light->properties["penumbra_inner_width"] = 1.0;
	CHECK(find_exceeded(scene, { .max_outer_width_sizes = 0.08, .max_inner_width_sizes = 0.25 })
					.empty());
	const std::vector<ExceededLimit> exceeded =
			find_exceeded(scene, { .max_inner_width_sizes = 0.2 });
	REQUIRE(exceeded.size() == 1);
	CHECK(holds(exceeded[0].warning, "penumbra_inner_width is 1 m"));
	CHECK(holds(exceeded[0].warning, "above 0.8"));
}

TEST_CASE("[LightLimits] a derived width is reported with the light size that it comes from") {
	SmallScene scene;
	scene.scene.scene_size_m = 4.0;
	scene.light->properties["light_size"] = 0.9;
	const std::vector<ExceededLimit> exceeded =
			find_exceeded(scene, { .max_outer_width_sizes = 0.2 });
	REQUIRE(exceeded.size() == 1);
	CAPTURE(exceeded[0].warning);
	CHECK(holds(exceeded[0].warning, "penumbra_outer_width, derived from light_size, is 0.9 m"));
	CHECK(holds(exceeded[0].warning, "Lower light_size"));
}

TEST_CASE("[LightLimits] a scene size that does not fit the casters is reported") {
	SmallScene scene;
	CHECK(describe_problem(scene).empty());
	scene.scene.scene_size_m = 2000.0; // 1000 times the box
	CHECK(describe_problem(scene).empty());
	scene.scene.scene_size_m = 40000.0;
	std::string problem = describe_problem(scene);
	CAPTURE(problem);
	CHECK(holds(problem, "The scene's size is 40000 m"));
	CHECK(holds(problem, "begin 0.04 m away"));
	scene.scene.scene_size_m = 1e-4;
	problem = describe_problem(scene);
	CHECK(holds(problem, "Set scene_size"));
	CHECK(holds(problem, "at least"));
}

TEST_CASE("[LightLimits] a caster is searched again only when it or the light moved") {
	SmallScene scene;
	MeshInstance3D &shade = add_mesh(
			scene.scene, "Shade", make_box_mesh("shade", glm::vec3(0.5f)), { 1.2, 4.0, 0.8 });
	LightLimits limits; // the light is in the middle of the shade
	const auto count_exceeded = [&](const ShadowLimits &p_limits) {
		const auto snapshot = scene.snap();
		return limits
				.find_exceeded(*snapshot, SceneSummary(snapshot->instances), snapshot->lights[0],
						"some", p_limits)
				.size();
	};
	CHECK(count_exceeded({}) == 0);
	CHECK(limits.get_search_count() == 1);
	CHECK(count_exceeded({}) == 0);
	scene.box->parent_from_node[3].y += 0.1; // far away: not searched at all
	CHECK(count_exceeded({}) == 0);
	CHECK(limits.get_search_count() == 1);
	shade.parent_from_node[3].y += 0.4;
	CHECK(count_exceeded({}) == 1);
	CHECK(limits.get_search_count() == 2);
	scene.light->parent_from_node[3].y += 0.4;
	CHECK(count_exceeded({}) == 0);
	CHECK(limits.get_search_count() == 3);
	CHECK(count_exceeded({ .min_caster_distance_radii = 3 }) == 1); // 0.6 m, faces at 0.5 m
	CHECK(limits.get_search_count() == 4);
}

TEST_CASE("[LightLimits] a caster behind a spot light causes no warning") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		SmallScene scene(type);
		const glm::dvec3 to_light = glm::normalize(glm::dvec3(1.2, 4.0, 0.8));
		add_mesh(scene.scene, "Ceiling", make_box_mesh("ceiling", glm::vec3(0.05f)),
				glm::dvec3(1.2, 4.0, 0.8) + 0.5 * to_light);
		CHECK(find_exceeded(scene, { .min_caster_distance_radii = 3 }).size() ==
				(type == LightType::OMNI ? 1 : 0));
	}
}

TEST_CASE("[GPU][LightLimits] a warning is logged once, even when the light's size changes") {
	MaskFixture fixture;
	SmallScene scene;
	add_mesh(scene.scene, "Shade", make_box_mesh("shade", glm::vec3(0.1f)), { 1.2, 4.15, 0.8 });
	std::vector<std::string> warnings;
	const LogSink before = set_log_sink([&](LogLevel p_level, const std::string &p_line) {
		if (p_level == LogLevel::WARNING) {
			warnings.push_back(p_line);
		}
	});
	const ShadowTechniqueInfo *technique = ShadowRegistry::find_fallback();
	if (technique != nullptr) {
		for (const double size_m : { 0.2, 0.21, 0.22 }) {
			scene.light->properties["light_size"] = size_m;
			fixture.render_mask(scene, technique->id);
		}
	}
	set_log_sink(before);
	CHECK(warnings.size() == (technique != nullptr ? 1 : 0));
}
