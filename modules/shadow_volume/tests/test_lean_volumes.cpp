// What shadow volumes skip: caps that z-pass spares, and edges that are known already.

#include "modules/shadow_volume/tests/volume_fixture.h"

#include <algorithm>

using namespace gnomon;

namespace {

const char CACHED[] = "cached: neither the light nor a caster moved";

bool has_reason(const MaskResult &p_result, const std::string &p_reason) {
	const auto &entries = p_result.plan.get_entries();
	return std::any_of(entries.begin(), entries.end(), [&](const FramePlanEntry &p_entry) {
		return !p_entry.runs && p_entry.reason.starts_with(p_reason);
	});
}

bool finds_edges(const MaskResult &p_result) {
	return std::any_of(p_result.timings.begin(), p_result.timings.end(),
			[](const PassTiming &p_timing) { return p_timing.name == "Light: find edges"; });
}

const VolumeWishes COMPUTE = { { "extrusion", std::string("compute") } };

} // namespace

TEST_CASE("[GPU][ShadowVolume] far caps are skipped where z-pass is safe, and nowhere else") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		SmallScene scene(type);
		scene.ground->casts_shadow = false;
		const glm::uvec2 size_px(96);
		const MaskResult lean = render_volumes(fixture, scene, {}, "shadow_volume", size_px);
		const MaskResult all = render_volumes(fixture, scene, {}, "shadow_volume", size_px, false);
		CHECK(lean.visibility == all.visibility);
		CHECK(lean.plan.is_skipped("Light", "far caps of 1 casters"));
		CHECK_FALSE(all.plan.is_skipped("Light", "far caps of 1 casters"));
		// In the box's shadow the near plane is hidden: caps are needed.
		scene.camera->parent_from_node = look_at({ -0.05, 0.5, -0.05 }, { -0.6, 0.1, -0.5 });
		const MaskResult within = render_volumes(fixture, scene, {}, "shadow_volume", size_px);
		CHECK_FALSE(has_reason(within, "z-pass is safe"));
		CHECK(within.visibility ==
				render_volumes(fixture, scene, {}, "shadow_volume", size_px, false).visibility);
	}
}

TEST_CASE("[GPU][ShadowVolume] edges of lights and casters at rest are found once, with one mask") {
	MaskFixture caching;
	MaskFixture fresh;
	SmallScene scene;
	const auto render = [&](bool p_is_known) {
		const MaskResult result = render_volumes(caching, scene, COMPUTE);
		const MaskResult all =
				render_volumes(fresh, scene, COMPUTE, "shadow_volume", glm::uvec2(128), false);
		CHECK(result.visibility == all.visibility);
		CHECK(finds_edges(all));
		CHECK(finds_edges(result) != p_is_known);
		CHECK(has_reason(result, CACHED) == p_is_known);
	};
	render(false);
	render(false); // it is at rest: from here on they are cached
	render(true);
	render(true);
	scene.camera->parent_from_node[3].x += 0.2; // the camera may move
	render(true);
	scene.light->parent_from_node[3].x += 0.2;
	render(false);
	render(false);
	render(true);
	scene.box->parent_from_node[3].y += 0.1;
	render(false);
	scene.box->parent_from_node[3].y += 0.1;
	render(false);
	render(false);
	render(true);
	scene.box->casts_shadow = false;
	render(false);
}
