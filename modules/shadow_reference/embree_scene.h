#pragma once

#include "modules/scene/alpha_test.h"
#include "modules/shadow_reference/embree_header.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace gnomon {

/// Result of EmbreeScene::find_nearest.
struct SurfaceHit {
	bool is_hit = false;
	float distance = 0.0f; // metres
	/// Unit normal of the triangle, on either of its sides; 0 for a triangle without area.
	glm::vec3 normal = glm::vec3(0.0f);
};

/// A triangle mesh with three indices per triangle. Positions are relative to an origin near the
/// camera, so that float32 suffices.
struct Triangles {
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
};

/// Triangles with holes: rays hit them only where their alpha is at least the cutoff.
struct CutOutTriangles {
	Triangles triangles;
	std::vector<glm::vec2> uvs;			// per position, for the image
	std::vector<float> alphas;			// per position, multiplied by the image's alpha
	std::shared_ptr<const Image> image; // null: alpha 1
	AlphaTest test;						// cutoff, and how the image is sampled

	/// True when a ray hits the triangle, and not a hole, at the barycentric coordinates p_u and
	/// p_v of its second and third corner.
	bool is_hit(uint32_t p_triangle, float p_u, float p_v) const;
};

/// A scene of triangles: robust (no ray slips through a shared edge), built for fast tracing. Rays
/// may be traced from several threads. All scenes share one Embree device.
class EmbreeScene {
public:
	/// Parameters and errors as for CasterScene.
	EmbreeScene(std::span<const glm::vec3> p_positions,
			std::span<const uint32_t> p_triangle_indices,
			std::span<const CutOutTriangles> p_cut_out = {});
	/// Makes a scene with one geometry per element. Rays are not blocked in it: they record which
	/// geometries they hit, see find_crossings_8.
	static EmbreeScene make_recording_scene(std::span<const Triangles *const> p_geometries);
	~EmbreeScene();
	EmbreeScene(EmbreeScene &&) noexcept;
	EmbreeScene &operator=(EmbreeScene &&) = delete;

	RTCScene get() const { return scene; }
	/// Returns the nearest hit at a distance of 0..p_reach_m in p_direction (unit).
	SurfaceHit find_nearest(
			const glm::vec3 &p_origin, const glm::vec3 &p_direction, float p_reach_m) const;
	/// True when a triangle is hit between p_origin and p_origin + p_end * p_ray.
	bool is_occluded(const glm::vec3 &p_origin, const glm::vec3 &p_ray, float p_end) const;

private:
	EmbreeScene();
	enum class HitMode { OCCLUDE, RECORD };
	void add(std::span<const glm::vec3> p_positions, std::span<const uint32_t> p_triangle_indices,
			HitMode p_hit_mode, const CutOutTriangles *p_cut_out = nullptr);
	void finish();
	void check() const;

	std::shared_ptr<RTCDeviceTy> device;
	RTCScene scene = nullptr;
	std::vector<std::unique_ptr<const CutOutTriangles>> cut_out; // read by the filter functions
};

} // namespace gnomon
