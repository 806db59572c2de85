// How far receivers are moved off their surfaces: compute_receiver_offset_m in frame_shared.h.

#include "modules/shadows/camera_view.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

float compute_offset_m(const SmallScene &p_scene, glm::uvec2 p_size_px, double p_distance_m) {
	return compute_receiver_offset_m(
			compute_frame_constants(*p_scene.snap(), p_size_px), float(p_distance_m));
}

/// A scene of that size, with casters as far apart.
SmallScene make_scene(double p_size_m) {
	SmallScene scene;
	scene.scene.scene_size_m = p_size_m;
	const double side_m = 0.5 * p_size_m / std::sqrt(3.0);
	for (const double side : { -side_m, side_m }) {
		add_mesh(
				scene.scene, "Corner", make_box_mesh("corner", glm::vec3(0.01f)), glm::dvec3(side));
	}
	return scene;
}

} // namespace

TEST_CASE("[ReceiverOffset] in a scene of few metres it is the same share of S everywhere") {
	const SmallScene scene;
	for (const uint32_t size_px : { 64u, 256u, 400u, 512u }) {
		for (const double distance_m : { 3.0, 5.0, 9.0 }) {
			CHECK(compute_offset_m(scene, glm::uvec2(size_px), distance_m) ==
					doctest::Approx(5e-5 * 4.0));
		}
	}
}

TEST_CASE("[ReceiverOffset] in a world of 2 km it is millimetres near the camera") {
	const SmallScene scene = make_scene(2000.0);
	const glm::uvec2 size_px(640, 360);
	const double tangent = std::tan(0.5 * scene.snap()->camera.vertical_fov_rad);
	for (const double distance_m : { 0.0, 1.0, 10.0, 100.0 }) {
		CAPTURE(distance_m);
		const double pixel_m = 2 * distance_m * tangent / size_px.y;
		const double offset_m = compute_offset_m(scene, size_px, distance_m);
		CHECK(offset_m < 0.0023 + 0.07 * pixel_m);
		CHECK(offset_m > 8e-7 * 2000.0);  // many rounding errors of a position
		CHECK(offset_m > pixel_m / 64.0); // several of the rasteriser's subpixels
	}
	CHECK(compute_offset_m(scene, size_px, 2000.0) == doctest::Approx(5e-5 * 2000.0));
}

TEST_CASE("[ReceiverOffset] it follows the size of the mask and the camera's angle") {
	SmallScene scene = make_scene(2000.0);
	const auto compute_share_m = [&](glm::uvec2 p_size_px) {
		return compute_offset_m(scene, p_size_px, 50.0) - compute_offset_m(scene, p_size_px, 0.0);
	};
	const double whole_m = compute_share_m({ 640, 360 });
	CHECK(compute_share_m({ 320, 180 }) == doctest::Approx(2 * whole_m).epsilon(0.01));
	CHECK(compute_share_m({ 321, 360 }) == doctest::Approx(whole_m).epsilon(0.01)); // cropped
	const double tangent = std::tan(0.5 * double(scene.camera->vertical_fov_rad));
	scene.camera->vertical_fov_rad = float(2 * std::atan(0.1 * tangent));
	CHECK(compute_share_m({ 640, 360 }) == doctest::Approx(0.1 * whole_m).epsilon(0.1));
	scene.camera->vertical_fov_rad = 1e-4f; // almost parallel rays: rounding remains
	CHECK(compute_share_m({ 640, 360 }) > 0.5 * 50e-6);
}

TEST_CASE("[ReceiverOffset] a scaled scene has a scaled offset") {
	for (const double size_m : { 4.0, 2000.0 }) {
		for (const double distance_m : { 0.0, 0.5, 20.0, 400.0 }) {
			const auto compute = [&](double p_scale) {
				SmallScene scene(LightType::SPOT, p_scale);
				scene.scene.scene_size_m = size_m * p_scale;
				return compute_offset_m(scene, { 640, 360 }, distance_m * p_scale) / p_scale;
			};
			CHECK(compute(1e-3) == doctest::Approx(compute(1.0)).epsilon(1e-4));
			CHECK(compute(1e3) == doctest::Approx(compute(1.0)).epsilon(1e-4));
		}
	}
}

TEST_CASE("[ReceiverOffset] casters beyond S count as well, since positions are as large as they") {
	SmallScene scene;
	const double near_m = compute_offset_m(scene, { 640, 360 }, 0.0);
	add_mesh(scene.scene, "Far", make_box_mesh("far", glm::vec3(0.1f)), { 100, 0, 0 });
	const double far_m = compute_offset_m(scene, { 640, 360 }, 0.0);
	CHECK(near_m < 1.5e-5);
	CHECK(far_m == doctest::Approx(1e-4).epsilon(0.1));
	add_mesh(scene.scene, "Farther", make_box_mesh("far", glm::vec3(0.1f)), { 1e4, 0, 0 });
	CHECK(compute_offset_m(scene, { 640, 360 }, 0.0) == doctest::Approx(5e-5 * 4.0));
}
