#pragma once

#include "modules/renderer/tests/render_fixture.h"

// Helpers of the tests of doc/lean.md: a frame skips the passes that it does not need.

namespace gnomon {

/// Returns why the light was skipped; empty if it was not.
inline std::string find_skip_reason(const RenderResult &p_result, const std::string &p_light) {
	for (const FramePlanEntry &entry : p_result.plan.get_entries()) {
		if (entry.light == p_light && entry.pass == "light" && !entry.runs) {
			return entry.reason;
		}
	}
	return "";
}

/// A scene with a second light, a spot light whose cone reaches 46 degrees (0.8 rad) from its axis.
/// The camera looks down at the ground and the box.
struct TwoLights {
	SmallScene scene;
	Light3D &second;
	TwoLights() : second(scene.add_light("Second", LightType::SPOT, { 1, 3, 0 }, { 0, 0, 0 })) {}
	void aim_second_light(const glm::dvec3 &p_from, const glm::dvec3 &p_to) {
		second.parent_from_node = look_at(p_from, p_to);
	}
};

} // namespace gnomon
