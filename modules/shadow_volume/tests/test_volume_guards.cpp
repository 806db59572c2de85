// Tests extreme lights, casters and receivers: the mask must still match ray tracing.

#include "modules/shadow_volume/tests/volume_fixture.h"
#include "modules/shadows/tests/wide_world.h"

using namespace gnomon;

namespace {

/// Adds small casters all over the scene, some hidden and some not, for culling to classify.
void add_probes(SmallScene &r_scene) {
	const auto probe = make_box_mesh("probe", glm::vec3(0.012f));
	for (int i = 0; i < 125; ++i) {
		const glm::dvec3 position(i % 5 - 2, i / 5 % 5, i / 25 - 2);
		add_mesh(r_scene.scene, text("Probe ", i), probe,
				glm::dvec3(0.03, 0.1, -0.02) + position * glm::dvec3(0.36, 0.4, 0.36));
	}
}

/// Compares every light type with ray tracing, with culling and without. p_arrange changes the
/// scene first.
template <typename Arrange> void check_for_each_type(Arrange p_arrange) {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		p_arrange(scene);
		add_probes(scene);
		const MaskResult all =
				render_volumes(fixture, scene, { { "culling", std::string("off") } });
		check_against_rays(scene, all);
		// First the GPU's predicates cull casters, then the result that was read back.
		for (int frame = 0; frame < 2; ++frame) {
			CAPTURE(frame);
			CHECK(render_volumes(fixture, scene, { { "culling", std::string("on") } }).visibility ==
					all.visibility);
		}
	}
}

void place_light(SmallScene &r_scene, const glm::dvec3 &p_from, const glm::dvec3 &p_to) {
	r_scene.light->parent_from_node = look_at(p_from, p_to);
}

} // namespace

TEST_CASE("[GPU][ShadowVolume] scenes of any size and far from the origin give the same mask") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		const MaskResult first = [&] {
			SmallScene scene(type);
			return render_volumes(fixture, scene);
		}();
		const auto check_same = [&](SmallScene &&p_scene) {
			const MaskResult other = render_volumes(fixture, p_scene);
			CHECK(compute_mask_difference(first, other) < 3e-4);
			check_against_rays(p_scene, other);
		};
		check_same(SmallScene(type, 1e-3));
		check_same(SmallScene(type, 1e3));
		check_same(SmallScene(type, 1.0, glm::dvec3(1e5, -1e5, 1e5)));
	}
}

TEST_CASE("[GPU][ShadowVolume] tiny and large distances in one scene still match ray tracing") {
	check_for_each_type([](SmallScene &r_scene) {
		r_scene.camera->near_m = 4e-6f; // 1e-8 of the distance to the far box
		add_mesh(r_scene.scene, "Far", make_box_mesh("far", { 200.0f, 1.0f, 200.0f }),
				{ 0, -400, 0 });
	});
	check_for_each_type([](SmallScene &r_scene) {
		place_light(r_scene, { 0.2, 2.0, 0.1 }, { 0, 0, 0 });
		// 1 cm from the light
		add_mesh(
				r_scene.scene, "Mote", make_box_mesh("mote", glm::vec3(1e-5f)), { 0.2, 1.99, 0.1 });
	});
}

TEST_CASE("[GPU][ShadowVolume] in a world of 2 km a plate of 4 cm casts the shadow of rays") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		make_wide_world(scene);
		check_against_rays(scene, render_volumes(fixture, scene));
	}
}

TEST_CASE("[GPU][ShadowVolume] casters across the light's near plane or next to the light match "
		  "ray tracing") {
	check_for_each_type([](SmallScene &r_scene) {
		add_mesh(r_scene.scene, "Rod", make_box_mesh("rod", { 0.02f, 3.0f, 0.02f }),
				{ 1.22, 3.0, 0.85 });
	});
	// The light is below the box's top and next to it. Casters above are behind a spot light or
	// outside its cone.
	check_for_each_type([](SmallScene &r_scene) {
		place_light(r_scene, { 1.4, 0.9, 0.2 }, { 0, 0.2, 0 });
	});
}

TEST_CASE("[GPU][ShadowVolume] slivers, duplicates, collapsed faces and edges match ray tracing") {
	check_for_each_type([](SmallScene &r_scene) {
		Mesh mesh = test_meshes::make_cube();
		const uint32_t first = static_cast<uint32_t>(mesh.positions_node.size());
		for (const glm::vec3 &position :
				{ glm::vec3(0, 1, 0), glm::vec3(1, 1, 0), glm::vec3(2, 1, 0),
						glm::vec3(0.5f, 1, 1e-7f), glm::vec3(0, 1, 0), glm::vec3(0, 1, 2) }) {
			mesh.positions_node.push_back(position);
		}
		// Three points on a line, a sliver, a point, two equal corners, and one face three times,
		// the last one reversed.
		const std::vector<uint32_t> odd = { 0, 1, 2, 0, 1, 3, 0, 0, 0, 0, 4, 5, 0, 1, 5, 0, 1, 5, 5,
			1, 0 };
		for (const uint32_t index : odd) {
			mesh.indices.push_back(first + index);
		}
		for (const uint32_t index : { 0u, 2u, 3u }) { // a face of the cube once more
			mesh.indices.push_back(index);
		}
		MeshInstance3D &node =
				add_mesh(r_scene.scene, "Odd", share_mesh("odd", mesh), { 0.9, 0.7, 0.4 });
		node.parent_from_node = glm::scale(node.parent_from_node, glm::dvec3(0.3));
	});
}

TEST_CASE("[GPU][ShadowVolume] surfaces that coincide, touch or intersect match ray tracing") {
	check_for_each_type([](SmallScene &r_scene) {
		const auto box = make_box_mesh("twin", glm::vec3(0.5f, 0.3f, 0.4f));
		add_mesh(r_scene.scene, "Twin", box, { 0, 1.0, 0 });	 // the same box
		add_mesh(r_scene.scene, "On top", box, { 0.3, 1.6, 0 }); // face on face
		add_mesh(r_scene.scene, "On the floor", box, { -1.2, 0.3, 0.3 });
		add_mesh(r_scene.scene, "Half within", box, { -1.4, 0.2, -0.3 });
	});
}

TEST_CASE("[GPU][ShadowVolume] light that grazes the floor, and edges seen end-on, match rays") {
	check_for_each_type([](SmallScene &r_scene) {
		r_scene.box->parent_from_node = glm::translate(glm::dmat4(1.0), { 0.2, 0.31, 0 });
		place_light(r_scene, { 3.0, 0.12, 0.3 }, { 0, 0.02, 0 });
	});
	check_for_each_type([](SmallScene &r_scene) { // straight down
		r_scene.light->parent_from_node = glm::dmat4(glm::dvec4(1, 0, 0, 0),
				glm::dvec4(0, 0, -1, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0.5, 4, 0.4, 1));
	});
}

TEST_CASE("[GPU][ShadowVolume] the mask of a camera at the light matches ray tracing") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
		SmallScene scene(type);
		add_meshes(scene);
		scene.camera->parent_from_node = scene.light->parent_from_node;
		const MaskResult frame = render_volumes(fixture, scene);
		const HardDifference difference = HardReference(scene).compare(frame);
		CHECK(difference.receiver_count > 3000);
		CHECK(difference.unexplained_count == 0);
		CHECK(difference.wrong_count <= difference.receiver_count / 1000);
	}
}

TEST_CASE("[GPU][ShadowVolume] the plan reports an instance that is scaled to a line") {
	MaskFixture fixture;
	SmallScene scene;
	MeshInstance3D &flat =
			add_mesh(scene.scene, "Flat", make_box_mesh("flat", glm::vec3(0.3f)), { 1, 0.5, 0 });
	flat.parent_from_node = glm::scale(flat.parent_from_node, glm::dvec3(1, 0, 0));
	const MaskResult frame = render_volumes(fixture, scene);
	CHECK(frame.plan.to_text().find("collapses them to a line or a point") != std::string::npos);
}
