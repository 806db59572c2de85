#include "modules/core/error.h"
#include "modules/scene/box_mesh.h"
#include "modules/scene/node_properties.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/scene/stage.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

using namespace gnomon;

namespace {

template <typename T> T &add_to_scene(Scene &r_scene, const std::string &p_name) {
	auto node = std::make_unique<T>();
	node->name = p_name;
	return static_cast<T &>(*r_scene.root->add_child(std::move(node)));
}

/// Makes a scene of one box of 2 x 4 x 1 m, scaled, without camera and light. The box has the name
/// that the staged light would get.
std::unique_ptr<Scene> make_model(
		double p_scale = 1.0, const glm::dvec3 &p_position = glm::dvec3(0.0)) {
	auto scene = std::make_unique<Scene>();
	MeshInstance3D &box = add_to_scene<MeshInstance3D>(*scene, "Stage light");
	box.surfaces.push_back(
			{ make_box_mesh("box", glm::vec3(1, 2, 0.5f)), std::make_shared<Material>() });
	box.parent_from_node =
			glm::scale(glm::translate(glm::dmat4(1.0), p_position), glm::dvec3(p_scale));
	return scene;
}

/// Transforms a point to the camera's space: x right, y up, looking along -z.
glm::dvec3 transform_to_camera(const SceneSnapshot &p_snapshot, const glm::dvec3 &p_point) {
	return glm::transpose(p_snapshot.camera.world_from_camera) *
			(p_point - p_snapshot.camera.position_world);
}

/// Checks that a point in the camera's space is visible in a square image.
void check_is_visible(const glm::dvec3 &p_point_camera, const Camera3D &p_camera) {
	const double reach = -p_point_camera.z * std::tan(p_camera.vertical_fov_rad / 2);
	CHECK(std::abs(p_point_camera.x) < reach);
	CHECK(std::abs(p_point_camera.y) < reach);
}

/// Checks that the shadow that p_caster casts on the ground is visible.
void check_shadow_is_visible(const SceneSnapshot &p_snapshot, const Camera3D &p_camera,
		const glm::dvec3 &p_caster, double p_ground_y) {
	const glm::dvec3 light = p_snapshot.lights[0].position_world;
	const glm::dvec3 ray = p_caster - light;
	check_is_visible(
			transform_to_camera(p_snapshot, light + ray * ((p_ground_y - light.y) / ray.y)),
			p_camera);
}

} // namespace

TEST_CASE("[Stage] a model alone gets a light, a ground and a camera that sees all of the model") {
	for (const double scale : { 1.0, 1e-3, 1e5 }) {
		CAPTURE(scale);
		const auto scene = make_model(scale, glm::dvec3(7, 3, -2) * scale);
		CHECK(stage_scene(*scene, StageMode::AUTO) ==
				"Staged: a camera, a spot light and a ground were added. The file stays as it is.");
		REQUIRE(scene->find_nodes<Camera3D>().size() == 1);
		REQUIRE(scene->find_nodes<Light3D>().size() == 1);
		REQUIRE(scene->find_nodes<MeshInstance3D>().size() == 2);
		const Camera3D &camera = *scene->find_nodes<Camera3D>()[0];
		const Light3D &light = *scene->find_nodes<Light3D>()[0];
		CHECK(camera.is_staged);
		CHECK(light.name == "Stage light_2"); // that name was taken
		const auto snapshot = build_snapshot(*scene, camera);
		const double size_m = 2 * std::sqrt(1 + 4 + 0.25) * scale;
		CHECK(snapshot->scene_size_m == doctest::Approx(size_m)); // the ground is no caster
		CHECK(snapshot->lights[0].light_size_m == doctest::Approx(std::min(0.1 * size_m, 10000.0)));
		const double bottom_y = scale * (3 - 2); // of the model: its position minus half its height
		for (const InstanceSnapshot &instance : snapshot->instances) {
			if (!instance.casts_shadow) {
				// The ground is just below the model.
				CHECK(instance.bounds_world.maximum.y < bottom_y);
				CHECK(instance.bounds_world.maximum.y > bottom_y - 0.01 * size_m);
				continue;
			}
			for (int corner = 0; corner < 8; ++corner) {
				const glm::dvec3 point_camera =
						transform_to_camera(*snapshot, instance.bounds_world.get_corner(corner));
				check_is_visible(point_camera, camera);
				CHECK(-point_camera.z > camera.near_m);
				check_shadow_is_visible(
						*snapshot, camera, instance.bounds_world.get_corner(corner), bottom_y);
				// Within the light's cone, and at least 1.5 diagonals of the model from the light.
				const glm::dvec3 to_corner = instance.bounds_world.get_corner(corner) -
						snapshot->lights[0].position_world;
				CHECK(glm::dot(glm::normalize(to_corner),
							  snapshot->lights[0].get_direction_world()) >
						std::cos(light.inner_cone_rad));
				CHECK(glm::length(to_corner) > 1.5 * size_m);
			}
		}
	}
}

TEST_CASE("[Stage] the camera fills the image with the model and its shadow") {
	for (int index = 0; index < 9; ++index) {
		const glm::vec3 halves[] = { glm::vec3(1, 3, 0.2f), glm::vec3(4, 0.1f, 1), glm::vec3(1) };
		const glm::vec3 half = halves[index % 3];
		const double aspect = std::array{ 1.0, 0.4, 2.0 }[index / 3];
		CAPTURE(half.x);
		CAPTURE(aspect);
		Scene scene;
		add_to_scene<MeshInstance3D>(scene, "Model")
				.surfaces.push_back({ make_box_mesh("box", half), std::make_shared<Material>() });
		stage_scene(scene, StageMode::AUTO, aspect);
		const Camera3D &camera = *scene.find_nodes<Camera3D>()[0];
		const auto snapshot = build_snapshot(scene, camera);
		const glm::dvec3 light = snapshot->lights[0].position_world;
		glm::dvec2 lower(1), upper(-1);
		// The 8 corners of the box, then the shadow of each on the ground.
		for (int corner = 0; corner < 16; ++corner) {
			glm::dvec3 point = (corner & 1 ? 1.0 : -1.0) * glm::dvec3(half.x, 0, 0) +
					(corner & 2 ? 1.0 : -1.0) * glm::dvec3(0, half.y, 0) +
					(corner & 4 ? 1.0 : -1.0) * glm::dvec3(0, 0, half.z);
			if (corner & 8) {
				const glm::dvec3 ray = point - light;
				point = light + ray * ((-half.y - light.y) / ray.y);
			}
			const glm::dvec3 point_camera = transform_to_camera(*snapshot, point);
			const glm::dvec2 position = glm::dvec2(point_camera) /
					(-point_camera.z * std::tan(camera.vertical_fov_rad / 2)) /
					glm::dvec2(std::min(aspect, 1.0), 1.0);
			lower = glm::min(lower, position);
			upper = glm::max(upper, position);
		}
		// 2 would fill the image, or its central square; CAMERA_MARGIN makes it 2 / 1.12 = 1.79.
		const glm::dvec2 extent = upper - lower;
		CHECK(std::max(extent.x, extent.y) > 1.7);
		CHECK(std::max(extent.x, extent.y) < 1.9);
		// Centred, except for the asymmetry of perspective.
		CHECK(std::abs(lower.x + upper.x) < 0.3);
		CHECK(std::abs(lower.y + upper.y) < 0.3);
	}
}

TEST_CASE("[Stage] AUTO adds only what a file lacks, ON adds everything") {
	const auto scene = make_model();
	add_to_scene<Camera3D>(*scene, "Eye");
	add_to_scene<Light3D>(*scene, "Lamp");
	CHECK(stage_scene(*scene, StageMode::AUTO) == "");
	CHECK(stage_scene(*scene, StageMode::OFF) == "");
	CHECK(scene->find_nodes<Node3D>().size() == 4);
	CHECK(stage_scene(*scene, StageMode::ON).find("a camera, a spot light and a ground") !=
			std::string::npos);
	CHECK(scene->find_nodes<Camera3D>()[0]->is_staged); // first, so that it is the one that is used
	CHECK(scene->find_nodes<Light3D>()[0]->is_staged);

	const auto lit = make_model();
	add_to_scene<Light3D>(*lit, "Lamp");
	CHECK(stage_scene(*lit, StageMode::AUTO).starts_with("Staged: a camera was added."));
	CHECK(lit->find_nodes<Light3D>().size() == 1);
	CHECK(lit->find_nodes<MeshInstance3D>().size() == 1);
	Scene nothing;
	CHECK(stage_scene(nothing, StageMode::ON) == "");
}

TEST_CASE("[Stage] only staged nodes have the property staged, which can be cleared") {
	const auto scene = make_model();
	stage_scene(*scene, StageMode::AUTO);
	Node3D &light = *scene->find_nodes<Light3D>()[0];
	CHECK(list_node_properties(light).find("staged"));
	CHECK_FALSE(list_node_properties(*scene->find_nodes<MeshInstance3D>().back()).find("staged"));
	set_node_property(light, "staged", false);
	CHECK_FALSE(light.is_staged);
	for (const StageMode mode : { StageMode::AUTO, StageMode::ON, StageMode::OFF }) {
		CHECK(parse_stage_mode(get_stage_mode_name(mode), "--stage") == mode);
	}
	CHECK_THROWS_WITH_AS(parse_stage_mode("maybe", "--stage"),
			"--stage is \"maybe\", must be auto, on or off.", Error);
}
