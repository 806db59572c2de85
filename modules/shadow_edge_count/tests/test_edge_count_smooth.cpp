// Blocks of 8 x 8 pixels whose edges are all far from the receivers: 16 pixels are counted, the
// others interpolated.

#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace gnomon;

namespace {

const glm::uvec2 SMOOTH_SIZE_PX(256);

/// Casters high above the ground.
SmallScene make_high_scene(LightType p_type) {
	SmallScene scene(p_type);
	scene.box->surfaces.clear();
	add_globe(scene, 0.7, { 0.3, 0.9, -0.2 });
	for (int index = 0; index < 3; ++index) {
		add_mesh(scene.scene, text("Plate ", index),
				make_box_mesh("plate", { 0.35f, 0.02f, 0.25f }),
				{ 0.1 * index, 1.2 + 0.2 * index, 0.15 * index });
	}
	scene.light->properties["light_size"] = 0.9;
	scene.light->properties["light_angular_distance"] = 36.0;
	return scene;
}

/// p_interpolation: the property edge_count_interpolation; 0: every pixel is counted.
MaskResult render_interpolated(
		MaskFixture &r_fixture, SmallScene &r_scene, double p_interpolation) {
	r_scene.light->properties["edge_count_interpolation"] = p_interpolation;
	return render_frame(r_fixture, r_scene, { .size_px = SMOOTH_SIZE_PX });
}

/// Largest difference of two masks, and number of pixels that are not equal bit for bit.
struct Change {
	float maximum = 0;
	size_t count = 0;
};

Change compare(const MaskResult &p_one, const MaskResult &p_other) {
	Change change;
	for (size_t index = 0; index < p_one.visibility.size(); ++index) {
		const float difference = std::abs(p_one.visibility[index] - p_other.visibility[index]);
		change.maximum = std::max(change.maximum, difference);
		change.count += difference > 0 ? 1 : 0;
	}
	return change;
}

} // namespace

TEST_CASE("[GPU][EdgeCount] a mask that is interpolated far from all edges is as accurate as a "
		  "counted one") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI }) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene = make_high_scene(type);
		const MaskResult counted = render_interpolated(fixture, scene, 0.0);
		const MaskResult interpolated = render_interpolated(fixture, scene, 0.5);
		const Change change = compare(counted, interpolated);
		CHECK(change.count > 2000);
		CHECK(change.maximum < 0.04f); // about ten of the light's 256 points
		if (has_reference()) {
			const MaskResult reference = render_reference(fixture, scene, SMOOTH_SIZE_PX, 4096);
			const double error = compare_masks(counted.visibility, reference).penumbra_mean;
			CHECK(compare_masks(interpolated.visibility, reference).penumbra_mean < error + 2e-4);
		}
	}
}

TEST_CASE("[GPU][EdgeCount] a small light, whose penumbras are narrow, has no interpolated pixel") {
	MaskFixture fixture;
	SmallScene scene; // a box above the ground
	scene.light->properties["light_size"] = 0.05;
	const MaskResult counted = render_interpolated(fixture, scene, 0.0);
	CHECK(compare(counted, render_interpolated(fixture, scene, 0.5)).count == 0);
}

TEST_CASE("[GPU][EdgeCount] no interpolation across a thin wall, however far all edges are") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		scene.light->parent_from_node = look_at({ 3.0, 1.6, 0.1 }, { 0, 0.3, 0 });
		scene.light->properties["light_size"] = 0.5;
		// The camera is in the wall's plane, so that both sides of its foot are visible.
		scene.camera->parent_from_node = look_at({ 0.1, 4.0, 3.0 }, { 0.1, 0.0, 0.0 });
		scene.box->surfaces[0].mesh = make_box_mesh("wall", { 0.0005f, 0.9f, 2.4f });
		scene.box->parent_from_node = glm::translate(glm::dmat4(1.0), { 0.1, 0.3, 0.0 });
		// The plate's penumbra is on both sides of the wall.
		add_mesh(scene.scene, "Plate", make_box_mesh("plate", { 0.02f, 0.2f, 0.6f }),
				{ 1.8, 0.95, 0.0 });
		const MaskResult counted = render_interpolated(fixture, scene, 0.0);
		const Change change = compare(counted, render_interpolated(fixture, scene, 0.5));
		CHECK(change.count > 500);
		CHECK(change.maximum < 0.04f);
	}
}

TEST_CASE("[GPU][EdgeCount] nothing is interpolated if a face cuts the light's disc") {
	MaskFixture fixture;
	SmallScene scene = make_high_scene(LightType::OMNI);
	add_mesh(scene.scene, "Cutter", make_box_mesh("cutter", { 0.3f, 0.02f, 0.3f }),
			glm::dvec3(scene.light->parent_from_node[3]) + glm::dvec3(0.2, 0.05, 0.1));
	const MaskResult counted = render_interpolated(fixture, scene, 0.0);
	CHECK(compare(counted, render_interpolated(fixture, scene, 1.0)).count == 0);
}
