#include "modules/error_report/scaling_scenes.h"
#include "modules/mesh_tools/topology.h"
#include "modules/scene/scene_snapshot.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <set>

using namespace gnomon;

namespace {

std::shared_ptr<const SceneSnapshot> build(const Scene &p_scene) {
	return build_snapshot(p_scene, *p_scene.find_nodes<Camera3D>().at(0));
}

uint32_t count_triangles(const SceneSnapshot &p_scene) {
	uint32_t count = 0;
	for (const InstanceSnapshot &instance : p_scene.instances) {
		count += instance.mesh->get_triangle_count();
	}
	return count;
}

/// Returns the distance of a point from a line. p_direction: unit.
double compute_line_distance(
		const glm::dvec3 &p_origin, const glm::dvec3 &p_direction, const glm::dvec3 &p_point) {
	return glm::length(glm::cross(p_point - p_origin, p_direction));
}

// Target of the light in the benchmark scene torus_knot.
const glm::dvec3 LIGHT_TARGET(0, 0.4, 0);
const double TOLERANCE_M = 1e-9; // tolerance of positions computed in double, metres

} // namespace

TEST_CASE("[ErrorReport] the scaling scene has the requested number of triangles within 2 %") {
	for (const uint32_t requested : { 1000u, 1234u, 2000u, 3000u, 5000u, 8000u, 12345u, 30000u,
				 77777u, 120000u, 500000u, 1000000u }) {
		CAPTURE(requested);
		ScalingScene description;
		description.triangle_count = requested;
		const uint32_t found = count_triangles(*build(*make_scaling_scene(description)));
		CHECK(std::abs(double(found) - requested) <= 0.02 * requested);
	}
}

TEST_CASE("[ErrorReport] with 30000 triangles the knot has 500 x 30 quads, as in the benchmarks") {
	const auto scene = build(*make_scaling_scene({}));
	REQUIRE(scene->instances.size() == 2);
	CHECK(scene->instances[0].mesh->name == "knot");
	CHECK(scene->instances[0].mesh->positions_node.size() == 500 * 30);
	CHECK(scene->instances[0].mesh->get_triangle_count() == 2 * 500 * 30);
	CHECK(scene->instances[1].mesh->name == "ground");
	CHECK(scene->instances[1].mesh->get_triangle_count() == 12);
}

TEST_CASE("[ErrorReport] meshes of the scaling scene are closed and face outwards") {
	for (const uint32_t requested : { 1000u, 2000u, 30000u, 120000u }) {
		CAPTURE(requested);
		ScalingScene description;
		description.triangle_count = requested;
		const auto scene = build(*make_scaling_scene(description));
		for (const InstanceSnapshot &instance : scene->instances) {
			CAPTURE(instance.mesh->name);
			CHECK(instance.casts_shadow);
			const MeshTopology topology = build_topology(*instance.mesh);
			CHECK(topology.mesh_class == MeshClass::CLOSED);
			CHECK(topology.counts.degenerate_triangle_count == 0);
			CHECK(topology.counts.zero_area_triangle_count == 0);
			CHECK(topology.signed_volume_m3 > 0.1); // negative if faces point inwards
		}
	}
}

TEST_CASE("[ErrorReport] the knot's tube has a radius of 0.16 m, and the ground's top is at 0") {
	const auto scene = build(*make_scaling_scene({ .triangle_count = 2000 }));
	std::vector<glm::dvec3> line; // a point every 3 mm
	for (int step = 0; step < 4000; ++step) {
		const double t = 2 * std::numbers::pi * step / 4000;
		const double ring = 2 + std::cos(3 * t);
		line.push_back(glm::dvec3(0, 1.4, 0) +
				0.36 *
						glm::dvec3(
								ring * std::cos(2 * t), -std::sin(3 * t), ring * std::sin(2 * t)));
	}
	double max_distance = 0;
	double min_distance = 1e9;
	double min_cosine = 1;
	const Mesh &knot = *scene->instances[0].mesh;
	for (size_t index = 0; index < knot.positions_node.size(); ++index) {
		glm::dvec3 direction(1e9);
		for (const glm::dvec3 &point : line) {
			const glm::dvec3 other = glm::dvec3(knot.positions_node[index]) - point;
			direction = glm::length(other) < glm::length(direction) ? other : direction;
		}
		max_distance = std::max(max_distance, glm::length(direction));
		min_distance = std::min(min_distance, glm::length(direction));
		const glm::dvec3 normal = knot.normals_node[index];
		min_cosine = std::min(min_cosine, glm::dot(normal, glm::normalize(direction)));
	}
	CHECK(min_cosine > 0.9); // vertex normals, computed from the faces, point outwards
	CHECK(min_distance > 0.1599);
	CHECK(max_distance < 0.1601);
	const Bounds &ground = scene->instances[1].bounds_world;
	CHECK(glm::length(ground.minimum - glm::dvec3(-4.2, -0.4, -4.2)) < 1e-6);
	CHECK(glm::length(ground.maximum - glm::dvec3(4.2, 0, 4.2)) < 1e-6);
}

TEST_CASE("[ErrorReport] the scaling scene has the light, camera and S of the benchmark scene") {
	const auto scene = build(*make_scaling_scene({ .triangle_count = 2000, .light_size_m = 0.08 }));
	CHECK(scene->scene_size_m == 4);
	REQUIRE(scene->lights.size() == 1);
	const LightSnapshot &light = scene->lights[0];
	CHECK(light.name == "Light 1");
	CHECK(light.type == LightType::SPOT);
	CHECK(light.light_size_m == 0.08f);
	CHECK(light.casts_shadow);
	CHECK(light.range_m == 0);
	const glm::dvec3 position(1.8, 6, 1.2);
	CHECK(glm::length(light.position_world - position) < TOLERANCE_M);
	CHECK(glm::length(light.get_direction_world() - glm::normalize(LIGHT_TARGET - position)) <
			TOLERANCE_M);
	CHECK(std::tan(light.outer_cone_rad) == doctest::Approx(0.95));

	const CameraSnapshot &camera = scene->camera;
	CHECK(camera.name == "Camera");
	const glm::dvec3 camera_position(-3.2, 4.6, 4.6);
	CHECK(glm::length(camera.position_world - camera_position) < TOLERANCE_M);
	const glm::dvec3 direction = glm::normalize(glm::dvec3(-0.3, 0.45, -0.2) - camera_position);
	CHECK(glm::length(-camera.world_from_camera[2] - direction) < TOLERANCE_M);
	CHECK(camera.world_from_camera[0].y == doctest::Approx(0)); // upright
	CHECK(camera.world_from_camera[1].y > 0);
	CHECK(glm::degrees(camera.vertical_fov_rad) == doctest::Approx(36.87).epsilon(1e-5));
}

TEST_CASE("[ErrorReport] several lights have different names and positions and a common target") {
	for (const uint32_t count : { 2u, 4u, 64u, 1024u }) {
		CAPTURE(count);
		const auto scene =
				build(*make_scaling_scene({ .triangle_count = 1000, .light_count = count }));
		REQUIRE(scene->lights.size() == count);
		std::set<std::pair<long, long>> positions; // in millimetres
		float intensity = 0;
		for (uint32_t index = 0; index < count; ++index) {
			const LightSnapshot &light = scene->lights[index];
			CHECK(light.name == "Light " + std::to_string(index + 1));
			CHECK(light.type == LightType::SPOT);
			CHECK(light.light_size_m == 0.4f);
			CHECK(light.casts_shadow);
			const glm::dvec3 direction = light.get_direction_world();
			CHECK(compute_line_distance(light.position_world, direction, LIGHT_TARGET) <
					TOLERANCE_M);
			CHECK(glm::dot(LIGHT_TARGET - light.position_world, direction) > 0);
			CHECK(light.position_world.y == doctest::Approx(6));
			CHECK(std::hypot(light.position_world.x, light.position_world.z) ==
					doctest::Approx(std::hypot(1.8, 1.2)));
			positions.insert({ std::lround(light.position_world.x * 1000),
					std::lround(light.position_world.z * 1000) });
			intensity += light.intensity;
		}
		CHECK(positions.size() == count);
		CHECK(intensity == doctest::Approx(500)); // independent of the number of lights
		CHECK(glm::length(scene->lights[0].position_world - glm::dvec3(1.8, 6, 1.2)) < TOLERANCE_M);
	}
}
