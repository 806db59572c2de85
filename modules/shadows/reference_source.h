#pragma once

#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/surface_points.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

// Computes a light's reference mask on the CPU, on any thread, in parallel with the frames.

namespace gnomon {

/// The light and the surfaces of which a reference mask is to be computed. Layers
/// (LightSnapshot::caster_layers, InstanceSnapshot::layers) are not considered: all instances with
/// casts_shadow cast. If the scene uses layers, pass the scene of SceneSnapshot::select_casters.
struct ReferenceRequest {
	std::shared_ptr<const SceneSnapshot> scene;
	LightSnapshot light; // a light of that scene
	glm::uvec2 size_px = glm::uvec2(0);
	std::vector<SurfacePoint> surfaces; // one per pixel, rows from the top
	std::vector<float> receiver;		// per pixel: 1, or 0 where the light does not reach
	/// Subsurface scattering, see find_surface_spread. Null: light leaves where it enters.
	std::shared_ptr<const SurfaceSpread> spread = nullptr;
};

/// The reference mask and its error.
struct ReferenceResult {
	/// Per pixel, 0..1; 0 without a receiver. With translucent casters, the luminance of the RGB
	/// visibility.
	std::vector<float> visibility;
	float standard_error = 0; // of visibility in penumbra pixels; -1: unknown
	uint64_t penumbra_pixel_count = 0;
	bool is_complete = false; // false when cancelled: the values are not usable
};

/// Computes the mask for one ReferenceRequest. trace() may be called repeatedly, with different
/// sample counts, but only by one thread at a time.
class ReferenceSource {
public:
	virtual ~ReferenceSource() = default;
	/// p_sample_count: rays per pixel, 1..65536. p_is_cancelled may be set from any thread and ends
	/// the trace soon. p_progress is called with 0..1 on the calling thread; it may be empty.
	/// Throws an Error when the mask cannot be computed.
	virtual ReferenceResult trace(uint32_t p_sample_count, const std::atomic<bool> &p_is_cancelled,
			const std::function<void(float)> &p_progress) = 0;
};

/// Hash of everything that the light's reference mask depends on, including the camera, except the
/// number of rays: with the same number, equal hashes mean equal masks. Like the mask, it does not
/// consider layers, see ReferenceRequest.
uint64_t compute_reference_hash(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light, glm::uvec2 p_size_px);

} // namespace gnomon
