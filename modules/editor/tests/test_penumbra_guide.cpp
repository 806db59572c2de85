#include "modules/editor/penumbra_guide.h"
#include "modules/renderer/tests/render_fixture.h"
#include "modules/scene/mesh_rig.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;

namespace {

/// A light vertically above a box that floats above the ground, seen from +X.
struct GuidedScene : SmallScene {
	SceneRays rays;

	explicit GuidedScene(LightType p_type) : SmallScene(p_type) {
		camera->parent_from_node = look_at({ 5.0, 4.0, 0.1 }, { 0.5, 0.0, 0.0 });
		light->parent_from_node = look_at({ 0.0, 4.0, 0.0 }, { 0.0, 0.0, 0.0 });
		light->properties["penumbra_outer_width"] = 0.2;
		light->properties["penumbra_inner_width"] = 0.1;
	}
	std::vector<PenumbraLine> find_lines(size_t p_edge_count = 1000) {
		rays.update_scene(scene);
		const auto snapshot = snap();
		return find_penumbra_lines(rays, *snapshot, snapshot->lights.front(), p_edge_count);
	}
};

/// Returns the X coordinate of the lines along Z on the ground beyond the box's +X side; -1: none.
double find_x(const std::vector<PenumbraLine> &p_lines, bool p_is_outer) {
	double x = -1;
	for (const PenumbraLine &line : p_lines) {
		if (line.is_outer == p_is_outer && line.from_world.x > 0.55 &&
				std::abs(line.from_world.x - line.to_world.x) < 1e-9) {
			CHECK(std::abs(line.from_world.y) < 1e-6);
			CHECK((x < 0 || x == doctest::Approx(line.from_world.x)));
			x = line.from_world.x;
		}
	}
	return x;
}

} // namespace

TEST_CASE("The penumbra of a straight edge ends where the rays from the light's rim meet the "
		  "ground") {
	// In the XY plane: the edge is at (0.5, 1.3), the light at (0, 4). A ray through the edge has
	// the direction d = (0.5, -2.7) + w n, where n = (2.7, 0.5) / 2.7459 is perpendicular to the
	// ray from the light's centre, and w is 0.2 (outer) or -0.1 (inner). It meets the ground at
	// x = 0.5 + 1.3 d.x / -d.y.
	for (LightType type : { LightType::SPOT, LightType::OMNI }) {
		const std::vector<PenumbraLine> lines = GuidedScene(type).find_lines();
		CHECK(find_x(lines, true) == doctest::Approx(0.84002).epsilon(1e-4));
		CHECK(find_x(lines, false) == doctest::Approx(0.69210).epsilon(1e-4));
	}
	// A directional light: the tangents of the angles are 0.2 / S and 0.1 / S with S = 4 m, and the
	// edge is 1.3 m above the ground.
	const std::vector<PenumbraLine> lines = GuidedScene(LightType::DIRECTIONAL).find_lines();
	CHECK(find_x(lines, true) == doctest::Approx(0.5 + 1.3 * 0.05).epsilon(1e-4));
	CHECK(find_x(lines, false) == doctest::Approx(-1.0)); // it would be under the box, at x = 0.47
}

TEST_CASE("There are no penumbra lines without a shadow, a width or a caster, and few if the edge "
		  "count is limited") {
	GuidedScene scene(LightType::SPOT);
	const size_t all_count = scene.find_lines().size();
	CHECK(all_count > 2);
	CHECK(scene.find_lines(1).size() <= 2); // outer and inner line of one edge
	scene.light->properties["shadow_enabled"] = false;
	CHECK(scene.find_lines().empty());
	scene.light->properties["shadow_enabled"] = true;
	scene.light->properties["penumbra_inner_width"] = 0.0;
	scene.light->properties["penumbra_outer_width"] = 0.0;
	CHECK(scene.find_lines().empty());
	scene.light->properties["penumbra_outer_width"] = 0.2;
	scene.box->casts_shadow = false;
	CHECK(scene.find_lines().empty()); // no receiver below the ground's edges
}

TEST_CASE("Penumbra lines outside a light's cone or range are omitted") {
	GuidedScene scene(LightType::SPOT);
	scene.light->outer_cone_rad = 0.1f;
	CHECK(scene.find_lines().empty());
	GuidedScene near(LightType::OMNI);
	near.light->range_m = 3.0f;
	CHECK(near.find_lines().empty());
}

TEST_CASE("A ray through the scene finds the nearest node, also a scaled one") {
	GuidedScene scene(LightType::SPOT);
	scene.box->parent_from_node =
			glm::scale(scene.box->parent_from_node, glm::dvec3(0.5, 1.0, 2.0));
	scene.rays.update_scene(scene.scene);
	const auto first = scene.rays.find_nearest({ 0.1, 5.0, 0.1 }, { 0.0, -2.0, 0.0 });
	REQUIRE(first);
	CHECK(first->instance->node == scene.box);
	CHECK(first->t == doctest::Approx((5.0 - 1.3) / 2.0)); // the box ends at y = 1.3
	const auto beyond =
			scene.rays.find_nearest({ 0.1, 5.0, 0.1 }, { 0.0, -2.0, 0.0 }, 0.0, first->instance);
	REQUIRE(beyond);
	CHECK(beyond->instance->node == scene.ground);
	CHECK(!scene.rays.find_nearest({ 0.1, 5.0, 0.1 }, { 0.0, 1.0, 0.0 }));
	// Rays ignore a node that is scaled to zero.
	scene.box->parent_from_node[1] = glm::dvec4(0.0);
	scene.rays.update_scene(scene.scene);
	const auto past_flat = scene.rays.find_nearest({ 0.1, 5.0, 0.1 }, { 0.0, -1.0, 0.0 });
	REQUIRE(past_flat);
	CHECK(past_flat->instance->node == scene.ground);
}

TEST_CASE("The penumbra lines of a deformed mesh move with its vertices") {
	// A morph target moves the box 1 m along X; at weight 0.5 the lines move by 0.5 m.
	GuidedScene moved(LightType::DIRECTIONAL);
	moved.box->parent_from_node[3].x += 0.5;
	const double expected = find_x(moved.find_lines(), true);
	GuidedScene scene(LightType::DIRECTIONAL);
	const Mesh &rest = *scene.box->surfaces[0].mesh;
	const size_t count = rest.positions_node.size();
	MeshAttributes attributes = rest.attributes;
	MeshRig rig;
	rig.targets.push_back({ std::vector<glm::vec3>(count, glm::vec3(1, 0, 0)), {}, {} });
	attributes.rig = make_mesh_rig(std::move(rig), rest.positions_node, "box");
	scene.box->surfaces[0].mesh =
			make_mesh("box", rest.positions_node, rest.normals_node, rest.indices, attributes);
	scene.box->morph_weights = { 0 };
	const double at_rest = find_x(scene.find_lines(), true);
	CHECK(at_rest == doctest::Approx(expected - 0.5).epsilon(1e-4));
	scene.box->posed_morph_weights = { 0.5f };
	CHECK(find_x(scene.find_lines(), true) == doctest::Approx(expected).epsilon(1e-4));
}
