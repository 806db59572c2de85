#include "modules/core/error.h"
#include "modules/error_report/light_variant.h"
#include "modules/scene/tests/test_trees.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <tuple>

using namespace gnomon;

namespace {

const double LENGTH_TOLERANCE_M = 1e-9; // tolerance of positions computed in double, metres
const glm::dvec3 CASTER_CENTER_M(2, 1, 0);

/// A scene with S = 4 m, a caster with the bounds (1, 0, 0)..(3, 2, 0), and a spot light in a
/// rotated, translated and scaled group. A lampshade that casts no shadow is a child of the light.
struct SmallScene {
	Scene scene;
	Camera3D *camera = add_child<Camera3D>(*scene.root, "Camera");
	MeshInstance3D *caster = add_child<MeshInstance3D>(*scene.root, "Caster");
	Node3D *group = add_child<Node3D>(*scene.root, "Group");
	Light3D *light = add_child<Light3D>(*group, "Lamp");
	MeshInstance3D *shade = add_child<MeshInstance3D>(*light, "Shade");

	SmallScene() {
		scene.scene_size_m = 4;
		for (MeshInstance3D *instance : { caster, shade }) {
			instance->surfaces.push_back(
					{ make_mesh("m", { { 1, 0, 0 }, { 3, 0, 0 }, { 1, 2, 0 } }, {}, { 0, 1, 2 }),
							nullptr });
		}
		shade->casts_shadow = false;
		group->parent_from_node = glm::rotate(glm::dmat4(2.0), 0.7, glm::dvec3(0, 0, 1));
		group->parent_from_node[3] = glm::dvec4(5, 4, -3, 1);
		light->parent_from_node = glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(1, 0, 0));
		light->parent_from_node[3] = glm::dvec4(0.5, 1, 0.25, 1);
		light->type = LightType::SPOT;
		light->range_m = 30;
		light->outer_cone_rad = 0.2f;
		light->properties = { { "light_size", 0.1 }, { "light_angular_distance", 0.5 },
			{ "penumbra_outer_width", 0.3 }, { "soft_taps", int64_t(8) } };
	}

	LightSnapshot build(LightType p_type, double p_size_m, const PropertyValues &p_values = {}) {
		return get_light(
				*build_variant(scene, *camera, *light, { p_type, p_size_m }, p_values), "Lamp");
	}
};

/// Returns the state of the light and its child that build_variant changes.
auto get_state(const SmallScene &p_small) {
	const Light3D &light = *p_small.light;
	return std::tuple(light.type, light.parent_from_node, p_small.shade->parent_from_node,
			light.range_m, light.inner_cone_rad, light.outer_cone_rad, light.properties);
}

} // namespace

TEST_CASE("[ErrorReport] a variant of the same type changes only the size of the light") {
	SmallScene small;
	const LightSnapshot before = build_snapshot(small.scene, *small.camera)->lights[0];
	const LightSnapshot light = small.build(LightType::SPOT, 0.4);
	CHECK(light.light_size_m == 0.4f);
	CHECK(light.position_world == before.position_world);
	CHECK(light.world_from_light == before.world_from_light);
	CHECK(light.outer_cone_rad == 0.2f);
	PropertyValues expected = before.properties;
	expected["light_size"] = 0.4;
	CHECK(light.properties == expected);
}

TEST_CASE("[ErrorReport] a directional light has the angular size of the disc at distance 1.5 S") {
	SmallScene small;
	small.light->type = LightType::DIRECTIONAL;
	const LightSnapshot light = small.build(LightType::DIRECTIONAL, 0.4);
	const double angle_deg = glm::degrees(2 * std::atan(0.4 / (1.5 * 4)));
	CHECK(light.light_angular_distance_deg == doctest::Approx(angle_deg));
	CHECK(light.get_disc_radius() == doctest::Approx(0.4 / 6));
	CHECK(light.world_from_light ==
			build_snapshot(small.scene, *small.camera)->lights[0].world_from_light);
}

TEST_CASE("[ErrorReport] a light of another type keeps its position and faces the casters") {
	for (const LightType type : { LightType::OMNI, LightType::DIRECTIONAL }) {
		SmallScene small;
		const glm::dvec3 position =
				build_snapshot(small.scene, *small.camera)->lights[0].position_world;
		const LightSnapshot light = small.build(type, 0.4);
		CHECK(light.type == type);
		CHECK(glm::length(light.position_world - position) < LENGTH_TOLERANCE_M);
		const glm::dvec3 direction = glm::normalize(CASTER_CENTER_M - position);
		CHECK(glm::length(light.get_direction_world() - direction) < LENGTH_TOLERANCE_M);
	}
	SmallScene small; // a light that shines straight down, parallel to the world's up vector
	small.group->parent_from_node = glm::dmat4(1.0);
	small.light->parent_from_node =
			glm::translate(glm::dmat4(1.0), CASTER_CENTER_M + glm::dvec3(0, 5, 0));
	const LightSnapshot light = small.build(LightType::DIRECTIONAL, 0.4);
	CHECK(glm::length(light.get_direction_world() - glm::dvec3(0, -1, 0)) < LENGTH_TOLERANCE_M);
}

TEST_CASE("[ErrorReport] an omni light changed to a spot light has all casters in its cone") {
	SmallScene small;
	small.light->type = LightType::OMNI;
	const LightSnapshot light = small.build(LightType::SPOT, 0.4);
	CHECK(light.inner_cone_rad == 0);
	const double distance = glm::length(CASTER_CENTER_M - light.position_world);
	CHECK(light.outer_cone_rad > std::asin(std::sqrt(2.0) / distance)); // their bounding sphere
	// CONE_MARGIN is 1.1.
	CHECK(light.outer_cone_rad < 1.2 * std::asin(std::sqrt(2.0) / distance));
	// Inside the bounding sphere no cone contains all casters; it gets the maximum angle, not NaN.
	small.group->parent_from_node = glm::dmat4(1.0);
	small.light->parent_from_node = glm::translate(glm::dmat4(1.0), CASTER_CENTER_M);
	CHECK(small.build(LightType::SPOT, 0.4).outer_cone_rad == doctest::Approx(1.4));
}

TEST_CASE("[ErrorReport] a formerly directional light is placed 1.5 S from the casters' centre") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		SmallScene small;
		small.light->type = LightType::DIRECTIONAL;
		const glm::dvec3 direction =
				build_snapshot(small.scene, *small.camera)->lights[0].get_direction_world();
		const LightSnapshot light = small.build(type, 0.4);
		CHECK(glm::length(light.position_world - (CASTER_CENTER_M - 6.0 * direction)) <
				LENGTH_TOLERANCE_M);
		CHECK(glm::length(light.get_direction_world() - direction) < LENGTH_TOLERANCE_M);
	}
}

TEST_CASE("[ErrorReport] child nodes of a changed light keep their world transform") {
	SmallScene small;
	const Bounds before = build_snapshot(small.scene, *small.camera)->instances[1].bounds_world;
	const LightVariant variant = { LightType::OMNI, 0.4 };
	const auto scene = build_variant(small.scene, *small.camera, *small.light, variant, {});
	CHECK(glm::length(scene->instances[1].bounds_world.minimum - before.minimum) <
			LENGTH_TOLERANCE_M);
}

TEST_CASE("[ErrorReport] given properties override those of the light, including its size") {
	SmallScene small;
	const LightSnapshot light = small.build(LightType::SPOT, 0.4,
			{ { "soft_taps", int64_t(64) }, { "penumbra_outer_width", -1.0 }, { "extra", true } });
	CHECK(light.properties ==
			PropertyValues{ { "extra", true }, { "light_angular_distance", 0.5 },
					{ "light_size", 0.4 }, { "penumbra_outer_width", -1.0 },
					{ "soft_taps", int64_t(64) } });
	CHECK(light.penumbra_outer_width_m == 0.4f); // derived from the new size
	CHECK(small.build(LightType::SPOT, 0.4, { { "light_size", 0.7 } }).light_size_m == 0.7f);
}

TEST_CASE("[ErrorReport] build_variant restores the scene, also when it fails") {
	SmallScene small;
	const auto before = get_state(small);
	for (const LightType type : { LightType::OMNI, LightType::SPOT, LightType::DIRECTIONAL }) {
		const LightVariant variant = { type, 0.4 };
		build_variant(small.scene, *small.camera, *small.light, variant, { { "extra", true } });
		CHECK((get_state(small) == before));
		CHECK_THROWS_WITH_AS(build_variant(small.scene, *small.camera, *small.light, variant,
									 { { "light_size", -1.0 } }),
				doctest::Contains("Light \"Lamp\": light_size is -1"), Error);
		CHECK((get_state(small) == before));
	}
}

TEST_CASE("[ErrorReport] without casters a light cannot change its type, only its size") {
	SmallScene small;
	small.caster->casts_shadow = false;
	CHECK_THROWS_WITH_AS(small.build(LightType::OMNI, 0.4),
			"Light \"Lamp\": nothing in the scene casts a shadow, so that a light of another type "
			"has nothing to look at. Use --light-types own.",
			Error);
	CHECK(small.build(LightType::SPOT, 0.4).light_size_m == 0.4f);
}

TEST_CASE("[ErrorReport] the whole light is seen until its disc touches the surface's horizon") {
	LightSnapshot light;
	const auto sees = [&](float p_size_m, const glm::vec3 &p_light) {
		light.light_size_m = p_size_m;
		return is_light_disc_above_horizon(
				light, p_light + glm::vec3(7), glm::vec3(7), { 0, 1, 0 });
	};
	// The disc's lowest point is 3 - R * 4 / 5 above the plane: it touches it at R = 3.75.
	CHECK(sees(3.74f, { 4, 3, 0 }));
	CHECK_FALSE(sees(3.76f, { 4, 3, 0 }));
	CHECK(sees(1e4f, { 0, 1e-3f, 0 }));	   // directly above, the disc is parallel to the surface
	CHECK_FALSE(sees(1e-3f, { 4, 0, 0 })); // light in the tangent plane: half of the disc is seen
	CHECK(sees(0, { 4, 0, 0 }));
	CHECK_FALSE(sees(0, { 4, -1e-3f, 0 }));
	CHECK_FALSE(sees(0, { 0, 0, 0 })); // light at the point itself: no direction
}

TEST_CASE("[ErrorReport] a directional light is seen whole if its disc is above the horizon") {
	LightSnapshot light; // shines along -Z
	light.type = LightType::DIRECTIONAL;
	light.light_angular_distance_deg = 60;
	const auto sees = [&](double p_elevation_deg) {
		const double elevation = glm::radians(p_elevation_deg);
		const glm::vec3 normal(std::cos(elevation), 0, std::sin(elevation));
		const glm::vec3 ignored_light_position(-9);
		return is_light_disc_above_horizon(
				light, ignored_light_position, glm::vec3(0, 0, 100), normal);
	};
	CHECK(sees(90));
	CHECK(sees(30.01));
	CHECK_FALSE(sees(29.99));
}
