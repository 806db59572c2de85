// Casters of a light with too many triangles for the device: only those are recorded whose shadows
// may reach what the camera sees. Masks are equal.

#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

using namespace gnomon;

namespace {

/// edge_count on a device with room for few triangles.
class SmallEdgeCount : public ShadowEdgeCount {
protected:
	CasterLimits find_caster_limits(const RenderingDevice & /*p_device*/) const override {
		return limits;
	}

public:
	static inline CasterLimits limits;
};

/// A field of boxes about the small scene, of which the camera sees a part.
void add_boxes(SmallScene &r_scene) {
	const auto mesh = make_box_mesh("post", glm::vec3(0.2f, 0.8f, 0.2f));
	for (int row = -7; row <= 7; ++row) {
		for (int column = -7; column <= 7; ++column) {
			add_mesh(r_scene.scene, "Post", mesh,
					{ 1.3 * column + 0.4, 0.1 * row, 1.3 * row + 0.3 });
		}
	}
}

bool skips_casters(const FramePlan &p_plan) {
	return p_plan.to_text().find("their shadows reach nothing that the camera sees") !=
			std::string::npos;
}

} // namespace

TEST_CASE("[GPU][EdgeCount] casters whose shadows reach nothing visible are skipped if all do not "
		  "fit") {
	// 227 boxes have 12 faces each, and 18 edges of which 6 are inside flat sides.
	CasterLimits limits;
	SUBCASE("too many faces") {
		limits = { 12 * 200, 1000000 };
	}
	SUBCASE("too many edges") {
		limits = { 1000000, 18 * 200 };
	}
	MaskFixture fixture;
	for (const double angle_deg : { 0.0, 0.5, 20.0 }) {
		CAPTURE(angle_deg);
		SmallScene scene(LightType::DIRECTIONAL);
		add_boxes(scene);
		scene.light->properties["light_angular_distance"] = angle_deg;
		scene.light->parent_from_node = look_at({ 3.0, 2.0, 0.5 }, { 0, 0, 0 });
		std::vector<MaskResult> expected;
		std::vector<MaskResult> limited;
		const glm::dvec3 views[] = { { -2.4, 3.6, 3.4 }, { -2.3, 3.6, 3.4 }, { 3.0, 1.0, -2.0 } };
		const auto render_all = [&](std::vector<MaskResult> &r_masks) {
			for (const glm::dvec3 &from : views) {
				scene.camera->parent_from_node = look_at(from, { -0.2, 0.3, -0.1 });
				r_masks.push_back(render_frame(fixture, scene));
			}
		};
		render_all(expected);
		{
			const ReplacedTechnique<SmallEdgeCount> technique;
			SmallEdgeCount::limits = limits;
			render_all(limited);
		}
		for (size_t view = 0; view < std::size(views); ++view) {
			CAPTURE(view);
			CHECK_FALSE(skips_casters(expected[view].plan));
			// The second view is so close to the first that no casters are searched for again.
			CHECK(skips_casters(limited[view].plan) == (view != 1));
			CHECK(limited[view].visibility == expected[view].visibility);
		}
	}
}

TEST_CASE("[EdgeCount] a caster is recorded if it is before a visible receiver, seen from the "
		  "light") {
	SmallScene scene(LightType::DIRECTIONAL);
	scene.light->parent_from_node = look_at({ 0, 4, 0 }, { 0, 0, 0 });
	const auto mesh = make_box_mesh("cube", glm::vec3(0.1f));
	const glm::dvec3 positions[] = { { 0, 2, 0 }, { 2.2, 2, 0 }, { 0, -2, 0 }, { 60, 2, 0 } };
	for (const glm::dvec3 &position : positions) {
		add_mesh(scene.scene, "Cube", mesh, position);
	}
	const auto snapshot = scene.snap();
	const VisibleReceiver receiver = { 0, { glm::dvec3(-1, 0, -1), glm::dvec3(1, 0.1, 1) } };
	LightView view;
	view.is_orthographic = true;
	view.view_from_world = glm::dmat4(glm::transpose(
			glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0))));
	CHECK((view.view_from_world * glm::dvec4(0, 4, 0, 1)).z < 0); // z grows away from the light
	const std::vector<uint32_t> all = { 2, 3, 4, 5 };
	const auto find = [&](double p_disc_radius, double p_margin_m) {
		const ShadowedView shadowed = { view, p_disc_radius, std::span(&receiver, 1),
			make_camera_view(snapshot->camera, glm::uvec2(64)) };
		return find_shadowing_casters(*snapshot, shadowed, all, p_margin_m);
	};
	CHECK(find(0.0, 0.0) == std::vector<uint32_t>{ 2 });
	CHECK(find(1.0, 0.0) == std::vector<uint32_t>{ 2, 3 }); // its penumbra is wide
	CHECK(find(0.0, 1.5) == std::vector<uint32_t>{ 2, 3 });
	CHECK(find(0.0, 2.5) == std::vector<uint32_t>{ 2, 3, 4 });
	// A camera that looks along x from x = 1.5: only what comes near its view is recorded.
	scene.camera->parent_from_node = look_at({ 1.5, 0, 0 }, { 9, 0, 0 });
	auto ahead = scene.snap();
	const ShadowedView shadowed = { view, /*disc_radius=*/0.0, std::span(&receiver, 1),
		make_camera_view(ahead->camera, glm::uvec2(64)) };
	CHECK(find_shadowing_casters(*ahead, shadowed, all, /*p_margin_m=*/0.0).empty());
	CHECK(find_shadowing_casters(*ahead, shadowed, all, /*p_margin_m=*/1.8) ==
			std::vector<uint32_t>{ 2, 3 });
}
