// Compares the whole technique, pixel by pixel, with its version in double precision
// (count_in_double.h).

#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// A small scene. An omni light is rotated, so that borders between its views cross what the camera
/// sees.
SmallScene make_mask_scene(LightType p_type) {
	SmallScene scene(p_type);
	if (p_type == LightType::OMNI) {
		scene.light->parent_from_node =
				glm::rotate(scene.light->parent_from_node, 0.8, glm::dvec3(1.0, 0.6, 0.3));
	}
	return scene;
}

MaskDifference compare_with_double(const MaskResult &p_frame, const SmallScene &p_scene) {
	const MaskDifference difference =
			compare_masks(p_frame.visibility, count_in_double(p_scene, p_frame));
	CHECK(difference.receiver_count > 2500);
	return difference;
}

/// Solids whose shadows overlap that of the box and one another, in two and three layers.
void add_overlapping_solids(SmallScene &r_scene) {
	add_globe(r_scene);
	for (int index = 0; index < 3; ++index) {
		MeshInstance3D &slab = add_mesh(r_scene.scene, text("Slab ", index),
				make_box_mesh("slab", { 0.45f, 0.03f, 0.35f }),
				{ 0.2 - 0.25 * index, 0.4 + 0.55 * index, 0.1 + 0.15 * index });
		slab.parent_from_node =
				glm::rotate(slab.parent_from_node, 0.5 + 0.6 * index, glm::dvec3(0.2, 1.0, 0.1));
	}
	add_mesh(r_scene.scene, "Quad",
			make_mesh("quad",
					{ { -0.5f, 0, -0.3f }, { 0.4f, 0, -0.4f }, { 0.5f, 0.2f, 0.4f },
							{ -0.4f, 0, 0.4f } },
					{}, { 0, 1, 2, 0, 2, 3 }),
			{ -0.3, 1.7, 0.3 });
}

} // namespace

TEST_CASE("[GPU][EdgeCount] the mask matches the double version, for every kind of light") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene = make_mask_scene(type);
		add_globe(scene);
		const MaskDifference difference = compare_with_double(
				render_frame(fixture, scene, { .wants_surfaces = true }), scene);
		CHECK(difference.penumbra_count > 80);
		// A rounding error of the mask's 16-bit floats just below 1 is at most 0.00024.
		CHECK(difference.mean < 3e-5);
		CHECK(difference.penumbra_mean < 4e-4);
		CHECK(difference.mismatch_count == 0);
	}
}

// Where solids overlap, points of the light are counted, and one of 64 is 0.016 of the light. If an
// edge passes through a point, rounding decides on which side the point is.
TEST_CASE("[GPU][EdgeCount] the mask matches the double version where solids overlap") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		std::vector<float> masks[2];
		for (const int quality_index : { 0, 1 }) {
			CAPTURE(quality_index);
			SmallScene scene = make_mask_scene(type);
			add_overlapping_solids(scene);
			scene.light->properties["light_size"] = 0.5;
			scene.light->properties["light_angular_distance"] = 14.0;
			scene.light->properties["edge_count_quality"] =
					std::string(quality_index == 0 ? "64" : "256");
			const MaskResult frame = render_frame(
					fixture, scene, { .size_px = glm::uvec2(64), .wants_surfaces = true });
			const MaskDifference difference = compare_with_double(frame, scene);
			CHECK(difference.penumbra_count > 250);
			CHECK(difference.mean < 2e-4);
			CHECK(double(difference.mismatch_count) < 0.005 * double(difference.receiver_count));
			masks[quality_index] = frame.visibility;
		}
		CHECK(masks[0] != masks[1]); // the number of points matters only if solids overlap
	}
}

TEST_CASE("[GPU][EdgeCount] the mask matches the double version under many stacked solids") {
	MaskFixture fixture;
	for (const int count : { 12, 30, 130 }) { // 130 sets bit plane 7, see PointCounters
		CAPTURE(count);
		SmallScene scene;
		scene.box->surfaces.clear();
		const auto mesh = make_box_mesh("plate", { 0.9f, 0.002f, 0.8f });
		for (int index = 0; index < count; ++index) {
			add_mesh(scene.scene, text("Plate ", index), mesh, { 0.0, 1.0 + 0.012 * index, 0.0 });
		}
		scene.light->properties["light_size"] = 0.4;
		const FrameOptions options = { .size_px = glm::uvec2(64), .wants_surfaces = true };
		const MaskResult frame = render_frame(fixture, scene, options);
		const MaskDifference difference = compare_with_double(frame, scene);
		CHECK(difference.penumbra_count > 300);
		CHECK(difference.mean < 3e-4);
		CHECK(double(difference.mismatch_count) < 0.002 * double(difference.receiver_count));
		if (has_reference()) {
			const MaskDifference error = compare_masks(
					frame.visibility, render_reference(fixture, scene, options.size_px));
			CHECK(error.penumbra_mean < 0.02);
		}
	}
}
