// Loads a scene that was exported by Blender 3.4 (binary form, with "Custom Properties", "Punctual
// Lights" and "Cameras" enabled): Suzanne and a torus over a plane, one light of each type. The
// light sizes are custom properties of the light data of Key and Sun and of the object Fill.

#include "modules/core/files.h"
#include "modules/gltf_scene/tests/gltf_test_files.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

// Relative to the root of the repository, in which tests run.
const char FILE_NAME[] = "modules/gltf_scene/tests/blender_3_4.glb";

double get_number(const Light3D &p_light, const char *p_name) {
	return get_float(Light3D::get_property_list(), p_light.properties, p_name);
}

} // namespace

TEST_CASE("[GltfScene] light sizes, cameras and meshes of a Blender export are read") {
	const std::unique_ptr<Scene> scene = load_gltf(FILE_NAME);
	CHECK(scene->find_nodes<MeshInstance3D>().size() == 3);
	const Light3D &key = scene->find_node<Light3D>("Key", "Light");
	CHECK(key.type == LightType::SPOT);
	CHECK(key.outer_cone_rad == doctest::Approx(0.7));
	CHECK(key.intensity == doctest::Approx(54351.4)); // cd: 1000 W * 683 lm/W / (4 pi sr)
	CHECK(get_number(key, "light_size") == doctest::Approx(0.35));
	// The file names a technique of another module. This module may not use that name (rule of
	// tests/layers), so only its length is compared.
	CHECK(std::get<std::string>(key.properties.at("shadow_technique")).size() == 5);
	const Light3D &fill = scene->find_node<Light3D>("Fill", "Light");
	CHECK(fill.type == LightType::OMNI);
	CHECK(get_number(fill, "light_size") == doctest::Approx(0.2));
	const Light3D &sun = scene->find_node<Light3D>("Sun", "Light");
	CHECK(sun.type == LightType::DIRECTIONAL);
	CHECK(get_number(sun, "light_angular_distance") == doctest::Approx(3.0));
	const Camera3D &camera = scene->find_node<Camera3D>("Cam", "Camera");
	const glm::dvec3 position = glm::dvec3(camera.compute_world_from_node()[3]);
	// Blender's position (4, -5, 3.5) with z up is (4, 3.5, 5) with y up.
	CHECK(glm::distance(position, glm::dvec3(4.0, 3.5, 5.0)) < 1e-5);
}
