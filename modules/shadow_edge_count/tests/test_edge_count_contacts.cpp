// Solids that touch or intersect one another, and outlines exactly on the borders of texels.

#include "modules/shadow_edge_count/tests/edge_count_fixture.h"
#include "modules/shadows/tests/wide_world.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace gnomon;

namespace {

/// Compares the mask with the double version, and, in a build with the reference, with that.
/// Returns the difference from the reference, or zeros without one. p_reference_limit: limit of the
/// mean of that difference.
MaskDifference check_mask(MaskFixture &r_fixture, SmallScene &r_scene, double p_reference_limit,
		glm::uvec2 p_size_px = glm::uvec2(96)) {
	const MaskResult frame =
			render_frame(r_fixture, r_scene, { .size_px = p_size_px, .wants_surfaces = true });
	const MaskDifference difference =
			compare_masks(frame.visibility, count_in_double(r_scene, frame));
	CHECK(difference.mean < 5e-5);
	CHECK(difference.mismatch_count == 0);
	if (has_reference()) {
		const MaskDifference error =
				compare_masks(frame.visibility, render_reference(r_fixture, r_scene, p_size_px));
		CHECK(error.mean < p_reference_limit);
		return error;
	}
	return {};
}

} // namespace

TEST_CASE("[GPU][EdgeCount] solids that are sunk into the ground leak no light") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		scene.light->parent_from_node = look_at({ 0.5, 4.0, 0.3 }, { 0.2, 0, 0.1 });
		scene.box->parent_from_node[3].y = 0.25;
		add_mesh(scene.scene, "Globe", make_count_sphere(0.4, 12), { -0.9, 0.1, 0.5 });
		MeshInstance3D &pole = add_mesh(scene.scene, "Pole",
				make_box_mesh("pole", { 0.06f, 0.8f, 0.05f }), { -0.4, 0.5, 1.1 });
		pole.parent_from_node = glm::rotate(pole.parent_from_node, 0.3, { 0.2, 0.3, 1.0 });
		const MaskDifference error = check_mask(fixture, scene, 0.001);
		CHECK(error.maximum <= 0.1); // a leak would be close to 1
	}
}

// A leaf without edges may be partly lit if a face passes between its receivers.
TEST_CASE("[GPU][EdgeCount] a thin wall separates lit from dark ground within leaves") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		scene.light->parent_from_node = look_at({ 3.0, 1.6, 0.1 }, { 0, 0.3, 0 });
		scene.light->properties["light_size"] = 0.004;
		// The camera is in the wall's plane, so that both sides of its foot are visible.
		scene.camera->parent_from_node = look_at({ 0.1, 4.0, 3.0 }, { 0.1, 0.0, 0.0 });
		scene.box->surfaces[0].mesh = make_box_mesh("wall", { 0.002f, 0.9f, 2.4f });
		scene.box->parent_from_node = glm::translate(glm::dmat4(1.0), { 0.1, 0.3, 0.0 });
		check_mask(fixture, scene, 0.002, glm::uvec2(256));
	}
}

TEST_CASE("[GPU][EdgeCount] in a world of 2 km a plate of 4 cm casts its shadow, and nothing hides "
		  "itself") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		make_wide_world(scene);
		scene.light->properties["light_size"] = 0.15;
		scene.light->properties["light_angular_distance"] = 6.0;
		add_globe(scene, 0.1, { -0.4, -0.05, -0.2 });
		const MaskResult frame = render_frame(
				fixture, scene, { .size_px = glm::uvec2(128), .wants_surfaces = true });
		const MaskResult exact = count_in_double(scene, frame);
		CHECK(std::count_if(exact.visibility.begin(), exact.visibility.end(), [](float p_value) {
			return p_value > 0.3f && p_value < 0.7f; // penumbra
		}) > 10);
		const MaskDifference difference = compare_masks(frame.visibility, exact);
		CHECK(difference.mean < 2e-4);
		CHECK(difference.maximum < 0.2);
	}
}
