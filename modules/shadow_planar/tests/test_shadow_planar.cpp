#include "modules/shadow_planar/receiver_planes.h"
#include "modules/shadows/tests/hard_reference.h"
#include "modules/shadows/tests/wide_world.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

const uint32_t SIZE_PX = 128;

MaskResult render_planar(
		MaskFixture &r_fixture, const SmallScene &p_scene, bool p_may_skip = true) {
	MaskRequest request;
	request.scene = p_scene.snap();
	request.size_px = glm::uvec2(SIZE_PX);
	request.technique_override = "planar";
	request.light = p_scene.light->name;
	request.wants_surfaces = true;
	request.may_skip = p_may_skip;
	MaskResult result = r_fixture.render(request);
	CHECK(is_valid_mask(result));
	return result;
}

/// Compares the mask on the floor's top, which is at y = 0, with rays to the light.
HardDifference compare_floor(const SmallScene &p_scene, const MaskResult &p_frame) {
	const double camera_height = p_scene.snap()->camera.position_world.y;
	return HardReference(p_scene).compare(p_frame, [&](const SurfacePoint &p_surface) {
		return std::abs(p_surface.position.y + camera_height) < 1e-3 && // in metres
				p_surface.geometric_normal.y > 0.99f;
	});
}

/// Checks that at most one in 1000 receivers differs, and only where rounding may decide.
void check_floor(const SmallScene &p_scene, const MaskResult &p_frame) {
	const HardDifference difference = compare_floor(p_scene, p_frame);
	CHECK(difference.receiver_count > 3000); // of 128 x 128 pixels
	CHECK(difference.hidden_count > 50);	 // the floor has a shadow
	CHECK(difference.wrong_count <= difference.receiver_count / 1000);
	CHECK(difference.unexplained_count == 0);
}

bool plan_contains(const MaskResult &p_frame, const char *p_text) {
	return p_frame.plan.to_text().find(p_text) != std::string::npos;
}

} // namespace

TEST_CASE("[GPU][ShadowPlanar] on a declared floor the mask is that of traced rays") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		add_mesh(scene.scene, "Upper", make_box_mesh("upper", glm::vec3(0.3f, 0.1f, 0.2f)),
				{ 0.2, 1.8, 0.1 }); // its shadow overlaps the box's
		const MaskResult frame = render_planar(fixture, scene);
		check_floor(scene, frame);
		CHECK(plan_contains(frame, "planes: "));
		CHECK(plan_contains(frame, "shadows on 2 other meshes"));
		CHECK(render_planar(fixture, scene, /*p_may_skip=*/false).visibility == frame.visibility);
	}
}

TEST_CASE("[GPU][ShadowPlanar] casters behind the plane and above the light hide nothing") {
	MaskFixture fixture;
	SmallScene scene(LightType::OMNI);
	const MaskResult before = render_planar(fixture, scene);
	add_mesh(scene.scene, "Cellar", make_box_mesh("cellar", glm::vec3(0.6f, 0.1f, 0.6f)),
			{ 0.6, -1.0, 0.4 });
	add_mesh(scene.scene, "Ceiling", make_box_mesh("ceiling", glm::vec3(2.0f, 0.1f, 2.0f)),
			{ 0, 5.0, 0 });
	CHECK(render_planar(fixture, scene).visibility == before.visibility);
	// Through the floor, and up to above the light.
	add_mesh(scene.scene, "Post", make_box_mesh("post", glm::vec3(0.1f, 6.0f, 0.1f)),
			{ -0.8, 0, -0.6 });
	check_floor(scene, render_planar(fixture, scene));
}

TEST_CASE("[GPU][ShadowPlanar] scenes without declared planes or with a curved one are reported") {
	MaskFixture fixture;
	SmallScene undeclared;
	undeclared.ground->is_planar_receiver = false;
	const MaskResult none = render_planar(fixture, undeclared);
	CHECK(plan_contains(none, "no node has shadow_planar_receiver"));
	CHECK(count_receivers(none) > 0);
	CHECK(std::count(none.visibility.begin(), none.visibility.end(), 1.0f) >=
			ptrdiff_t(count_receivers(none)));
	SmallScene curved; // the floor is an arch of 100 strips
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	for (uint32_t step = 0; step <= 100; ++step) {
		const float angle_rad = 0.0314159f * float(step); // pi / 100 per strip
		positions.push_back({ 3 * std::cos(angle_rad), 0.3f * std::sin(angle_rad), -3 });
		positions.push_back({ 3 * std::cos(angle_rad), 0.3f * std::sin(angle_rad), 3 });
		if (step > 0) {
			const uint32_t a = 2 * step - 2;
			indices.insert(indices.end(), { a, a + 2, a + 1, a + 2, a + 3, a + 1 });
		}
	}
	curved.ground->surfaces[0].mesh = make_mesh("arch", positions, {}, indices);
	CHECK(plan_contains(render_planar(fixture, curved), "they are curved"));
}

TEST_CASE("[GPU][ShadowPlanar] the mask does not depend on scale, nor on the distance from the "
		  "origin") {
	constexpr double MAX_DIFFERENCE = 2e-4; // at most 3 of the 128 x 128 pixels
	MaskFixture fixture;
	const MaskResult first = render_planar(fixture, SmallScene());
	for (const double scale : { 1e-3, 1e3 }) {
		CAPTURE(scale);
		CHECK(compute_mask_difference(first,
					  render_planar(fixture, SmallScene(LightType::SPOT, scale))) < MAX_DIFFERENCE);
	}
	CHECK(compute_mask_difference(first,
				  render_planar(
						  fixture, SmallScene(LightType::SPOT, 1.0, glm::dvec3(1e5, -1e5, 1e5)))) <
			MAX_DIFFERENCE);
}

TEST_CASE("[GPU][ShadowPlanar] in a world of 2 km a plate of 4 cm casts the shadow of rays") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		make_wide_world(scene);
		check_floor(scene, render_planar(fixture, scene));
	}
}

TEST_CASE("[ShadowPlanar] only planes that face the light are found") {
	SmallScene scene(LightType::OMNI);
	const auto snapshot = scene.snap();
	const ReceiverPlanes found = find_receiver_planes(*snapshot, snapshot->lights[0]);
	REQUIRE(found.planes.size() == 1); // only the top of the floor's box faces the light
	CHECK(found.planes[0].area_m2 == doctest::Approx(36.0)); // 6 m x 6 m
	CHECK(found.planes[0].normal.y == doctest::Approx(1.0));
	CHECK(found.planes[0].offset_m == doctest::Approx(snapshot->camera.position_world.y));
	CHECK(compute_light_height(found.planes[0], snapshot->lights[0], snapshot->camera) ==
			doctest::Approx(4.0)); // the light is at y = 4 m, the floor's top at 0
	// The light sees the top and two sides of the box.
	scene.box->is_planar_receiver = true;
	const auto both = scene.snap();
	CHECK(find_receiver_planes(*both, both->lights[0]).planes.size() == 4);
	// A light below the floor lights its lower side.
	scene.light->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, -3, 0.1));
	scene.box->is_planar_receiver = false;
	const auto below = scene.snap();
	const ReceiverPlanes lower = find_receiver_planes(*below, below->lights[0]);
	REQUIRE(lower.planes.size() == 1);
	CHECK(lower.planes[0].normal.y == doctest::Approx(-1.0));
}

TEST_CASE("[ShadowPlanar] far from the origin a tilted floor of many faces is still one plane") {
	for (const double far_m : { 0.0, 1e5 }) {
		CAPTURE(far_m);
		SmallScene scene(LightType::OMNI, 1.0, glm::dvec3(far_m, -far_m, far_m));
		std::vector<glm::vec3> positions;
		std::vector<uint32_t> indices;
		for (uint32_t index = 0; index < 36; ++index) { // 6 x 6 corners
			positions.push_back({ 0.37f * float(index % 6) - 1, 0, 0.41f * float(index / 6) - 1 });
			if (index % 6 < 5 && index / 6 < 5) {
				indices.insert(indices.end(),
						{ index, index + 6, index + 1, index + 1, index + 6, index + 7 });
			}
		}
		scene.ground->surfaces[0].mesh = make_mesh("tiles", positions, {}, indices);
		scene.ground->parent_from_node =
				glm::rotate(scene.ground->parent_from_node, 0.31, glm::dvec3(0.6, 0.5, 0.4));
		// The light is low over the floor, compared with its distance from the origin.
		scene.light->parent_from_node = scene.ground->parent_from_node *
				glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 0.05, 0.1));
		const auto snapshot = scene.snap();
		const ReceiverPlanes found = find_receiver_planes(*snapshot, snapshot->lights[0]);
		REQUIRE(found.planes.size() == 1);
		CHECK(found.planes[0].area_m2 == doctest::Approx(25 * 0.37 * 0.41));
	}
}
