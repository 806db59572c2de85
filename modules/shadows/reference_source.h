#pragma once

#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/surface_points.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

// A light's exact mask in parallel with the frames: on any thread, without a device.

namespace gnomon {

struct ReferenceQuestion {
	std::shared_ptr<const SceneSnapshot> scene;
	LightSnapshot light; // of that scene
	glm::uvec2 size_px = glm::uvec2(0);
	std::vector<SurfacePoint> surfaces; // one per pixel, rows from the top
	std::vector<float> receiver;		// 1, or 0 where the light does not reach
	/// See find_surface_spread; null: light leaves where it enters.
	std::shared_ptr<const SurfaceSpread> spread = nullptr;
};

struct ReferenceAnswer {
	std::vector<float> visibility; // 0..1; 0 where there is no receiver
	float standard_error = 0;	   // of visibility, over the penumbra pixels; -1: unknown
	uint64_t penumbra_pixel_count = 0;
	bool is_complete = false; // false when cancelled: of no use then
};

/// Answers one question, as often and as precisely as requested. One thread at a time.
class ReferenceSource {
public:
	virtual ~ReferenceSource() = default;
	/// p_sample_count: rays a pixel, 1..65536. p_is_cancelled may be set from any thread and ends
	/// the trace soon. p_progress gets 0..1 on the calling thread; may be empty. A question that
	/// cannot be answered is an Error.
	virtual ReferenceAnswer trace(uint32_t p_sample_count, const std::atomic<bool> &p_is_cancelled,
			const std::function<void(float)> &p_progress) = 0;
};

/// Of everything that the light's exact mask depends on, the camera included: equal hashes, equal
/// masks.
uint64_t compute_reference_hash(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light, glm::uvec2 p_size_px);

} // namespace gnomon
