// Tests what shadow volumes skip: far caps with z-pass, and the search for edges that are cached.

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

const VolumeSettingValues COMPUTE = { { "extrusion", std::string("compute") } };
const bool SKIP_NOTHING = false; // value of p_may_skip of render_volumes

} // namespace

TEST_CASE("[GPU][ShadowVolume] far caps are skipped where z-pass is safe, and nowhere else") {
	MaskFixture fixture;
	for (const LightType type : ALL_TYPES) {
		SmallScene scene(type);
		scene.ground->casts_shadow = false;
		const glm::uvec2 size_px(96);
		const MaskResult lean = render_volumes(fixture, scene, {}, "shadow_volume", size_px);
		const MaskResult all =
				render_volumes(fixture, scene, {}, "shadow_volume", size_px, SKIP_NOTHING);
		CHECK(lean.visibility == all.visibility);
		CHECK(lean.plan.is_skipped("Light", "far caps of 1 casters"));
		CHECK_FALSE(all.plan.is_skipped("Light", "far caps of 1 casters"));
		// The camera is in the box's shadow, so its near plane is inside the shadow volume: caps
		// are needed.
		scene.camera->parent_from_node = look_at({ -0.05, 0.5, -0.05 }, { -0.6, 0.1, -0.5 });
		const MaskResult within = render_volumes(fixture, scene, {}, "shadow_volume", size_px);
		CHECK_FALSE(has_reason(within, "z-pass is safe"));
		CHECK(within.visibility ==
				render_volumes(fixture, scene, {}, "shadow_volume", size_px, SKIP_NOTHING)
						.visibility);
	}
}

TEST_CASE("[GPU][ShadowVolume] edges are cached while light and casters rest, with the same mask") {
	MaskFixture caching;
	MaskFixture fresh;
	SmallScene scene;
	// Draws a frame and checks whether it searches edges or uses cached ones. After a change two
	// frames search them, and the second, in which nothing has moved, stores them.
	enum class Edges { SEARCHED, CACHED };
	const auto check_frame = [&](Edges p_edges) {
		const bool is_cached = p_edges == Edges::CACHED;
		const MaskResult result = render_volumes(caching, scene, COMPUTE);
		const MaskResult all = render_volumes(
				fresh, scene, COMPUTE, "shadow_volume", glm::uvec2(128), SKIP_NOTHING);
		CHECK(result.visibility == all.visibility);
		CHECK(finds_edges(all));
		CHECK(finds_edges(result) != is_cached);
		CHECK(has_reason(result, CACHED) == is_cached);
	};
	check_frame(Edges::SEARCHED);
	check_frame(Edges::SEARCHED);
	check_frame(Edges::CACHED);
	check_frame(Edges::CACHED);
	scene.camera->parent_from_node[3].x += 0.2; // the camera may move
	check_frame(Edges::CACHED);
	scene.light->parent_from_node[3].x += 0.2;
	check_frame(Edges::SEARCHED);
	check_frame(Edges::SEARCHED);
	check_frame(Edges::CACHED);
	scene.box->parent_from_node[3].y += 0.1;
	check_frame(Edges::SEARCHED);
	scene.box->parent_from_node[3].y += 0.1;
	check_frame(Edges::SEARCHED);
	check_frame(Edges::SEARCHED);
	check_frame(Edges::CACHED);
	scene.box->casts_shadow = false;
	check_frame(Edges::SEARCHED);
}
