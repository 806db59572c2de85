#include "modules/shadows/camera_view.h"
#include "modules/shadows/tests/mask_fixture.h"
#include "modules/shadows/visible_receivers.h"

#include <doctest/doctest.h>

#include <random>

using namespace gnomon;

namespace {

using Random = std::mt19937;

double random_value(Random &r_random, double p_min, double p_max) {
	return std::uniform_real_distribution<double>(p_min, p_max)(r_random);
}

glm::dvec3 random_point(Random &r_random, double p_reach) {
	return { random_value(r_random, -p_reach, p_reach), random_value(r_random, -p_reach, p_reach),
		random_value(r_random, -p_reach, p_reach) };
}

bool is_in(const Bounds &p_bounds, const glm::dvec3 &p_point) {
	return glm::all(glm::greaterThanEqual(p_point, p_bounds.minimum)) &&
			glm::all(glm::lessThanEqual(p_point, p_bounds.maximum));
}

/// For a square image.
bool is_seen(const CameraSnapshot &p_camera, const glm::dvec3 &p_point) {
	const glm::dvec3 position =
			glm::transpose(p_camera.world_from_camera) * (p_point - p_camera.position_world);
	const double reach = std::tan(0.5 * p_camera.vertical_fov_rad) * -position.z;
	return position.z < 0 && std::abs(position.x) <= reach && std::abs(position.y) <= reach;
}

/// Whether receivers.comp would mark a point that faces the light as a receiver.
bool is_lit(const LightSnapshot &p_light, const glm::dvec3 &p_point) {
	const glm::dvec3 to_point = p_point - p_light.position_world;
	const double distance = glm::length(to_point);
	return (p_light.range_m <= 0 || distance <= p_light.range_m) &&
			(p_light.type != LightType::SPOT ||
					glm::dot(to_point, p_light.get_direction_world()) >=
							std::cos(double(p_light.outer_cone_rad)) * distance);
}

SceneSnapshot make_random_scene(Random &r_random) {
	SceneSnapshot scene;
	scene.scene_size_m = 4;
	scene.camera.position_world = random_point(r_random, 3);
	scene.camera.world_from_camera =
			glm::dmat3(look_at(glm::dvec3(0.0), random_point(r_random, 1)));
	scene.camera.vertical_fov_rad = static_cast<float>(random_value(r_random, 0.1, 2.5));
	InstanceSnapshot instance;
	const glm::dvec3 centre = random_point(r_random, 3);
	const glm::dvec3 half = glm::abs(random_point(r_random, 2));
	instance.bounds_world.add(centre - half);
	instance.bounds_world.add(centre + half);
	scene.instances.push_back(instance);
	return scene;
}

LightSnapshot make_random_light(Random &r_random) {
	LightSnapshot light;
	light.type = random_value(r_random, 0, 1) < 0.5 ? LightType::SPOT : LightType::OMNI;
	light.position_world = random_point(r_random, 4);
	light.world_from_light = glm::dmat3(look_at(glm::dvec3(0.0), random_point(r_random, 1)));
	light.range_m =
			random_value(r_random, 0, 1) < 0.3 ? 0.0f : float(random_value(r_random, 0.2, 6.0));
	light.outer_cone_rad = static_cast<float>(random_value(r_random, 0.02, 1.57));
	return light;
}

} // namespace

TEST_CASE("[VisibleReceivers] visible bounds contain the visible points of a box and are often "
		  "smaller") {
	Random random(3);
	size_t seen_count = 0;
	size_t smaller_count = 0;
	for (int round = 0; round < 1000; ++round) {
		CAPTURE(round);
		const SceneSnapshot scene = make_random_scene(random);
		const VisibleReceivers receivers =
				find_visible_receivers(scene, make_camera_view(scene.camera, glm::uvec2(64)));
		const Bounds &box = scene.instances[0].bounds_world;
		bool is_any_seen = false;
		for (int index = 0; index < 300; ++index) {
			const glm::dvec3 point = glm::mix(box.minimum, box.maximum,
					glm::dvec3(random_value(random, 0, 1), random_value(random, 0, 1),
							random_value(random, 0, 1)));
			if (is_seen(scene.camera, point)) {
				is_any_seen = true;
				REQUIRE(receivers.list.size() == 1);
				CHECK(is_in(receivers.list[0].bounds_world, point));
				CHECK(is_in(receivers.bounds_world, point));
			}
		}
		seen_count += is_any_seen;
		smaller_count += receivers.list.empty() ||
				receivers.list[0].bounds_world.get_diagonal() < 0.9 * box.get_diagonal();
	}
	CHECK(seen_count > 300);	// of 1000 boxes
	CHECK(smaller_count > 300); // returning the whole box would also pass the checks above
}

TEST_CASE("[VisibleReceivers] may_light_reach is false only for boxes of which no point is lit") {
	Random random(5);
	size_t lit_count = 0;
	size_t missed_count = 0;
	for (int round = 0; round < 3000; ++round) {
		CAPTURE(round);
		const LightSnapshot light = make_random_light(random);
		Bounds box;
		box.add(random_point(random, 3));
		box.add(box.minimum + glm::abs(random_point(random, 2)));
		bool is_any_lit = false;
		for (int index = 0; index < 200 && !is_any_lit; ++index) {
			is_any_lit = is_lit(light,
					glm::mix(box.minimum, box.maximum,
							glm::dvec3(random_value(random, 0, 1), random_value(random, 0, 1),
									random_value(random, 0, 1))));
		}
		lit_count += is_any_lit;
		missed_count += !may_light_reach(light, box);
		CHECK((may_light_reach(light, box) || !is_any_lit));
	}
	CHECK(lit_count > 1000); // of 3000: both results are frequent
	CHECK(missed_count > 1000);
}

TEST_CASE("[VisibleReceivers] may_light_reach is true for a box that touches the light's range or "
		  "cone") {
	LightSnapshot light;
	light.range_m = 2.0f;
	Bounds box;
	box.add(glm::dvec3(2.0, -1, -1));
	box.add(glm::dvec3(3.0, 1, 1));
	CHECK(may_light_reach(light, box));
	light.range_m = 1.99f;
	CHECK_FALSE(may_light_reach(light, box));
	light.type = LightType::SPOT; // shines along -Z; its cone just touches the next box's side
	light.range_m = 0;
	light.outer_cone_rad = 0.785398163f; // 45 degrees
	Bounds neighbour;
	neighbour.add(glm::dvec3(1, -0.5, -1));
	neighbour.add(glm::dvec3(2, 0.5, 0.5));
	CHECK(may_light_reach(light, neighbour));
	neighbour.minimum.x = 1.01;
	CHECK_FALSE(may_light_reach(light, neighbour));
	light.type = LightType::DIRECTIONAL;
	CHECK(may_light_reach(light, neighbour));
}
