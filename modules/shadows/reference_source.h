#pragma once

#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/surface_points.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

// Computes a light's exact mask in parallel with the frames: on any thread, without a GPU.

namespace gnomon {

struct ReferenceQuestion {
	std::shared_ptr<const SceneSnapshot> scene;
	LightSnapshot light; // a light of that scene
	glm::uvec2 size_px = glm::uvec2(0);
	std::vector<SurfacePoint> surfaces; // one per pixel, rows from the top
	std::vector<float> receiver;		// per pixel: 1, or 0 where the light does not reach
	/// See find_surface_spread; null: light leaves where it enters.
	std::shared_ptr<const SurfaceSpread> spread = nullptr;
};

struct ReferenceAnswer {
	std::vector<float> visibility; // per pixel, 0..1; 0 without a receiver
	float standard_error = 0;	   // of visibility in penumbra pixels; -1: unknown
	uint64_t penumbra_pixel_count = 0;
	bool is_complete = false; // false when cancelled: the values are not usable
};

/// Answers one question, each time with as many samples as requested. One thread at a time.
class ReferenceSource {
public:
	virtual ~ReferenceSource() = default;
	/// p_sample_count: rays per pixel, 1..65536. p_is_cancelled may be set from any thread and ends
	/// the trace soon. p_progress is called with 0..1 on the calling thread; it may be empty.
	/// Throws an Error for a question that cannot be answered.
	virtual ReferenceAnswer trace(uint32_t p_sample_count, const std::atomic<bool> &p_is_cancelled,
			const std::function<void(float)> &p_progress) = 0;
};

/// Hash of everything that the light's exact mask depends on, including the camera: equal hashes
/// mean equal masks.
uint64_t compute_reference_hash(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light, glm::uvec2 p_size_px);

} // namespace gnomon
