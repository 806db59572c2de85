#pragma once

#include "modules/shadow_reference/area_light_visibility.h"
#include "modules/shadow_reference/embree_scene.h"

#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// A translucent body. A ray that meets its triangles, once or more often, is multiplied by the
/// transmittance.
struct TranslucentTriangles {
	Triangles triangles;
	glm::vec3 transmittance = glm::vec3(0.0f); // RGB, 0..1
};

/// Sets one ray of eight, from p_origin to p_origin + p_end * p_ray. The other fields of r_rays
/// must be 0.
void set_ray(RTCRay8 &r_rays, uint32_t p_lane, const glm::vec3 &p_origin, const glm::vec3 &p_ray,
		float p_end);

/// All shadow casters of a scene, for tracing rays towards lights.
class CasterScene {
public:
	/// p_triangle_indices: three per triangle. Positions are relative to an origin near the camera,
	/// so that float32 suffices. Triangles with a position that is not finite are skipped; an index
	/// out of range is a programming error. Throws an Error if Embree fails.
	CasterScene(std::span<const glm::vec3> p_positions,
			std::span<const uint32_t> p_triangle_indices,
			std::span<const TranslucentTriangles> p_translucent = {},
			std::span<const CutOutTriangles> p_cut_out = {});

	/// Computes the reference (area-light visibility by ray tracing, float32). By definition, the
	/// visibility v of a point P is the mean transmittance of rays from P, moved along its
	/// geometric normal by its offset, to stratified points of the light's disc. The transmittance
	/// of a ray is 0 if an opaque triangle blocks it (holes of cut-out ones do not), else the
	/// product of those of the translucent bodies that it meets, or 1. Triangles are double-sided.
	/// For spot and omni lights, those at or behind the disc do not occlude; rays to a directional
	/// light do not end. For receivers with a spread radius see VisibilityOptions::spread.
	///
	/// Returns one v per point. p_points: the rows of an image of p_size_px. Throws an Error when
	/// the light or an option is out of range. A point that is no receiver or not finite, or whose
	/// normal is not finite, has v = 0; one exactly on the light has v = 1. May be called from
	/// several threads.
	VisibilityResult compute(std::span<const ReceiverPoint> p_points, const glm::uvec2 &p_size_px,
			const AreaLight &p_light, const VisibilityOptions &p_options) const;

	bool is_colored() const { return translucent.has_value(); }
	/// Computes the transmittances (RGB, 0..1) of eight rays, which start at one point. p_valid: -1
	/// for each ray to trace, 0 for the others, which get transmittance 0. Overwrites r_rays.
	void trace(const int *p_valid, RTCRay8 &r_rays, glm::vec3 *r_transmitted) const;
	/// Returns the transmittance of the ray from p_origin to p_origin + p_end * p_ray.
	glm::vec3 trace(const glm::vec3 &p_origin, const glm::vec3 &p_ray, float p_end) const;

private:
	EmbreeScene opaque;						// includes cut-out casters
	std::optional<EmbreeScene> translucent; // one geometry per body; empty without any
	std::vector<glm::vec3> transmittances;	// of the bodies
};

} // namespace gnomon
