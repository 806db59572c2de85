#pragma once

#include "modules/shadow_reference/embree_header.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace gnomon {

struct SurfaceHit {
	bool is_there = false;
	float distance = 0.0f;
	glm::vec3 normal = glm::vec3(0.0f); // unit, of the triangle, on either side; 0 of a flat one
};

/// Owns an Embree device and one scene of triangles: robust (no ray slips through a shared edge),
/// built for fast tracing. Rays may be traced from several threads.
class EmbreeScene {
public:
	/// See AreaLightVisibility.
	EmbreeScene(
			std::span<const glm::vec3> p_positions, std::span<const uint32_t> p_triangle_indices);
	~EmbreeScene();
	EmbreeScene(const EmbreeScene &) = delete;
	EmbreeScene &operator=(const EmbreeScene &) = delete;

	RTCScene get() const { return scene; }
	/// p_direction: unit; hits at 0..p_reach_m count.
	SurfaceHit find_nearest(
			const glm::vec3 &p_origin, const glm::vec3 &p_direction, float p_reach_m) const;
	/// Is there anything between the origin and p_end times the ray?
	bool is_occluded(const glm::vec3 &p_origin, const glm::vec3 &p_ray, float p_end) const;

private:
	RTCDevice device = nullptr;
	RTCScene scene = nullptr;

	void build(
			std::span<const glm::vec3> p_positions, std::span<const uint32_t> p_triangle_indices);
	void check() const;
	void release();
};

} // namespace gnomon
