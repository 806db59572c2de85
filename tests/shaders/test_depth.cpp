#include "modules/shadows/camera_view.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

TEST_CASE("[GPU][Shaders] a stored depth gives back the position that was drawn, and the "
		  "receiver's offset of C++") {
	KernelFixture fixture;
	const glm::uvec2 size_px(640, 360);
	SceneSnapshot scene;
	scene.scene_size_m = 400;
	CameraSnapshot &camera = scene.camera;
	camera.position_world = { 1e5, -300, 7e4 }; // must not matter: all is relative to the camera
	camera.vertical_fov_rad = 0.7f;
	camera.near_m = 0.05f;
	camera.world_from_camera =
			glm::dmat3(glm::mat3_cast(glm::normalize(glm::dquat(0.8, 0.3, -0.4, 0.2))));
	const double tangent = std::tan(0.5 * double(camera.vertical_fov_rad));
	const double aspect = double(size_px.x) / size_px.y;

	TestRandom random;
	std::vector<glm::vec4> pixels;
	std::vector<glm::dvec3> positions;
	for (int index = 0; index < 4000; ++index) {
		const glm::dvec2 pixel =
				glm::floor(glm::dvec2(random.next(), random.next()) * glm::dvec2(size_px));
		const double requested_m = std::pow(10.0, random.next(-1.2, 4)); // 6 cm .. 10 km
		const float depth = static_cast<float>(double(camera.near_m) / requested_m);
		pixels.push_back(glm::vec4(glm::vec2(pixel), depth, 0.0f));
		// The camera looks along -Z; rows go down. Not requested_m, since `depth` is rounded.
		const double z_m = double(camera.near_m) / double(depth);
		const glm::dvec2 ndc = 2.0 * (pixel + 0.5) / glm::dvec2(size_px) - 1.0;
		positions.push_back(camera.world_from_camera *
				(z_m * glm::dvec3(ndc.x * tangent * aspect, -ndc.y * tangent, -1)));
	}
	const shader::FrameConstants frame = compute_frame_constants(scene, size_px);
	const std::vector<glm::vec4> results =
			fixture.run_with_constants("depth.comp", frame, pixels, pixels.size(), 1);
	double largest_error = 0; // relative to the distance
	double largest_miss_px = 0;
	double largest_depth_error = 0;
	double largest_offset_error = 0;
	for (size_t index = 0; index < pixels.size(); ++index) {
		const glm::dvec3 found(results[index]);
		const float offset_m = compute_receiver_offset_m(frame, camera.near_m / pixels[index].z);
		largest_offset_error =
				std::max(largest_offset_error, std::abs(double(results[index].w) / offset_m - 1));
		largest_error = std::max(largest_error,
				glm::distance(found, positions[index]) / glm::length(positions[index]));
		// The rasteriser's matrix must project it back to the same pixel and depth.
		const glm::dvec4 clip =
				glm::dmat4(frame.clip_from_camera_relative) * glm::dvec4(found, 1.0);
		const glm::dvec2 pixel =
				(glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(size_px) - 0.5;
		largest_miss_px =
				std::max(largest_miss_px, glm::distance(pixel, glm::dvec2(pixels[index])));
		largest_depth_error = std::max(
				largest_depth_error, std::abs(clip.z / clip.w / double(pixels[index].z) - 1));
	}
	CHECK(largest_error < 1e-6); // several roundings of float32, 6e-8 each
	CHECK(largest_miss_px < 2e-3);
	CHECK(largest_depth_error < 1e-6);
	CHECK(largest_offset_error < 1e-6);
}
