// Compares whole frames with ray tracing, and all extrusion and stencil methods with each other.

#include "modules/shadow_volume/tests/volume_fixture.h"

using namespace gnomon;

TEST_CASE("[GPU][ShadowVolume] the mask is that of rays, for every light and class of mesh") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		check_against_rays(scene, render_volumes(fixture, scene));
		add_meshes(scene);
		add_mirrored_box(scene);
		check_against_rays(scene, render_volumes(fixture, scene));
	}
}

TEST_CASE("[GPU][ShadowVolume] all ways to make and count volumes give the same mask") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		add_meshes(scene);
		add_mirrored_box(scene);
		const MaskResult first = render_volumes(fixture, scene);
		const auto check_same = [&](const MaskResult &p_other) {
			CHECK(p_other.visibility == first.visibility);
		};
		for (const char *extrusion : { "geometry_shader", "compute" }) {
			CAPTURE(std::string(extrusion));
			for (const char *count : { "auto", "z_pass", "z_fail" }) {
				CAPTURE(std::string(count));
				check_same(render_volumes(fixture, scene,
						{ { "extrusion", std::string(extrusion) },
								{ "method", std::string(count) } }));
			}
			check_same(render_volumes(fixture, scene,
					{ { "extrusion", std::string(extrusion) },
							{ "robust", std::string("always") } }));
			check_same(render_volumes(fixture, scene,
					{ { "extrusion", std::string(extrusion) }, { "scissor", false } }));
		}
		check_same(render_volumes(fixture, scene, {}, "shadow_volume", glm::uvec2(128),
				/*p_may_skip=*/false));
		// In double precision, a face that is edge-on to the light may be classified differently.
		const MaskResult on_cpu = render_volumes(fixture, scene, {}, "shadow_volume_cpu");
		CHECK(compute_mask_difference(first, on_cpu) < 1e-4);
		check_against_rays(scene, on_cpu);
	}
}

TEST_CASE("[GPU][ShadowVolume] a camera close to casters and their shadows matches rays") {
	MaskFixture fixture;
	SmallScene scene;
	add_meshes(scene);
	size_t z_fail_count = 0;
	for (int step = 0; step < 24; ++step) {
		CAPTURE(step);
		// Close past the box, so that the near plane may be in a shadow volume at some steps.
		const double path_position = -1.0 + step / 12.0;
		scene.camera->parent_from_node =
				look_at({ -0.3 + 1.2 * path_position, 0.5 + 0.1 * step, -0.1 + path_position },
						{ 0.6, 0, 1.4 - path_position });
		const MaskResult frame = render_volumes(fixture, scene);
		z_fail_count += frame.plan.to_text().find("by z-fail") != std::string::npos ? 1 : 0;
		const HardDifference difference = HardReference(scene).compare(frame);
		CHECK(difference.wrong_count <= difference.receiver_count / 500);
		CHECK(difference.unexplained_count == 0);
	}
	CHECK(z_fail_count > 5);
}

TEST_CASE("[GPU][ShadowVolume] a light inside a solid and one in the planes of its faces match "
		  "rays") {
	MaskFixture fixture;
	SmallScene scene(LightType::OMNI);
	const auto place_light = [&](const glm::dvec3 &p_position) {
		scene.light->parent_from_node = glm::translate(glm::dmat4(1.0), p_position);
	};
	place_light({ 0.05, 1.02, 0.03 }); // inside the box: every receiver is hidden
	const MaskResult inside = render_volumes(fixture, scene);
	CHECK(HardReference(scene).compare(inside).wrong_count == 0);
	CHECK(HardReference(scene).compare(inside).hidden_count == count_receivers(inside));
	place_light({ 0.5, 3.0, 0.4 }); // above a corner of the box: in the planes of two of its sides
	check_against_rays(scene, render_volumes(fixture, scene));
	place_light({ 2.0, 1.3, 0.0 }); // in the plane of its top
	check_against_rays(scene, render_volumes(fixture, scene));
}

TEST_CASE("[GPU][ShadowVolume] more volumes than a stencil counts over one pixel match rays") {
	MaskFixture fixture;
	SmallScene scene;
	const auto plate = make_box_mesh("plate", glm::vec3(0.5f, 0.001f, 0.4f));
	for (int index = 0; index < 255; ++index) { // with the box 256: a count that wraps to 0
		add_mesh(scene.scene, text("Plate ", index), plate, { 0, 1.4 + 0.004 * index, 0 });
	}
	const MaskResult frame = render_volumes(fixture, scene, { { "culling", std::string("off") } });
	check_against_rays(scene, frame, 500); // more tolerance: each plate has a border
	CHECK(frame.plan.to_text().find("groups of casters, each with its own stencil count: 2") !=
			std::string::npos);
}
