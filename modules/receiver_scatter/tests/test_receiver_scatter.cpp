#include "modules/receiver_scatter/dipole_spread.h"
#include "modules/receiver_scatter/tests/scatter_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace gnomon;

namespace {

/// The hard shadow of half a plane, straight below a light, on a translucent ground that fills the
/// image of a camera that looks straight down.
struct EdgeScene : SmallScene {
	EdgeScene(float p_scatter, float p_distance_m) : SmallScene(LightType::DIRECTIONAL) {
		ground->surfaces[0].material = make_wax(p_scatter, p_distance_m);
		box->surfaces[0].mesh = make_box_mesh("half plane", glm::vec3(3.0f, 0.01f, 3.0f));
		box->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(-3.0, 8.0, 0.0));
		light->parent_from_node = look_at(glm::dvec3(0, 5, 0), glm::dvec3(0));
		light->properties["light_angular_distance"] = 0.0;
		const glm::dmat4 down = glm::rotate(glm::dmat4(1.0), glm::radians(-90.0), { 1, 0, 0 });
		camera->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 4, 0)) * down;
	}

	/// What each column of the image sees, and how far it is from the edge.
	static float get_x_m(uint32_t p_column, uint32_t p_size_px) {
		const float half_m = 4.0f * std::tan(0.5f * 0.785398163f);
		return half_m * ((p_column + 0.5f) / p_size_px * 2.0f - 1.0f);
	}
	static float compute_column(const MaskResult &p_result, uint32_t p_column) {
		const uint32_t size_px =
				static_cast<uint32_t>(std::lround(std::sqrt(double(p_result.visibility.size()))));
		double sum = 0;
		for (uint32_t row = size_px / 4; row < 3 * size_px / 4; ++row) {
			sum += p_result.visibility[row * size_px + p_column];
		}
		return static_cast<float>(sum / (size_px / 2));
	}
};

/// What a hard edge looks like after a spread: the share of the light from beyond it.
double compute_edge(double p_x_radii) {
	const DipoleSpread spread;
	const int STEPS = 20000;
	double beyond = 0;
	for (int i = 0; i < STEPS; ++i) {
		const double distance = spread.compute_distance((i + 0.5f) / STEPS);
		const double cosine = std::abs(p_x_radii) / distance;
		beyond += cosine < 1 ? std::acos(cosine) / 3.14159265358979 / STEPS : 0;
	}
	return p_x_radii > 0 ? 1 - beyond : beyond;
}

} // namespace

TEST_CASE("[GPU][ReceiverScatter] a sharp edge on a flat body becomes the dipole's, in metres") {
	MaskFixture fixture;
	EdgeScene scene(0.5f, 1.0f); // a radius of half a metre
	const MaskResult result = fixture.render_mask(scene, find_technique(), glm::uvec2(128));
	CHECK(is_valid_mask(result));
	double error = 0;
	double largest = 0;
	for (uint32_t column = 0; column < 128; ++column) {
		const double x_m = EdgeScene::get_x_m(column, 128);
		const double difference =
				std::abs(EdgeScene::compute_column(result, column) - compute_edge(x_m / 0.5));
		error += difference / 128;
		largest = std::max(largest, difference);
	}
	MESSAGE("mean error ", error, ", largest ", largest);
	CHECK(error < 0.004);
	CHECK(largest < 0.03);
	// Every row sees the same edge: what differs is noise.
	double noise = 0;
	for (uint32_t column = 32; column < 96; ++column) {
		for (uint32_t row = 32; row < 96; ++row) {
			noise += std::abs(result.visibility[row * 128 + column] -
							 EdgeScene::compute_column(result, column)) /
					(64 * 64);
		}
	}
	CHECK(noise < 0.002);
}

TEST_CASE("[GPU][ReceiverScatter] the reference integrates the same edge") {
	const ShadowTechniqueInfo *reference = ShadowRegistry::find_reference();
	REQUIRE(reference != nullptr);
	MaskFixture fixture;
	EdgeScene scene(0.5f, 1.0f);
	scene.light->properties[reference->id + "_samples"] = int64_t(4096);
	const MaskResult result = fixture.render_mask(scene, reference->id, glm::uvec2(32));
	for (uint32_t column = 0; column < 32; ++column) {
		const double x_m = EdgeScene::get_x_m(column, 32);
		CAPTURE(x_m);
		CHECK(EdgeScene::compute_column(result, column) ==
				doctest::Approx(compute_edge(x_m / 0.5)).epsilon(0.004));
	}
	CHECK(result.standard_error > 0);
	CHECK(result.standard_error < 0.01);
}

TEST_CASE("[GPU][ReceiverScatter] in metres the edge is as wide at every resolution") {
	MaskFixture fixture;
	EdgeScene scene(0.5f, 0.8f);
	const MaskResult coarse = fixture.render_mask(scene, find_technique(), glm::uvec2(64));
	const MaskResult fine = fixture.render_mask(scene, find_technique(), glm::uvec2(256));
	double difference = 0;
	for (uint32_t column = 4; column < 60; ++column) {
		double mean = 0;
		for (uint32_t part = 0; part < 4; ++part) {
			mean += EdgeScene::compute_column(fine, 4 * column + part) / 4;
		}
		CAPTURE(column);
		const float value = EdgeScene::compute_column(coarse, column);
		CHECK(std::abs(value - mean) < 0.04); // the radius is 8 pixels
		difference += std::abs(value - mean) / 56;
	}
	CHECK(difference < 0.01);
}

TEST_CASE(
		"[GPU][ReceiverScatter] the source's disc reaches 16 s pixels and weighs near ones more") {
	MaskFixture fixture;
	for (const float scatter : { 0.15f, 0.5f, 0.8f, 1.0f }) {
		CAPTURE(scatter);
		EdgeScene scene(scatter, 0.0f);
		scene.light->properties["receiver_scatter_samples"] = int64_t(1024);
		const MaskResult result = fixture.render_mask(scene, find_technique(), glm::uvec2(128));
		CHECK(is_valid_mask(result));
		const double radius_px = 16 * scatter;
		float last = 0;
		for (uint32_t column = 0; column < 128; ++column) {
			const double x_px = double(column) + 0.5 - 64; // from the edge
			const float value = EdgeScene::compute_column(result, column);
			CAPTURE(x_px);
			if (std::abs(x_px) > radius_px + 1.5) { // points are rounded to pixels
				CHECK(value == (x_px > 0 ? 1.0f : 0.0f));
			}
			CHECK(value >= last - 0.02f);
			last = value;
		}
		// A disc of even weight would have 0.391 of its light beyond a line at 0.17 R.
		const uint32_t near_column = static_cast<uint32_t>(64 - std::lround(0.17 * radius_px) - 1);
		CHECK(EdgeScene::compute_column(result, near_column) < 0.39f);
		// It does reach most of the way that it may.
		const uint32_t far_column = static_cast<uint32_t>(64 - std::lround(0.7 * radius_px));
		CHECK(EdgeScene::compute_column(result, far_column) > 0.0f);
	}
}

TEST_CASE("[GPU][ReceiverScatter] opaque receivers stay to the bit as they are") {
	MaskFixture fixture;
	SmallScene scene;
	const MaskResult before = fixture.render_mask(scene, find_technique());
	CHECK(before.plan.is_skipped("Light", "scatter"));
	const MaskResult whole = fixture.render_mask(scene, find_technique(), glm::uvec2(64), false);
	CHECK_FALSE(whole.plan.is_skipped("Light", "scatter"));
	CHECK(whole.visibility == before.visibility);
	// Another surface that scatters changes nothing on the ground, unless it is seen there.
	scene.box->surfaces[0].material = make_wax(0.5f, 0.3f);
	const MaskResult wax = fixture.render_mask(scene, find_technique());
	CHECK_FALSE(wax.plan.is_skipped("Light", "scatter"));
	CHECK_FALSE(wax.plan.is_skipped("Light", "scatter average"));
	scene.box->surfaces[0].material = make_wax(0.5f, 0.0f); // in pixels, where nothing is averaged
	const MaskResult in_pixels = fixture.render_mask(scene, find_technique());
	CHECK(in_pixels.plan.is_skipped("Light", "scatter average"));
	CHECK(in_pixels.visibility ==
			fixture.render_mask(scene, find_technique(), glm::uvec2(64), false).visibility);
	scene.box->surfaces[0].material = make_wax(0.5f, 0.3f);
	scene.light->properties["receiver_scatter_enabled"] = false;
	const MaskResult disabled = fixture.render_mask(scene, find_technique());
	CHECK(disabled.plan.is_skipped("Light", "scatter"));
	CHECK(disabled.visibility == before.visibility);
	// Out of sight it is skipped, with the same image.
	scene.light->properties.erase("receiver_scatter_enabled");
	scene.box->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 40, 0));
	const MaskResult hidden = fixture.render_mask(scene, find_technique());
	CHECK(hidden.plan.is_skipped("Light", "scatter"));
	CHECK(hidden.visibility ==
			fixture.render_mask(scene, find_technique(), glm::uvec2(64), false).visibility);
}

TEST_CASE("[GPU][ReceiverScatter] every opaque pixel next to a translucent body keeps its bits") {
	MaskFixture fixture;
	SmallScene scene;
	const MaskResult before = fixture.render_mask(scene, find_technique());
	scene.box->surfaces[0].material = make_wax(1.0f, 0.5f);
	const MaskResult after = fixture.render_mask(scene, find_technique());
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
		// On the ground where the box is not in front of it.
		const bool is_ground = surface.is_there && before.receiver[index] > 0 &&
				before.visibility[index] > 0 && before.visibility[index] < 1;
		count += is_ground;
		if (is_ground) {
			CHECK(after.visibility[index] == before.visibility[index]);
		}
	}
	CHECK(count > 50);
}

TEST_CASE("[GPU][ReceiverScatter] light does not leak between surfaces, unless it is set to") {
	// A translucent pillar before a translucent ground: neighbours in the image, far in space.
	MaskFixture fixture;
	SmallScene scene;
	scene.ground->surfaces[0].material = make_wax(1.0f, 0.4f);
	scene.box->surfaces[0].material = make_wax(0.999f, 0.4f);
	for (const char *method : { "metres", "pixels" }) {
		CAPTURE(method);
		scene.light->properties["receiver_scatter_method"] = std::string(method);
		scene.light->properties["receiver_scatter_refusal"] = std::string("on");
		const MaskResult refusing = fixture.render_mask(scene, find_technique(), glm::uvec2(128));
		scene.light->properties["receiver_scatter_refusal"] = std::string("off");
		const MaskResult taking = fixture.render_mask(scene, find_technique(), glm::uvec2(128));
		CHECK(is_valid_mask(refusing));
		CHECK(is_valid_mask(taking));
		// The box's top sees all of the light: nothing next to it may darken it.
		MaskRequest request;
		request.scene = scene.snap();
		request.size_px = glm::uvec2(128);
		request.light = scene.light->name;
		request.wants_surfaces = true;
		const std::vector<SurfacePoint> surfaces = fixture.render(request).surfaces;
		double refusing_loss = 0;
		double taking_loss = 0;
		for (size_t index = 0; index < surfaces.size(); ++index) {
			if (surfaces[index].material.scatter < 1.0f &&
					surfaces[index].material.scatter > 0.0f &&
					surfaces[index].geometric_normal.y > 0.9f) {
				refusing_loss += 1 - refusing.visibility[index];
				taking_loss += 1 - taking.visibility[index];
			}
		}
		CHECK(refusing_loss == doctest::Approx(0));
		CHECK(taking_loss > 1);
	}
}

TEST_CASE("[GPU][ReceiverScatter] each of several lights has its own spread") {
	MaskFixture fixture;
	SmallScene scene;
	scene.ground->surfaces[0].material = make_wax(0.8f, 0.5f);
	Light3D &second = scene.add_light("Second", LightType::OMNI, { -2, 3, 1 }, { 0, 0, 0 });
	const MaskResult one = fixture.render_mask(scene, find_technique());
	second.properties["receiver_scatter_enabled"] = false;
	CHECK(fixture.render_mask(scene, find_technique()).visibility == one.visibility);
	scene.light = &second;
	const MaskResult off = fixture.render_mask(scene, find_technique());
	second.properties["receiver_scatter_enabled"] = true;
	const MaskResult on = fixture.render_mask(scene, find_technique());
	CHECK(compute_mask_difference(off, on) > 0.002);
}

TEST_CASE("[GPU][ReceiverScatter] the same frame twice is the same to the bit") {
	MaskFixture fixture;
	SmallScene scene;
	for (const float distance_m : { 0.0f, 0.5f }) {
		scene.ground->surfaces[0].material = make_wax(0.7f, distance_m);
		const MaskResult first = fixture.render_mask(scene, find_technique());
		CHECK(fixture.render_mask(scene, find_technique()).visibility == first.visibility);
	}
}

TEST_CASE("[GPU][ReceiverScatter] a light that does not reach what scatters skips the filter") {
	MaskFixture fixture;
	SmallScene scene;
	scene.box->surfaces[0].material = make_wax(0.5f, 0.3f);
	Light3D &lamp = scene.add_light("Lamp", LightType::OMNI, { -1.2, 0.5, 0.6 }, { 0, 0, 0.1 });
	lamp.range_m = 0.6f; // the ground below it, not the box
	const auto render = [&](bool p_may_skip) {
		MaskRequest request;
		request.scene = scene.snap();
		request.size_px = glm::uvec2(64);
		request.technique_override = find_technique();
		request.may_skip = p_may_skip;
		return fixture.render(request);
	};
	const MaskResult lean = render(true);
	CHECK(lean.plan.is_skipped("Lamp", "scatter"));
	CHECK_FALSE(lean.plan.is_skipped("Light", "scatter"));
	CHECK_FALSE(lean.plan.is_skipped("Lamp", "shadow"));
	const MaskResult whole = render(false);
	for (const char *light : { "Light", "Lamp" }) {
		CHECK(lean.masks.at(light).visibility == whole.masks.at(light).visibility);
	}
	lamp.range_m = 2.0f;
	CHECK_FALSE(render(true).plan.is_skipped("Lamp", "scatter"));
}
