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

/// One pixel.
struct ReceiverPoint {
	glm::vec3 position = glm::vec3(0.0f);
	/// Unit, on the side that is seen. Zero moves the start nowhere.
	glm::vec3 geometric_normal = glm::vec3(0.0f);
	bool is_receiver = false; // see LightShadow::receivers; otherwise v = 0 and no ray
	/// Above 0: light that leaves here entered about here, see VisibilityOptions::spread.
	float spread_radius_m = 0.0f;
};

struct VisibilityOptions {
	float scene_size_m = 1.0f;	  // S; rays start 5e-5 S off the surface
	uint32_t sample_count = 1024; // rays per pixel, 1..65536
	uint64_t seed = 0;
	uint32_t thread_count = 0; // 0 = one per core; the result does not depend on it
	/// Called with 0..1 now and then, from the calling thread only. May throw: compute() then
	/// stops.
	std::function<void(float)> progress;
	const std::atomic<bool> *is_cancelled = nullptr; // may be set from any thread
	/// For receivers with a spread radius. Null: they see the light as all others do.
	const SpreadVisibility *spread = nullptr;
};

struct VisibilityResult : ReferenceVisibility {
	uint64_t ray_count = 0;
	bool is_complete = false; // false when cancelled; pixels not reached are then 0
};

} // namespace gnomon
