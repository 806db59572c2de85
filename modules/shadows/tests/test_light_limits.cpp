#include "modules/core/log.h"
#include "modules/shadows/light_limits.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

std::vector<BrokenLimit> find_broken(const SmallScene &p_scene, const ShadowLimits &p_limits) {
	const auto snapshot = p_scene.snap();
	return LightLimits().find_broken(*snapshot, snapshot->lights[0], "some", p_limits);
}

bool holds(const std::string &p_text, const std::string &p_part) {
	return p_text.find(p_part) != std::string::npos;
}

} // namespace

TEST_CASE(
		"[LightLimits] a caster that touches the light's sphere is named, one next to it is not") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		SmallScene scene(type);
		CHECK(find_broken(scene, {}).empty());
		// Of size 0.2 m at (1.2, 4.0, 0.8).
		MeshInstance3D &shade = add_mesh(
				scene.scene, "Shade", make_box_mesh("shade", glm::vec3(0.1f)), { 1.2, 4.25, 0.8 });
		const std::vector<BrokenLimit> broken = find_broken(scene, {}); // 0.15 m away
		REQUIRE(broken.size() == 1);
		CAPTURE(broken[0].warning);
		CHECK(holds(broken[0].warning, "Light \"Light\": caster \"Shade\""));
		CHECK(holds(broken[0].warning, "1 x light_size = 0.2"));
		CHECK(holds(broken[0].warning, "Lower light_size"));
		shade.parent_from_node[3].y = 4.35; // 0.25 m
		CHECK(find_broken(scene, {}).empty());
		CHECK(find_broken(scene, { .least_caster_distance_radii = 2 }).size() == 1);
		// The light inside a wide lamp shade: no face of it is near.
		shade.parent_from_node = glm::scale(
				glm::translate(glm::dmat4(1.0), glm::dvec3(1.2, 4.0, 0.8)), glm::dvec3(3.0));
		CHECK(find_broken(scene, {}).empty());
		shade.casts_shadow = false;
		CHECK(find_broken(scene, { .least_caster_distance_radii = 2 }).empty());
	}
	SmallScene sunny(LightType::DIRECTIONAL); // is nowhere
	add_mesh(sunny.scene, "Shade", make_box_mesh("shade", glm::vec3(0.1f)), { 1.2, 4.1, 0.8 });
	CHECK(find_broken(sunny, {}).empty());
}

TEST_CASE("[LightLimits] widths beyond a technique's limit are reported with their values") {
	SmallScene scene;
	scene.scene.scene_size_m = 4.0;
	scene.light->properties["penumbra_outer_width"] = 0.3;
	scene.light->properties["penumbra_inner_width"] = 1.0;
	CHECK(find_broken(scene, { .most_outer_width_sizes = 0.08, .most_inner_width_sizes = 0.25 })
					.empty());
	const std::vector<BrokenLimit> broken = find_broken(scene, { .most_inner_width_sizes = 0.2 });
	REQUIRE(broken.size() == 1);
	CHECK(holds(broken[0].warning, "penumbra_inner_width is 1 m"));
	CHECK(holds(broken[0].warning, "above 0.8"));
}

TEST_CASE("[LightLimits] a width that was derived is reported with the size that it comes from") {
	SmallScene scene;
	scene.scene.scene_size_m = 4.0;
	scene.light->properties["light_size"] = 0.9;
	const std::vector<BrokenLimit> broken = find_broken(scene, { .most_outer_width_sizes = 0.2 });
	REQUIRE(broken.size() == 1);
	CAPTURE(broken[0].warning);
	CHECK(holds(broken[0].warning, "penumbra_outer_width, derived from light_size, is 0.9 m"));
	CHECK(holds(broken[0].warning, "Lower light_size"));
}

TEST_CASE("[LightLimits] a size of the scene that does not fit to its casters is reported") {
	SmallScene scene;
	CHECK(describe_unfit_size(*scene.snap()).empty());
	scene.scene.scene_size_m = 2000.0;
	std::string problem = describe_unfit_size(*scene.snap());
	CAPTURE(problem);
	CHECK(holds(problem, "The scene's size is 2000 m"));
	CHECK(holds(problem, "begin 0.1 m away"));
	scene.scene.scene_size_m = 1e-4;
	problem = describe_unfit_size(*scene.snap());
	CHECK(holds(problem, "Set scene_size"));
	CHECK(holds(problem, "at least"));
}

TEST_CASE("[LightLimits] a caster is searched again only when it or the light moved") {
	SmallScene scene;
	MeshInstance3D &shade = add_mesh(
			scene.scene, "Shade", make_box_mesh("shade", glm::vec3(0.5f)), { 1.2, 4.0, 0.8 });
	LightLimits limits; // the light is in the middle of the shade
	const auto count_broken = [&](const ShadowLimits &p_limits) {
		const auto snapshot = scene.snap();
		return limits.find_broken(*snapshot, snapshot->lights[0], "some", p_limits).size();
	};
	CHECK(count_broken({}) == 0);
	CHECK(limits.get_search_count() == 1);
	CHECK(count_broken({}) == 0);
	scene.box->parent_from_node[3].y += 0.1; // far away: not searched at all
	CHECK(count_broken({}) == 0);
	CHECK(limits.get_search_count() == 1);
	shade.parent_from_node[3].y += 0.4;
	CHECK(count_broken({}) == 1);
	CHECK(limits.get_search_count() == 2);
	scene.light->parent_from_node[3].y += 0.4;
	CHECK(count_broken({}) == 0);
	CHECK(limits.get_search_count() == 3);
	CHECK(count_broken({ .least_caster_distance_radii = 3 }) == 1); // 0.6 m
	CHECK(limits.get_search_count() == 4);
}

TEST_CASE("[LightLimits] what is behind a spot is not near it") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		SmallScene scene(type);
		const glm::dvec3 way = glm::normalize(glm::dvec3(1.2, 4.0, 0.8));
		add_mesh(scene.scene, "Ceiling", make_box_mesh("ceiling", glm::vec3(0.05f)),
				glm::dvec3(1.2, 4.0, 0.8) + 0.5 * way);
		CHECK(find_broken(scene, { .least_caster_distance_radii = 3 }).size() ==
				(type == LightType::OMNI ? 1 : 0));
	}
}

TEST_CASE("[GPU][LightLimits] the renderer warns once, whatever the light does then") {
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
