// Tests which light views shadow_map and views skip because the camera sees no receiver in them.

#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;

namespace {

const char NO_RECEIVERS[] = "the camera sees no receiver in it";

/// An omni light in a room with four walls, and a camera that looks at the wall towards +x.
SmallScene make_room() {
	SmallScene scene(LightType::OMNI);
	scene.light->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 1, 0));
	scene.box->surfaces.clear();
	for (const double side : { -1.0, 1.0 }) {
		add_mesh(scene.scene, "Wall x", make_box_mesh("x", { 0.1f, 2, 2 }), { 2 * side, 1, 0 });
		add_mesh(scene.scene, "Wall z", make_box_mesh("z", { 2, 2, 0.1f }), { 0, 1, 2 * side });
	}
	add_mesh(scene.scene, "Caster", make_box_mesh("caster", glm::vec3(0.2f)), { 1, 1, 0 });
	scene.camera->parent_from_node = look_at({ 0, 1.2, 0 }, { 1, 1.1, 0 });
	scene.camera->vertical_fov_rad = 0.5f;
	return scene;
}

size_t count_skipped(const MaskResult &p_result, const std::string &p_reason) {
	const auto &entries = p_result.plan.get_entries();
	return static_cast<size_t>(
			std::count_if(entries.begin(), entries.end(), [&](const FramePlanEntry &p_entry) {
				return !p_entry.runs && p_entry.reason == p_reason;
			}));
}

} // namespace

TEST_CASE("[GPU][ShadowMap] views in which the camera sees no receiver are skipped") {
	for (const std::string id : { "shadow_map", "views" }) {
		CAPTURE(id);
		MaskFixture fixture;
		SmallScene scene = make_room();
		scene.light->properties["light_size"] = 0.0; // one point
		const MaskResult lean = fixture.render_mask(scene, id);
		// Only the wall towards +x is visible: the other five views are not needed.
		CHECK(count_skipped(lean, NO_RECEIVERS) == 5);
		const MaskResult all = fixture.render_mask(scene, id, glm::uvec2(64), /*p_may_skip=*/false);
		CHECK(count_skipped(all, NO_RECEIVERS) == 0);
		// From above all walls and the ground are visible, but nothing above the light.
		scene.camera->parent_from_node = look_at({ 0.5, 12, 0.5 }, { 0, 0, 0 });
		scene.camera->vertical_fov_rad = 1.0f;
		const MaskResult wide = fixture.render_mask(scene, id);
		CHECK(count_skipped(wide, NO_RECEIVERS) + count_skipped(wide, "no casters") <= 1);
	}
}

TEST_CASE("[GPU][ShadowMap] a skipped view's map is still cached when the camera turns back") {
	MaskFixture fixture;
	SmallScene scene = make_room();
	const auto look = [&](double p_x) {
		scene.camera->parent_from_node = look_at({ 0, 1.2, 0 }, { p_x, 1.1, 0 });
		return count_skipped(fixture.render_mask(scene, "shadow_map"),
				"cached: neither the light nor a caster moved");
	};
	CHECK(look(1) == 0);
	CHECK(look(-1) == 0); // another view
	CHECK(look(1) == 1);
	CHECK(look(-1) == 1);
}
