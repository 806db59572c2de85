#include "modules/receiver_scatter/dipole_spread.h"
#include "modules/receiver_scatter/tests/scatter_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace gnomon;

namespace {

/// A half plane whose hard shadow falls straight down on a translucent ground, with its edge at
/// x = 0 and the lit side at x > 0. The ground fills the image of a camera that looks straight down
/// from a height of 4 m, below the half plane.
struct EdgeScene : SmallScene {
	EdgeScene(float p_scatter, float p_distance_m) : SmallScene(LightType::DIRECTIONAL) {
		ground->surfaces[0].material = make_translucent_material(p_scatter, p_distance_m);
		box->surfaces[0].mesh = make_box_mesh("half plane", glm::vec3(3.0f, 0.01f, 3.0f));
		box->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(-3.0, 8.0, 0.0));
		light->parent_from_node = look_at(glm::dvec3(0, 5, 0), glm::dvec3(0));
		light->properties["light_angular_distance"] = 0.0;
		const glm::dmat4 down = glm::rotate(glm::dmat4(1.0), glm::radians(-90.0), { 1, 0, 0 });
		camera->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 4, 0)) * down;
	}

	/// Returns the x coordinate on the ground that an image column shows: its distance from the
	/// edge, above 0 on the lit side.
	static float get_x_m(uint32_t p_column, uint32_t p_size_px) {
		const float fov_rad = 0.785398163f; // Camera3D's default
		const float half_m = 4.0f * std::tan(0.5f * fov_rad);
		return half_m * ((p_column + 0.5f) / p_size_px * 2.0f - 1.0f);
	}
	/// Returns a column's mean visibility over the middle half of the rows.
	static float compute_column_mean(const MaskResult &p_result, uint32_t p_column) {
		const uint32_t size_px =
				static_cast<uint32_t>(std::lround(std::sqrt(double(p_result.visibility.size()))));
		double sum = 0;
		for (uint32_t row = size_px / 4; row < 3 * size_px / 4; ++row) {
			sum += p_result.visibility[row * size_px + p_column];
		}
		return static_cast<float>(sum / (size_px / 2));
	}
};

/// Returns the visibility at a distance from a hard edge, in radii, after the spread: the fraction
/// of the light that entered on the lit side, where the distance is positive.
double compute_blurred_edge(double p_distance_radii) {
	const DipoleSpread spread;
	const int STEPS = 20000;
	double far_fraction = 0;
	for (int i = 0; i < STEPS; ++i) {
		const double distance = spread.compute_distance((i + 0.5f) / STEPS);
		// The part of the circle with this radius that is beyond the edge is acos(cosine) / pi.
		const double cosine = std::abs(p_distance_radii) / distance;
		far_fraction += cosine < 1 ? std::acos(cosine) / 3.14159265358979 / STEPS : 0;
	}
	return p_distance_radii > 0 ? 1 - far_fraction : far_fraction;
}

} // namespace

TEST_CASE("[GPU][ReceiverScatter] in metres, a sharp edge is blurred as the dipole predicts") {
	MaskFixture fixture;
	EdgeScene scene(0.5f, 1.0f); // a radius of half a metre
	const MaskResult result = fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(128));
	CHECK(is_valid_mask(result));
	double error = 0;
	double max_difference = 0;
	for (uint32_t column = 0; column < 128; ++column) {
		const double x_m = EdgeScene::get_x_m(column, 128);
		const double difference = std::abs(
				EdgeScene::compute_column_mean(result, column) - compute_blurred_edge(x_m / 0.5));
		error += difference / 128;
		max_difference = std::max(max_difference, difference);
	}
	MESSAGE("mean error ", error, ", largest ", max_difference);
	CHECK(error < 0.004);
	CHECK(max_difference < 0.03);
	// Every row shows the same edge, so that differences between rows are noise.
	double noise = 0;
	for (uint32_t column = 32; column < 96; ++column) {
		for (uint32_t row = 32; row < 96; ++row) {
			noise += std::abs(result.visibility[row * 128 + column] -
							 EdgeScene::compute_column_mean(result, column)) /
					(64 * 64);
		}
	}
	CHECK(noise < 0.002);
}

TEST_CASE("[GPU][ReceiverScatter] the reference blurs the edge as the dipole predicts") {
	const ShadowTechniqueInfo *reference = ShadowRegistry::find_reference();
	REQUIRE(reference != nullptr);
	MaskFixture fixture;
	EdgeScene scene(0.5f, 1.0f);
	scene.light->properties[reference->id + "_samples"] = int64_t(4096);
	const MaskResult result = fixture.render_mask(scene, reference->id, glm::uvec2(32));
	for (uint32_t column = 0; column < 32; ++column) {
		const double x_m = EdgeScene::get_x_m(column, 32);
		CAPTURE(x_m);
		CHECK(EdgeScene::compute_column_mean(result, column) ==
				doctest::Approx(compute_blurred_edge(x_m / 0.5)).epsilon(0.004));
	}
	CHECK(result.standard_error > 0);
	CHECK(result.standard_error < 0.01);
}

TEST_CASE("[GPU][ReceiverScatter] in metres the blur has the same width at every resolution") {
	MaskFixture fixture;
	EdgeScene scene(0.5f, 0.8f);
	const MaskResult coarse = fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(64));
	const MaskResult fine = fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(256));
	double difference = 0;
	for (uint32_t column = 4; column < 60; ++column) {
		double mean = 0;
		for (uint32_t subcolumn = 0; subcolumn < 4; ++subcolumn) {
			mean += EdgeScene::compute_column_mean(fine, 4 * column + subcolumn) / 4;
		}
		CAPTURE(column);
		const float value = EdgeScene::compute_column_mean(coarse, column);
		CHECK(std::abs(value - mean) < 0.04); // the radius is 8 pixels
		difference += std::abs(value - mean) / 56;
	}
	CHECK(difference < 0.01);
}

TEST_CASE("[GPU][ReceiverScatter] in pixels, the radius is 16 times s, near samples weigh more") {
	MaskFixture fixture;
	for (const float scatter : { 0.15f, 0.5f, 0.8f, 1.0f }) {
		CAPTURE(scatter);
		EdgeScene scene(scatter, 0.0f);
		scene.light->properties["receiver_scatter_samples"] = int64_t(1024);
		const MaskResult result =
				fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(128));
		CHECK(is_valid_mask(result));
		const double radius_px = 16 * scatter;
		float last = 0;
		for (uint32_t column = 0; column < 128; ++column) {
			const double x_px = double(column) + 0.5 - 64; // from the edge
			const float value = EdgeScene::compute_column_mean(result, column);
			CAPTURE(x_px);
			if (std::abs(x_px) > radius_px + 1.5) { // points are rounded to pixels
				CHECK(value == (x_px > 0 ? 1.0f : 0.0f));
			}
			CHECK(value >= last - 0.02f); // rises towards the lit side, except for noise
			last = value;
		}
		// A uniformly weighted disc would have 0.392 of its weight past a line at 0.17 R.
		const uint32_t near_column = static_cast<uint32_t>(64 - std::lround(0.17 * radius_px) - 1);
		CHECK(EdgeScene::compute_column_mean(result, near_column) < 0.39f);
		// Light from at least 0.6 R away still counts.
		const uint32_t far_column = static_cast<uint32_t>(64 - std::lround(0.7 * radius_px));
		CHECK(EdgeScene::compute_column_mean(result, far_column) > 0.0f);
	}
}

TEST_CASE("[GPU][ReceiverScatter] skipping the filter where nothing scatters changes no mask") {
	MaskFixture fixture;
	SmallScene scene;
	const MaskResult before = fixture.render_mask(scene, get_sharp_technique());
	CHECK(before.plan.is_skipped("Light", "scatter"));
	const MaskResult unskipped =
			fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(64), false);
	CHECK_FALSE(unskipped.plan.is_skipped("Light", "scatter"));
	CHECK(unskipped.visibility == before.visibility);
	// A visible surface that scatters enables both passes.
	scene.box->surfaces[0].material = make_translucent_material(0.5f, 0.3f);
	const MaskResult wax = fixture.render_mask(scene, get_sharp_technique());
	CHECK_FALSE(wax.plan.is_skipped("Light", "scatter"));
	CHECK_FALSE(wax.plan.is_skipped("Light", "scatter average"));
	scene.box->surfaces[0].material =
			make_translucent_material(0.5f, 0.0f); // in pixels, without the averaging pass
	const MaskResult in_pixels = fixture.render_mask(scene, get_sharp_technique());
	CHECK(in_pixels.plan.is_skipped("Light", "scatter average"));
	CHECK(in_pixels.visibility ==
			fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(64), false).visibility);
	scene.box->surfaces[0].material = make_translucent_material(0.5f, 0.3f);
	scene.light->properties["receiver_scatter_enabled"] = false;
	const MaskResult disabled = fixture.render_mask(scene, get_sharp_technique());
	CHECK(disabled.plan.is_skipped("Light", "scatter"));
	CHECK(disabled.visibility == before.visibility);
	// If the surface is out of sight, the filter is skipped, and the mask stays the same.
	scene.light->properties.erase("receiver_scatter_enabled");
	scene.box->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 40, 0));
	const MaskResult hidden = fixture.render_mask(scene, get_sharp_technique());
	CHECK(hidden.plan.is_skipped("Light", "scatter"));
	CHECK(hidden.visibility ==
			fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(64), false).visibility);
}

TEST_CASE("[GPU][ReceiverScatter] opaque pixels next to a translucent body stay bit-identical") {
	MaskFixture fixture;
	SmallScene scene;
	const MaskResult before = fixture.render_mask(scene, get_sharp_technique());
	scene.box->surfaces[0].material = make_translucent_material(1.0f, 0.5f);
	const MaskResult after = fixture.render_mask(scene, get_sharp_technique());
	scene.scene.root->remove_child(*scene.box);
	MaskRequest request;
	request.scene = scene.snap();
	request.size_px = glm::uvec2(64);
	request.light = scene.light->name;
	request.wants_surfaces = true;
	const MaskResult empty = fixture.render(request);
	size_t count = 0;
	for (size_t index = 0; index < before.visibility.size(); ++index) {
		const SurfacePoint &surface = empty.surfaces[index];
		// Penumbra pixels of the ground that the box does not hide.
		const bool is_ground = surface.is_valid && before.receiver[index] > 0 &&
				before.visibility[index] > 0 && before.visibility[index] < 1;
		count += is_ground;
		if (is_ground) {
			CHECK(after.visibility[index] == before.visibility[index]);
		}
	}
	CHECK(count > 50);
}

TEST_CASE("[GPU][ReceiverScatter] light leaks between surfaces only if they are not refused") {
	// A translucent box in front of a translucent ground: adjacent in the image, apart in space.
	MaskFixture fixture;
	SmallScene scene;
	scene.ground->surfaces[0].material = make_translucent_material(1.0f, 0.4f);
	// 0.999 makes it another material than the ground's, and identifies its pixels below.
	scene.box->surfaces[0].material = make_translucent_material(0.999f, 0.4f);
	for (const char *method : { "metres", "pixels" }) {
		CAPTURE(method);
		scene.light->properties["receiver_scatter_method"] = std::string(method);
		scene.light->properties["receiver_scatter_refusal"] = std::string("on");
		const MaskResult refusing =
				fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(128));
		scene.light->properties["receiver_scatter_refusal"] = std::string("off");
		const MaskResult accepting =
				fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(128));
		CHECK(is_valid_mask(refusing));
		CHECK(is_valid_mask(accepting));
		// The box's top is fully lit: only a leak from the ground can darken it.
		MaskRequest request;
		request.scene = scene.snap();
		request.size_px = glm::uvec2(128);
		request.light = scene.light->name;
		request.wants_surfaces = true;
		const std::vector<SurfacePoint> surfaces = fixture.render(request).surfaces;
		double refusing_loss = 0;
		double accepting_loss = 0;
		for (size_t index = 0; index < surfaces.size(); ++index) {
			if (surfaces[index].material.scatter < 1.0f &&
					surfaces[index].material.scatter > 0.0f &&
					surfaces[index].geometric_normal.y > 0.9f) {
				refusing_loss += 1 - refusing.visibility[index];
				accepting_loss += 1 - accepting.visibility[index];
			}
		}
		CHECK(refusing_loss == doctest::Approx(0));
		CHECK(accepting_loss > 1);
	}
}

TEST_CASE("[GPU][ReceiverScatter] the filter can be enabled for each light") {
	MaskFixture fixture;
	SmallScene scene;
	scene.ground->surfaces[0].material = make_translucent_material(0.8f, 0.5f);
	Light3D &second = scene.add_light("Second", LightType::OMNI, { -2, 3, 1 }, { 0, 0, 0 });
	const MaskResult one = fixture.render_mask(scene, get_sharp_technique());
	second.properties["receiver_scatter_enabled"] = false;
	CHECK(fixture.render_mask(scene, get_sharp_technique()).visibility == one.visibility);
	scene.light = &second;
	const MaskResult off = fixture.render_mask(scene, get_sharp_technique());
	second.properties["receiver_scatter_enabled"] = true;
	const MaskResult on = fixture.render_mask(scene, get_sharp_technique());
	CHECK(compute_mask_difference(off, on) > 0.002);
}

TEST_CASE("[GPU][ReceiverScatter] rendering a frame twice gives bit-identical masks") {
	MaskFixture fixture;
	SmallScene scene;
	for (const float distance_m : { 0.0f, 0.5f }) {
		scene.ground->surfaces[0].material = make_translucent_material(0.7f, distance_m);
		const MaskResult first = fixture.render_mask(scene, get_sharp_technique());
		CHECK(fixture.render_mask(scene, get_sharp_technique()).visibility == first.visibility);
	}
}

TEST_CASE("[GPU][ReceiverScatter] a light that reaches no scattering surface skips the filter") {
	MaskFixture fixture;
	SmallScene scene;
	scene.box->surfaces[0].material = make_translucent_material(0.5f, 0.3f);
	Light3D &lamp = scene.add_light("Lamp", LightType::OMNI, { -1.2, 0.5, 0.6 }, { 0, 0, 0.1 });
	lamp.range_m = 0.6f; // the ground below it, not the box
	const auto render = [&](bool p_may_skip) {
		MaskRequest request;
		request.scene = scene.snap();
		request.size_px = glm::uvec2(64);
		request.technique_override = get_sharp_technique();
		request.may_skip = p_may_skip;
		return fixture.render(request);
	};
	const MaskResult skipping = render(true);
	CHECK(skipping.plan.is_skipped("Lamp", "scatter"));
	CHECK_FALSE(skipping.plan.is_skipped("Light", "scatter"));
	CHECK_FALSE(skipping.plan.is_skipped("Lamp", "shadow"));
	const MaskResult unskipped = render(false);
	for (const char *light : { "Light", "Lamp" }) {
		CHECK(skipping.masks.at(light).visibility == unskipped.masks.at(light).visibility);
	}
	lamp.range_m = 2.0f;
	CHECK_FALSE(render(true).plan.is_skipped("Lamp", "scatter"));
}
