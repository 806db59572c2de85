#pragma once

#include "modules/shadows/light_view.h"

#include <glm/glm.hpp>

// Computes the area of the image that a caster's shadow volume covers. Uses camera view space in
// double precision: metres, x right, y down, z along the view.

namespace gnomon {

/// The pixels and depths that a volume may cover; receivers elsewhere are outside it.
struct VolumeArea {
	glm::uvec2 offset_px = glm::uvec2(0);
	glm::uvec2 size_px = glm::uvec2(0); // 0: outside the image
	float min_depth = 0.0f;				// reversed depth as stored, 0 = infinitely far
	float max_depth = 1.0f;

	bool is_empty() const { return size_px.x == 0 || size_px.y == 0; }
};

/// Returns the area of the box's shadow volume: the box extruded along the light's rays, at least
/// to the light's range or, without a range, to infinity. A light inside the box or on its surface
/// gives the whole image.
VolumeArea compute_volume_area(const Bounds &p_box_world, const LightSnapshot &p_light,
		const LightView &p_camera, glm::uvec2 p_size_px);

/// Returns false when the box is certainly outside the space between the light and the camera's
/// near rectangle: the rectangle is then outside the box's shadow volume, and z-pass is safe.
bool may_shade_near_plane(
		const Bounds &p_box_world, const LightSnapshot &p_light, const LightView &p_camera);

} // namespace gnomon
