// Lights of any size at any position, and meshes that are not closed solids.

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

const glm::uvec2 EXTREMES_SIZE_PX(72);

/// Difference of the mask from the reference. In a build without the reference its errors are 0.
MaskDifference compare_with_reference(
		MaskFixture &r_fixture, SmallScene &r_scene, int64_t p_sample_count = 1024) {
	const MaskResult frame = render_frame(r_fixture, r_scene, { .size_px = EXTREMES_SIZE_PX });
	if (!has_reference()) {
		return compare_masks(frame.visibility, frame);
	}
	return compare_masks(frame.visibility,
			render_reference(r_fixture, r_scene, EXTREMES_SIZE_PX, p_sample_count));
}

/// A box with each of its triangles twice, the second time with inverted winding if p_is_flipped.
std::shared_ptr<const Mesh> make_double_box(bool p_is_flipped) {
	const auto box = make_box_mesh("box", { 0.5f, 0.3f, 0.4f });
	std::vector<uint32_t> indices = box->indices;
	for (size_t index = 0; index < box->indices.size(); index += 3) {
		const uint32_t *corner = &box->indices[index];
		const uint32_t second = p_is_flipped ? 2 : 1;
		indices.insert(indices.end(), { corner[0], corner[second], corner[3 - second] });
	}
	return make_mesh("double box", box->positions_node, {}, indices);
}

/// A box with degenerate triangles and slivers on its top.
std::shared_ptr<const Mesh> make_box_with_slivers() {
	const auto box = make_box_mesh("box", { 0.5f, 0.3f, 0.4f });
	std::vector<glm::vec3> positions = box->positions_node;
	std::vector<uint32_t> indices = box->indices;
	const uint32_t first = uint32_t(positions.size());
	positions.insert(positions.end(),
			{ { -0.4f, 0.3f, -0.3f }, { 0.0f, 0.3f, 0.0f }, { 0.4f, 0.3f, 0.3f },
					{ 0.4f, 0.3f, 0.300001f }, { -0.4f, 0.9f, -0.3f } });
	indices.insert(indices.end(),
			{ first, first + 1, first + 2, first, first + 2, first + 3, first, first, first + 4 });
	return make_mesh("box with slivers", positions, {}, indices);
}

} // namespace

TEST_CASE("[GPU][EdgeCount] a device without subgroup operations is refused, and a caster "
		  "collapsed to a line is reported") {
	{
		MaskFixture fixture("", { &DeviceFeatures::subgroup_operations });
		std::string message;
		try {
			fixture.render_mask(SmallScene(), "edge_count");
		} catch (const Error &error) {
			message = error.what();
		}
		CAPTURE(message);
		CHECK(message.find("Light \"Light\": edge_count needs subgroup vote") != std::string::npos);
	}
	SmallScene scene;
	scene.box->parent_from_node = glm::scale(scene.box->parent_from_node, glm::dvec3(1, 0, 0));
	MaskFixture fixture;
	const MaskResult result = fixture.render_mask(scene, "edge_count");
	CHECK(is_valid_mask(result));
	CHECK(result.plan.is_skipped("Light", "edges of instances: 1"));
	scene.ground->casts_shadow = false; // so that no caster has a face
	const MaskResult lit = fixture.render_mask(scene, "edge_count");
	CHECK(is_valid_mask(lit));
	CHECK(std::count(lit.visibility.begin(), lit.visibility.end(), 1.0f) > 100);
}

TEST_CASE("[GPU][EdgeCount] the removed property edge_count_layers only logs one warning") {
	std::vector<std::string> lines;
	const LogSink before =
			set_log_sink([&](LogLevel, const std::string &p_line) { lines.push_back(p_line); });
	MaskFixture fixture;
	SmallScene scene;
	scene.light->name = "Old lamp";
	const MaskResult plain = render_frame(fixture, scene, { .size_px = EXTREMES_SIZE_PX });
	CHECK(lines.empty());
	scene.light->properties["edge_count_layers"] = int64_t(3);
	for (int frame = 0; frame < 3; ++frame) {
		CHECK(render_frame(fixture, scene, { .size_px = EXTREMES_SIZE_PX }).visibility ==
				plain.visibility);
	}
	set_log_sink(before);
	REQUIRE(lines.size() == 1);
	CHECK(lines[0].find("Light \"Old lamp\"") != std::string::npos);
	CHECK(lines[0].find("edge_count_layers is not used any more") != std::string::npos);
}

TEST_CASE("[GPU][EdgeCount] a light without size casts shadows of 0 and 1") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		add_globe(scene);
		scene.light->properties["light_size"] = 0.0;
		scene.light->properties["light_angular_distance"] = 0.0;
		const MaskResult frame = render_frame(fixture, scene, { .size_px = EXTREMES_SIZE_PX });
		size_t dark_count = 0;
		size_t between_count = 0;
		for (size_t index = 0; index < frame.visibility.size(); ++index) {
			const float visibility = frame.visibility[index];
			dark_count += frame.receiver[index] > 0 && visibility == 0.0f ? 1 : 0;
			between_count += visibility != 0.0f && visibility != 1.0f ? 1 : 0;
		}
		CHECK(between_count == 0);
		CHECK(dark_count > 120);
		CHECK(frame.plan.is_skipped("Light", "edges"));
		// The reference uses one ray per pixel.
		const MaskDifference difference = compare_with_reference(fixture, scene);
		CHECK(difference.mismatch_count <= 2);
	}
}

TEST_CASE("[GPU][EdgeCount] a light nearly as large as the scene is as exact as a small one") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		scene.light->properties["light_size"] = 3.0;			  // 0.75 S
		scene.light->properties["light_angular_distance"] = 73.7; // degrees; R = 0.75
		const MaskDifference difference = compare_with_reference(fixture, scene);
		CHECK(difference.penumbra_mean < 0.004);
		CHECK((difference.penumbra_count > 1000 || !has_reference()));
	}
}

TEST_CASE("[GPU][EdgeCount] a light inside a solid or below the ground leaks no light") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		scene.light->properties["light_size"] = 0.1;
		const glm::dmat4 transforms[] = { look_at({ 0.1, 1.0, 0.05 }, { 0, 0, 0.01 }),
			look_at({ 0.3, -2.0, 0.2 }, { 0, 0, 0.01 }) };
		for (const glm::dmat4 &transform : transforms) {
			scene.light->parent_from_node = transform;
			CHECK(compare_with_reference(fixture, scene).mean < 0.001);
		}
		// Partly inside a solid, see "Known failures" in doc/techniques/edge_count.md: rendering
		// must only not fail.
		scene.light->parent_from_node = look_at({ 0.45, 0.75, 0.05 }, { 1.0, 0, 0.01 });
		render_frame(fixture, scene);
	}
}

TEST_CASE("[GPU][EdgeCount] a light of any size exactly at a corner of a caster is counted right") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		for (const double radius_m : { 0.4, 0.04, 4e-3, 4e-4 }) {
			CAPTURE(std::string(get_light_type_name(type)));
			CAPTURE(radius_m);
			SmallScene scene(type);
			scene.light->properties["light_size"] = radius_m;
			const glm::dvec3 corner(1.2, 2.7, 0.9);
			scene.light->parent_from_node = look_at(corner, { 0, 0, 0 });
			const glm::vec3 half_size(0.2f, 0.3f, 0.25f);
			add_mesh(scene.scene, "Corner", make_box_mesh("box", half_size),
					corner + glm::dvec3(half_size));
			const MaskResult frame = render_frame(
					fixture, scene, { .size_px = EXTREMES_SIZE_PX, .wants_surfaces = true });
			const MaskDifference difference =
					compare_masks(frame.visibility, count_in_double(scene, frame));
			CHECK(difference.penumbra_count > 1000);
			CHECK(difference.maximum < 0.006); // the centre is moved by up to 0.002 R
		}
	}
}

TEST_CASE("[GPU][EdgeCount] a caster that crosses the light's plane still casts a shadow") {
	MaskFixture fixture;
	const auto rod = make_box_mesh("rod", { 0.05f, 1.2f, 0.05f });
	const auto triangle = make_mesh(
			"triangle", { { -0.3f, -1, 0 }, { 0.3f, -1, 0 }, { 0, 1.5f, 0.1f } }, {}, { 0, 1, 2 });
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		for (const auto &mesh : { rod, triangle }) {
			CAPTURE(std::string(get_light_type_name(type)));
			CAPTURE(mesh->name);
			SmallScene scene(type);
			scene.light->properties["light_size"] = 0.1;
			const MaskResult without =
					render_frame(fixture, scene, { .size_px = EXTREMES_SIZE_PX });
			CHECK(without.plan.is_skipped("Light", "faces that cut the light's disc"));
			add_mesh(scene.scene, "Near", mesh, { 1.05, 3.8, 0.62 });
			const MaskResult with = render_frame(fixture, scene, { .size_px = EXTREMES_SIZE_PX });
			CHECK(compute_mask_difference(with, without) > 0.02);
			const MaskDifference difference = compare_with_reference(fixture, scene);
			CHECK(difference.mean < 0.004);
			CHECK(difference.maximum < 0.06);
		}
	}
}

TEST_CASE(
		"[GPU][EdgeCount] the shadow of a caster that cuts the light's disc matches ray tracing") {
	MaskFixture fixture;
	const auto rod = make_box_mesh("rod", { 0.05f, 0.3f, 0.08f });
	const auto triangle = make_mesh("triangle",
			{ { -0.3f, -0.4f, 0.01f }, { 0.3f, -0.4f, -0.02f }, { 0.02f, 0.5f, 0.1f } }, {},
			{ 0, 1, 2 });
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		for (const auto &mesh : { rod, triangle }) {
			for (const double side : { 1.0, -1.0 }) {
				CAPTURE(std::string(get_light_type_name(type)));
				CAPTURE(mesh->name);
				CAPTURE(side);
				SmallScene scene(type);
				scene.light->properties["light_size"] = 0.15;
				const glm::dvec3 center(scene.light->parent_from_node[3]);
				MeshInstance3D &cutter = add_mesh(
						scene.scene, "Cutter", mesh, center + glm::dvec3(0.03, 0.02, -0.04));
				cutter.parent_from_node = glm::scale(
						glm::rotate(cutter.parent_from_node, 0.4, glm::dvec3(1.0, 0.2, 0.7)),
						glm::dvec3(side, 1.0, 1.0));
				const FramePlan plan = render_frame(fixture, scene).plan;
				CHECK_FALSE(plan.is_skipped("Light", "faces that cut the light's disc"));
				const MaskDifference difference = compare_with_reference(fixture, scene);
				CHECK(difference.penumbra_count > 1000);
				CHECK(difference.mean < 0.006); // the noise of 1024 rays is about 0.004
				CHECK(difference.maximum < 0.05);
			}
		}
	}
}

TEST_CASE("[GPU][EdgeCount] a large ground or roof away from the light does not cut its disc") {
	MaskFixture fixture;
	const auto slab = make_box_mesh("slab", { 40.0f, 0.02f, 40.0f });
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		for (const double turn : { 0.0, 0.6 }) {
			for (const double offset : { -0.4, 0.4 }) {
				CAPTURE(std::string(get_light_type_name(type)));
				CAPTURE(turn);
				CAPTURE(offset);
				SmallScene scene(type); // its light is aimed obliquely
				scene.light->properties["light_size"] = 0.15;
				// Its box along the world's axes contains the light if it is turned.
				const glm::dmat4 turned =
						glm::rotate(glm::translate(glm::dmat4(1.0),
											glm::dvec3(scene.light->parent_from_node[3])),
								turn, glm::dvec3(0.3, 0.1, 0.9));
				MeshInstance3D &node = add_mesh(scene.scene, "Slab", slab, glm::dvec3(0.0));
				node.parent_from_node = glm::translate(turned, glm::dvec3(0.0, offset, 0.0));
				const FramePlan plan = render_frame(fixture, scene).plan;
				CHECK(plan.is_skipped("Light", "faces that cut the light's disc"));
				node.parent_from_node = glm::translate(turned, glm::dvec3(0.0, offset / 4, 0.0));
				const FramePlan near_plan = render_frame(fixture, scene).plan;
				CHECK_FALSE(near_plan.is_skipped("Light", "faces that cut the light's disc"));
			}
		}
	}
}

TEST_CASE("[GPU][EdgeCount] a beam extending far behind the light's plane casts a correct shadow") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		for (const float half_length : { 25.0f, 250.0f }) {
			CAPTURE(std::string(get_light_type_name(type)));
			CAPTURE(half_length);
			SmallScene scene(type);
			scene.box->surfaces[0].mesh = make_box_mesh("beam", { half_length, 0.25f, 0.5f });
			const MaskDifference difference = compare_with_reference(fixture, scene);
			CHECK(difference.mean < 0.001);
			CHECK(difference.penumbra_mean < 0.008);
		}
	}
}

TEST_CASE("[GPU][EdgeCount] very large ground does not degrade the shadow of a directional light") {
	MaskFixture fixture;
	SmallScene scene(LightType::DIRECTIONAL);
	add_mesh(scene.scene, "Small", make_box_mesh("small", { 0.15f, 0.25f, 0.1f }),
			{ 1.1, 0.25, 0.9 });
	add_mesh(scene.scene, "Far", make_box_mesh("far", { 150.0f, 0.1f, 150.0f }), { 0, -0.6, 0 });
	const MaskDifference difference = compare_with_reference(fixture, scene);
	CHECK(difference.mean < 0.001);
	CHECK(difference.penumbra_mean < 0.008);
}

TEST_CASE("[GPU][EdgeCount] a caster scaled down towards the light casts the same shadow") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		CAPTURE(std::string(get_light_type_name(type)));
		std::vector<float> first;
		for (const double near_m : { 0.4, 0.4e-3, 0.4e-6 }) {
			SmallScene scene(type);
			scene.box->casts_shadow = false;
			scene.light->properties["light_size"] = 0.02 * near_m;
			MeshInstance3D &plate = add_mesh(scene.scene, "Plate",
					make_box_mesh("plate", { 0.08f, 0.06f, 0.01f }), glm::dvec3(0.0));
			plate.parent_from_node = glm::scale(
					glm::translate(scene.light->parent_from_node, glm::dvec3(0, 0, -near_m)),
					glm::dvec3(near_m));
			const MaskResult frame = render_frame(fixture, scene, { .size_px = EXTREMES_SIZE_PX });
			if (first.empty()) {
				first = frame.visibility;
				CHECK(compare_with_reference(fixture, scene).penumbra_mean < 0.006);
			}
			double difference = 0;
			size_t dark_count = 0;
			for (size_t index = 0; index < first.size(); ++index) {
				difference += std::abs(double(frame.visibility[index]) - double(first[index]));
				dark_count += frame.receiver[index] > 0 && frame.visibility[index] < 0.5f ? 1 : 0;
			}
			CHECK(dark_count > 100);
			// Not exactly equal: the ground is not infinitely far, so the penumbra of the largest
			// caster is a little narrower.
			CHECK(difference / double(first.size()) < 0.02);
		}
	}
}

TEST_CASE("[GPU][EdgeCount] shadows of open meshes match ray tracing, whichever side is lit") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		for (const bool is_flipped : { false, true }) {
			CAPTURE(std::string(get_light_type_name(type)));
			CAPTURE(is_flipped);
			SmallScene scene(type);
			scene.box->surfaces[0].mesh = make_mesh("quad",
					{ { -0.6f, 0, -0.5f }, { 0.6f, 0, -0.5f }, { 0.6f, 0.2f, 0.5f },
							{ -0.6f, 0, 0.5f } },
					{},
					is_flipped ? std::vector<uint32_t>{ 0, 1, 2, 0, 2, 3 }
							   : std::vector<uint32_t>{ 2, 1, 0, 3, 2, 0 });
			const MaskDifference difference = compare_with_reference(fixture, scene);
			CHECK(difference.penumbra_mean < 0.004);
			CHECK(difference.mean < 2e-4);
		}
	}
}

TEST_CASE("[GPU][EdgeCount] shadows of meshes that are not simple solids match ray tracing") {
	MaskFixture fixture;
	const auto box = make_box_mesh("box", { 0.5f, 0.3f, 0.4f });
	const auto inside_out = make_mesh("inside out", box->positions_node, {},
			std::vector<uint32_t>(box->indices.rbegin(), box->indices.rend()));
	const std::shared_ptr<const Mesh> meshes[] = { make_double_box(/*p_is_flipped=*/false),
		make_double_box(/*p_is_flipped=*/true), make_box_with_slivers(), inside_out, box, box };
	for (int index = 0; index < 6; ++index) {
		CAPTURE(index);
		SmallScene scene(ALL_TYPES[index % 3]);
		scene.box->surfaces[0].mesh = meshes[index];
		if (index == 4) {
			add_mesh(scene.scene, "Twin", box, { 0, 1.0, 0 });
		} else if (index == 5) {
			scene.box->parent_from_node = // mirrored
					glm::scale(scene.box->parent_from_node, glm::dvec3(-1.0, 1.0, 1.0));
		}
		const MaskDifference difference = compare_with_reference(fixture, scene);
		CHECK(difference.penumbra_mean < 0.02);
		// The camera looks into the inside-out box, where some pixels next to its edges are wrong.
		CHECK(difference.mean < (index == 3 ? 0.02 : 0.001));
	}
}
