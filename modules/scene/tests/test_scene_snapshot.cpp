#include "modules/core/error.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/scene/tests/test_trees.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>
#include <numbers>

using namespace gnomon;

namespace {

/// A camera, a light and one triangle, whose bounds are (0, 0, 0)..(1, 1, 0).
struct SmallScene {
	Scene scene;
	Camera3D *camera = add_child<Camera3D>(*scene.root, "Camera");
	Light3D *light = add_child<Light3D>(*scene.root, "Lamp");
	MeshInstance3D *instance = add_child<MeshInstance3D>(*scene.root, "Box");
	SmallScene() {
		instance->surfaces.push_back(
				{ make_mesh("m", { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, {}, { 0, 1, 2 }),
						nullptr });
	}
	std::shared_ptr<const SceneSnapshot> build() const { return build_snapshot(scene, *camera); }
};

} // namespace

TEST_CASE("[SceneSnapshot] penumbra widths that are not set become the light's size, others stay") {
	SmallScene small;
	small.light->properties = { { "light_size", 0.4 }, { "penumbra_inner_width", 0.25 },
		{ "x_taps", int64_t(8) } }; // of another module: copied as it is
	const LightSnapshot light = small.build()->lights[0];
	CHECK(light.penumbra_outer_width_m == 0.4f);
	CHECK(light.penumbra_inner_width_m == 0.25f);
	CHECK(light.get_disc_radius() == 0.4f);
	CHECK(light.casts_shadow);
	CHECK(light.properties == small.light->properties);
	CHECK(light.is_outer_width_derived);
	CHECK_FALSE(light.is_inner_width_derived);
}

TEST_CASE("[SceneSnapshot] a directional light's disc radius is the tangent of half its angle") {
	SmallScene small;
	small.light->type = LightType::DIRECTIONAL;
	small.light->properties = { { "light_angular_distance", 90.0 } };
	CHECK(small.build()->lights[0].get_disc_radius() ==
			doctest::Approx(std::tan(std::numbers::pi / 4)));
}

TEST_CASE("[SceneSnapshot] derived widths of a directional light scale with the scene size") {
	for (double size_m :
			{ 4.0, 4000.0, 4e6 }) { // the last: beyond the range of a width that is set
		SmallScene small;
		small.scene.scene_size_m = size_m;
		small.light->type = LightType::DIRECTIONAL;
		small.light->properties = { { "light_angular_distance", 6.0 }, { "light_size", 0.4 },
			{ "penumbra_inner_width", 0.25 } };
		const LightSnapshot light = small.build()->lights[0];
		CHECK(light.penumbra_outer_width_m ==
				doctest::Approx(std::tan(glm::radians(3.0)) * size_m));
		CHECK(light.penumbra_inner_width_m == 0.25f);
	}
}

TEST_CASE("[SceneSnapshot] widths are derived with the factors of one technique, not of two") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		CAPTURE(get_light_type_name(type));
		SmallScene small;
		small.scene.scene_size_m = 40.0;
		small.light->type = type;
		small.light->properties = { { "light_size", 0.4 }, { "light_angular_distance", 6.0 } };
		LightSnapshot light = small.build()->lights[0];
		const double size_m =
				type == LightType::DIRECTIONAL ? std::tan(glm::radians(3.0)) * 40.0 : 0.4;
		CHECK(light.size_m == doctest::Approx(size_m));
		for (const DerivedWidths &widths :
				{ DerivedWidths{ 0.25f, 0.5f }, DerivedWidths{ 0.5f, 0.0f }, DerivedWidths() }) {
			light.derive_widths(widths);
			CHECK(light.penumbra_outer_width_m == doctest::Approx(widths.outer_per_size * size_m));
			CHECK(light.penumbra_inner_width_m == doctest::Approx(widths.inner_per_size * size_m));
			CHECK(light.size_m == doctest::Approx(size_m));
		}
	}
}

TEST_CASE("[SceneSnapshot] a width that is set, even to 0, stays when widths are derived") {
	for (const char *set : { "penumbra_outer_width", "penumbra_inner_width" }) {
		for (const double width_m : { 0.0, 0.3 }) {
			SmallScene small;
			small.light->properties = { { "light_size", 0.4 }, { set, width_m } };
			LightSnapshot light = small.build()->lights[0];
			light.derive_widths({ 0.25f, 0.5f });
			const bool is_outer = std::string(set) == "penumbra_outer_width";
			CHECK(light.penumbra_outer_width_m == (is_outer ? float(width_m) : 0.1f));
			CHECK(light.penumbra_inner_width_m == (is_outer ? 0.2f : float(width_m)));
		}
	}
}

TEST_CASE("[SceneSnapshot] a value out of range is an error that names the light") {
	SmallScene small;
	small.light->properties = { { "light_size", -1.0 } };
	CHECK_THROWS_WITH_AS(
			small.build(), doctest::Contains("Light \"Lamp\": light_size is -1"), Error);
	small.light->properties = { { "light_size", int64_t(2) } }; // an integer is converted
	CHECK(small.build()->lights[0].light_size_m == 2.0f);
}

TEST_CASE("[SceneSnapshot] a light's orientation ignores scale and mirroring") {
	SmallScene small;
	const glm::dmat4 rotation =
			glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
	small.light->parent_from_node = rotation * glm::scale(glm::dmat4(1.0), glm::dvec3(-2, 3, 1e-5));
	const LightSnapshot light = small.build()->lights[0];
	const glm::dmat3 product = glm::transpose(light.world_from_light) * light.world_from_light;
	for (int axis = 0; axis < 3; ++axis) {
		CHECK(glm::length(product[axis] - glm::dmat3(1.0)[axis]) < 1e-12);
	}
	CHECK(glm::determinant(light.world_from_light) == doctest::Approx(1.0));
	CHECK(glm::length(light.get_direction_world() + glm::dvec3(rotation[2])) < 1e-12);
}

TEST_CASE("[SceneSnapshot] invalid transforms are errors that name their node") {
	SmallScene small;
	small.light->parent_from_node = glm::scale(glm::dmat4(1.0), glm::dvec3(0, 1, 1));
	CHECK_THROWS_WITH_AS(small.build(), doctest::Contains("Light \"Lamp\""), Error);
	small.light->parent_from_node = glm::dmat4(1.0);
	small.light->parent_from_node[0] = small.light->parent_from_node[1];
	CHECK_THROWS_WITH_AS(small.build(), doctest::Contains("Light \"Lamp\""), Error);
	small.light->parent_from_node = glm::dmat4(1.0);
	small.instance->parent_from_node[3].y = std::numeric_limits<double>::quiet_NaN();
	CHECK_THROWS_WITH_AS(small.build(), doctest::Contains("Node \"Box\""), Error);
	small.instance->parent_from_node = glm::scale(glm::dmat4(1.0), glm::dvec3(0.0));
	CHECK_NOTHROW(small.build()); // draws nothing
	small.camera->parent_from_node = glm::scale(glm::dmat4(1.0), glm::dvec3(0.0));
	CHECK_THROWS_WITH_AS(small.build(), doctest::Contains("Camera \"Camera\""), Error);
}

TEST_CASE("[SceneSnapshot] the scene size is the given one, else the casters' diagonal, never 0") {
	SmallScene small;
	CHECK(small.build()->scene_size_m == doctest::Approx(std::sqrt(2.0)));
	small.scene.scene_size_m = 4;
	CHECK(small.build()->scene_size_m == 4);
	small.scene.scene_size_m = 0;
	small.instance->casts_shadow = false;
	CHECK(small.build()->scene_size_m == 1e-9);
}

TEST_CASE("[SceneSnapshot] bounds enclose rotated corners, camera-relative space keeps precision") {
	SmallScene small;
	const glm::dvec3 far_away(1e9, 0, 0);
	small.instance->parent_from_node = glm::rotate(
			glm::translate(glm::dmat4(1.0), far_away), glm::radians(90.0), glm::dvec3(0, 0, 1));
	small.camera->parent_from_node =
			glm::translate(glm::dmat4(1.0), far_away + glm::dvec3(0.125, 0, 0));
	const auto snapshot = small.build();
	const InstanceSnapshot &instance = snapshot->instances[0];
	CHECK(instance.material); // the default one, as the surface has none
	CHECK(instance.bounds_world.minimum.x == doctest::Approx(1e9 - 1).epsilon(1e-15));
	CHECK(instance.bounds_world.maximum.y == doctest::Approx(1.0));
	CHECK(snapshot->get_camera_relative_from_node(instance)[3].x == -0.125f);
	CHECK(snapshot->to_camera_relative(far_away).x == -0.125f);
}

TEST_CASE("[SceneSnapshot] a mirroring transform is detected") {
	InstanceSnapshot instance;
	CHECK_FALSE(instance.is_mirrored());
	instance.world_from_node = glm::scale(glm::dmat4(1.0), glm::dvec3(1, -1, 1));
	CHECK(instance.is_mirrored());
}

TEST_CASE("[SceneSnapshot] an instance casts with another mesh, or nothing, for single lights") {
	SmallScene small;
	SceneSnapshot scene = *small.build();
	CHECK_FALSE(scene.select_casters(scene.lights[0]));
	const auto other = make_mesh("o", { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 2, 0 } }, {}, { 0, 1, 2 });
	InstanceSnapshot &instance = scene.instances.edit(0);
	const uint64_t hash = instance.compute_hash(1);
	instance.caster_meshes_of_lights = { { "Lamp", other }, { "Sun", nullptr } };
	const auto of_lamp = scene.select_casters(scene.lights[0]);
	REQUIRE(of_lamp);
	CHECK(of_lamp->instances[0].caster_mesh == other);
	CHECK(of_lamp->instances[0].casts_shadow);
	CHECK(of_lamp->instances[0].compute_hash(1) != hash);
	LightSnapshot light = scene.lights[0];
	light.name = "Sun";
	const auto of_sun = scene.select_casters(light);
	REQUIRE(of_sun);
	CHECK_FALSE(of_sun->instances[0].casts_shadow);
	light.name = "Moon";
	CHECK_FALSE(scene.select_casters(light));
}
