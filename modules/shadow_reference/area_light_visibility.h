#pragma once

#include "modules/shadow_reference/light_disc.h"

#include <glm/glm.hpp>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace gnomon {

class CasterScene;
class SpreadVisibility;
struct TranslucentTriangles;

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

struct VisibilityResult {
	/// v in 0..1, one per pixel. 0 where nothing was asked.
	std::vector<float> visibility;
	/// Where casters are translucent: of each colour; visibility is then its luminance. Else empty.
	std::vector<glm::vec3> colors;
	/// Of the mean over all samples: root mean square over the penumbra pixels (0.002 < v < 0.998)
	/// of |A - B| sqrt(a b) / (a + b), where A and B are the means of the pixel's two halves of a
	/// and b samples. The halves are scrambled independently, so the estimate is unbiased (halves
	/// of one stratified set would fill each other's gaps and overstate it). 0 without penumbra
	/// pixels or for a hard shadow; -1, unknown, for a single sample.
	float standard_error = 0.0f;
	uint64_t penumbra_pixel_count = 0;
	uint64_t ray_count = 0;
	bool is_complete = false; // false when cancelled; pixels not reached are then 0
};

/// The definition of truth (exact area-light visibility, float32): the share of the rays from P,
/// moved by 5e-5 S along its geometric normal, to stratified points of the light's disc that meet
/// no triangle. Triangles have two sides. Those at the disc and behind it do not occlude.
class AreaLightVisibility {
public:
	/// Three indices per triangle. Positions relative to an origin near the camera, so that float32
	/// suffices. Triangles with a position that is not finite are left out; an index out of range
	/// is our mistake. Embree failing is an Error.
	/// p_translucent: each leaves its part of the rays that meet it; several multiply.
	AreaLightVisibility(std::span<const glm::vec3> p_positions,
			std::span<const uint32_t> p_triangle_indices,
			std::span<const TranslucentTriangles> p_translucent = {});
	~AreaLightVisibility();
	AreaLightVisibility(AreaLightVisibility &&) noexcept;
	AreaLightVisibility &operator=(AreaLightVisibility &&) noexcept;

	/// One v per point; points are the rows of an image of p_size_px. A light or an option out of
	/// range is an Error. A point that is not finite, or whose normal is not, has v = 0; one
	/// exactly on the light has v = 1. May be called from several threads.
	VisibilityResult compute(std::span<const ReceiverPoint> p_points, const glm::uvec2 &p_size_px,
			const AreaLight &p_light, const VisibilityOptions &p_options) const;

private:
	std::unique_ptr<CasterScene> scene;
};

} // namespace gnomon
