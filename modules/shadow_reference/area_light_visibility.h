#pragma once

#include "modules/shadow_reference/light_disc.h"
#include "modules/shadow_reference/reference_entry.h"

#include <glm/glm.hpp>

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace gnomon {

class SpreadVisibility;

/// The surface point at one pixel, in metres, in the space of the triangles.
struct ReceiverPoint {
	glm::vec3 position = glm::vec3(0.0f);
	/// Unit normal on the side that the camera sees. When it is zero, rays start at the position
	/// itself.
	glm::vec3 geometric_normal = glm::vec3(0.0f);
	bool is_receiver = false; // false: visibility 0, no rays; see LightShadow::receivers
	/// Above 0: light that leaves here entered the surface around here (subsurface scattering). The
	/// result of SurfaceSpread::compute_radius_m; see VisibilityOptions::spread.
	float spread_radius_m = 0.0f;
	float offset_m = 0.0f; // rays start this far off the surface, see frame_shared.h
};

/// Parameters of CasterScene::compute (caster_scene.h).
struct VisibilityOptions {
	uint32_t sample_count = 1024; // rays per pixel, 1..65536
	uint64_t seed = 0;
	uint32_t thread_count = 0; // 0 = one per core; the result does not depend on it
	/// Called from time to time with the completed fraction, 0..1, on the calling thread only. If
	/// it throws, compute() stops and rethrows.
	std::function<void(float)> progress;
	const std::atomic<bool> *is_cancelled = nullptr; // may be set from any thread
	/// Computes the visibility of receivers with a spread radius. Null: these are treated like all
	/// others.
	const SpreadVisibility *spread = nullptr;
};

/// Result of CasterScene::compute (caster_scene.h).
struct VisibilityResult : ReferenceVisibility {
	uint64_t ray_count = 0;
	bool is_complete = false; // false when cancelled; pixels not reached are then 0
};

} // namespace gnomon
