// Solids that touch or intersect one another, and outlines exactly on the borders of texels.

#include "modules/shadow_edge_count/tests/edge_count_fixture.h"
#include "modules/shadows/tests/wide_world.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace gnomon;

namespace {

const LightType ALL_TYPES[] = { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI };

/// The transform of a light that shines straight down from a height. The axes of its view are
/// parallel to those of the world.
glm::dmat4 look_down(double p_height_m) {
	return glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0), glm::dvec4(0, 1, 0, 0),
			glm::dvec4(0, p_height_m, 0, 1));
}

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
		for (const int64_t map_size_px : { 64, 256 }) {
			CAPTURE(std::string(get_light_type_name(type)));
			CAPTURE(map_size_px);
			SmallScene scene(type);
			scene.light->properties["edge_count_map_size"] = map_size_px;
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
}

TEST_CASE("[GPU][EdgeCount] outlines on the borders of texels or close to them cause no errors") {
	MaskFixture fixture;
	SmallScene scene;
	const double height_m = 4.0;
	const double top_m = 1.3; // of the box
	scene.light->parent_from_node = look_down(height_m);
	scene.light->properties["light_size"] = 0.03;
	const std::shared_ptr<const SceneSnapshot> snapshot = scene.snap();
	std::vector<LightView> views;
	ShadowEdgeCount().get_light_views(snapshot->lights[0], *snapshot,
			resolve_light_properties(
					snapshot->lights[0], ShadowRegistry::get_light_properties("edge_count")),
			views);
	const LightView &view = views[0];
	// The technique moves the light's centre slightly: move the light by as much the other way.
	const glm::dvec3 shift = glm::dvec3(glm::inverse(view.view_from_world)[3]) -
			glm::dvec3(scene.light->parent_from_node[3]);
	scene.light->parent_from_node[3] -= glm::dvec4(shift, 0.0);
	// The position of the box's side whose upper edge is p_texels from the border of the map.
	const auto find_side_m = [&](double p_texels) {
		return (2.0 * p_texels / view.size_px.x - 1.0) * view.half_extent.x * (height_m - top_m);
	};
	for (const double offset_px : { -0.003, -0.001, 0.0, 0.001, 0.003 }) {
		CAPTURE(offset_px);
		scene.box->surfaces[0].mesh = make_box_mesh("box",
				glm::vec3(find_side_m(160.0 + offset_px), 0.3, find_side_m(150.0 + offset_px)));
		CHECK(check_mask(fixture, scene, 0.0005).maximum < 0.1);
	}
}

// A block without edges may be partly lit if a face passes between its receivers.
TEST_CASE("[GPU][EdgeCount] a thin wall separates lit from dark ground within blocks of pixels") {
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
