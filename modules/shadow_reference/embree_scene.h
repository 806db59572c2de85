#pragma once

#include "modules/shadow_reference/embree_header.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace gnomon {

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

private:
	RTCDevice device = nullptr;
	RTCScene scene = nullptr;

	void build(
			std::span<const glm::vec3> p_positions, std::span<const uint32_t> p_triangle_indices);
	void check() const;
	void release();
};

} // namespace gnomon
