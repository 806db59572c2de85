#include "modules/editor/orbit_camera.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

using namespace gnomon;

namespace {

std::unique_ptr<Camera3D> make_camera(const OrbitCamera &p_orbit) {
	auto camera = std::make_unique<Camera3D>();
	p_orbit.apply(*camera);
	return camera;
}

glm::dvec3 get_position(const OrbitCamera &p_orbit) {
	return glm::dvec3(make_camera(p_orbit)->parent_from_node[3]);
}

} // namespace

TEST_CASE("[OrbitCamera] it takes over a scene camera's view, and orbits the point it looks at") {
	const glm::dvec3 from(3, 4, -5);
	const glm::dvec3 to(0.5, 1, 0.25);
	Camera3D start;
	start.parent_from_node = glm::inverse(glm::lookAt(from, to, glm::dvec3(0, 1, 0)));
	start.vertical_fov_rad = 0.5f;
	OrbitCamera orbit;
	orbit.move_to_camera(start, glm::length(to - from));
	const glm::dmat4 transform = make_camera(orbit)->parent_from_node;
	for (int column = 0; column < 4; ++column) {
		CHECK(glm::length(transform[column] - start.parent_from_node[column]) < 1e-9);
	}
	CHECK(make_camera(orbit)->vertical_fov_rad == 0.5f);
	orbit.orbit(0.7, -9.0); // the pitch is clamped
	CHECK(glm::length(get_position(orbit) - to) == doctest::Approx(glm::length(to - from)));
	CHECK(make_camera(orbit)->parent_from_node[1].y > 0.0);
	orbit.zoom(0.5);
	CHECK(glm::length(get_position(orbit) - to) == doctest::Approx(0.5 * glm::length(to - from)));
}

TEST_CASE("[OrbitCamera] rotating preserves its position, moving and panning its direction") {
	OrbitCamera orbit;
	orbit.orbit(0.4, -0.3);
	const glm::dvec3 position = get_position(orbit);
	orbit.rotate_in_place(0.5, 0.2);
	CHECK(glm::length(get_position(orbit) - position) < 1e-12);
	const glm::dmat4 before = make_camera(orbit)->parent_from_node;
	orbit.move({ 1, 2, 3 });
	orbit.pan({ 0.25, -0.5 });
	const glm::dmat4 after = make_camera(orbit)->parent_from_node;
	CHECK(glm::length(after[2] - before[2]) < 1e-12);
	CHECK(glm::length(after[3] - before[3]) > 1.0);
}

TEST_CASE("[OrbitCamera] framed bounds are inside the view; empty bounds change nothing") {
	OrbitCamera orbit;
	const uint64_t revision = orbit.get_revision();
	orbit.frame({});
	CHECK(orbit.get_revision() == revision);
	for (const double size : { 1e-3, 1.0, 1e3 }) {
		Bounds bounds;
		bounds.add(glm::dvec3(5, 6, 7));
		bounds.add(glm::dvec3(5, 6, 7) + size * glm::dvec3(1, 0.5, 2));
		orbit.frame(bounds);
		const std::unique_ptr<Camera3D> camera = make_camera(orbit);
		const glm::dmat4 camera_from_world = glm::inverse(camera->parent_from_node);
		for (const glm::dvec3 &corner : { bounds.minimum, bounds.maximum }) {
			const glm::dvec3 seen(camera_from_world * glm::dvec4(corner, 1.0));
			CHECK(-seen.z > camera->near_m);
			CHECK(std::abs(seen.x / seen.z) < std::tan(0.5 * double(camera->vertical_fov_rad)));
			CHECK(std::abs(seen.y / seen.z) < std::tan(0.5 * double(camera->vertical_fov_rad)));
		}
	}
}
