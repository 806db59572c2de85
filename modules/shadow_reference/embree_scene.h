#pragma once

#include "modules/scene/alpha_test.h"
#include "modules/shadow_reference/embree_header.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace gnomon {

struct SurfaceHit {
	bool is_there = false;
	float distance = 0.0f;
	glm::vec3 normal = glm::vec3(0.0f); // unit, of the triangle, on either side; 0 of a flat one
};

/// Triangles, relative to an origin near the camera, so that float32 suffices; three indices each.
struct Triangles {
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
};

/// Triangles with holes: rays meet them where their alpha is at least a cutoff.
struct CutOutTriangles {
	Triangles triangles;
	std::vector<glm::vec2> uvs;			// one a position, of the image
	std::vector<float> alphas;			// one a position; times the image's
	std::shared_ptr<const Image> image; // null: no other alpha
	AlphaTest test;						// of the image

	/// At barycentric coordinates of the second and third corner.
	bool is_there(uint32_t p_triangle, float p_u, float p_v) const;
};

/// A scene of triangles: robust (no ray slips through a shared edge), built for fast tracing. Rays
/// may be traced from several threads. All scenes share one Embree device.
class EmbreeScene {
public:
	/// See CasterScene.
	EmbreeScene(std::span<const glm::vec3> p_positions,
			std::span<const uint32_t> p_triangle_indices,
			std::span<const CutOutTriangles> p_cut_out = {});
	/// A geometry for each, whose hits are recorded and do not count (record_crossing).
	static EmbreeScene make_crossed(std::span<const Triangles *const> p_geometries);
	~EmbreeScene();
	EmbreeScene(EmbreeScene &&) noexcept;
	EmbreeScene &operator=(EmbreeScene &&) = delete;

	RTCScene get() const { return scene; }
	/// p_direction: unit; hits at 0..p_reach_m count.
	SurfaceHit find_nearest(
			const glm::vec3 &p_origin, const glm::vec3 &p_direction, float p_reach_m) const;
	/// Is there anything between the origin and p_end times the ray?
	bool is_occluded(const glm::vec3 &p_origin, const glm::vec3 &p_ray, float p_end) const;

private:
	EmbreeScene();
	enum class Hits { COUNT, RECORD };
	void add(std::span<const glm::vec3> p_positions, std::span<const uint32_t> p_triangle_indices,
			Hits p_hits, const CutOutTriangles *p_cut_out = nullptr);
	void finish();
	void check() const;

	std::shared_ptr<RTCDeviceTy> device;
	RTCScene scene = nullptr;
	std::vector<std::unique_ptr<const CutOutTriangles>> cut_out; // their filters read them
};

} // namespace gnomon
