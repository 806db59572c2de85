#pragma once

#include "modules/shadow_reference/area_light_visibility.h"
#include "modules/shadow_reference/embree_scene.h"

#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// Triangles that leave a part of each ray that meets them, once or more often.
struct TranslucentTriangles {
	Triangles triangles;
	glm::vec3 transmittance = glm::vec3(0.0f); // 0..1
};

/// Sets one ray of eight whose other fields are 0.
void set_ray(RTCRay8 &r_rays, uint32_t p_lane, const glm::vec3 &p_origin, const glm::vec3 &p_ray,
		float p_end);

/// All that hides a light.
class CasterScene {
public:
	/// Three indices per triangle. Positions relative to an origin near the camera, so that float32
	/// suffices. Triangles with a position that is not finite are skipped; an index out of range
	/// is a programming error. Embree failing is an Error.
	/// p_translucent: each leaves its part of the rays that meet it; several multiply.
	CasterScene(std::span<const glm::vec3> p_positions,
			std::span<const uint32_t> p_triangle_indices,
			std::span<const TranslucentTriangles> p_translucent = {},
			std::span<const CutOutTriangles> p_cut_out = {});

	/// The definition of the reference (exact area-light visibility, float32): the share of the
	/// rays from P, moved by 5e-5 S along its geometric normal, to stratified points of the light's
	/// disc that meet no triangle. Triangles have two sides. Those at the disc and behind it do not
	/// occlude.
	///
	/// One v per point; points are the rows of an image of p_size_px. A light or an option out of
	/// range is an Error. A point that is not finite, or whose normal is not, has v = 0; one
	/// exactly on the light has v = 1. May be called from several threads.
	VisibilityResult compute(std::span<const ReceiverPoint> p_points, const glm::uvec2 &p_size_px,
			const AreaLight &p_light, const VisibilityOptions &p_options) const;

	bool is_colored() const { return translucent.has_value(); }
	/// What is left of each of eight rays, which start at one point; of those with valid = 0,
	/// nothing.
	void trace(const int *p_valid, RTCRay8 &r_rays, glm::vec3 *r_left) const;
	/// Of one ray.
	glm::vec3 trace(const glm::vec3 &p_origin, const glm::vec3 &p_ray, float p_end) const;

private:
	EmbreeScene opaque;						// those with holes too
	std::optional<EmbreeScene> translucent; // a geometry for each body
	std::vector<glm::vec3> transmittances;	// of the bodies
};

} // namespace gnomon
