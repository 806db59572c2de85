#pragma once

#include "modules/shadows/light_view.h"

#include <glm/glm.hpp>

// The area of the image that a caster's shadow volume covers. Computed in camera view space in
// double precision: metres, x right, y down, z along the view.

namespace gnomon {

/// The pixels and depths that a volume may cover; receivers elsewhere are outside it.
struct VolumeArea {
	glm::uvec2 offset_px = glm::uvec2(0);
	glm::uvec2 size_px = glm::uvec2(0); // 0: outside the image
	float least_depth = 0.0f;			// reversed depth as stored, 0 = infinitely far
	float greatest_depth = 1.0f;

	bool is_empty() const { return size_px.x == 0 || size_px.y == 0; }
};

/// The area of the box's shadow volume: the box extruded along the light's rays, to infinity or to
/// the light's range. A light inside the box or on its surface gives the whole image.
VolumeArea compute_volume_area(const Bounds &p_box_world, const LightSnapshot &p_light,
		const LightView &p_camera, glm::uvec2 p_size_px);

/// False when the box is certainly outside the space between the light and the camera's near
/// rectangle: then the rectangle is outside the box's shadow volume and z-pass is safe.
bool may_shade_near_plane(
		const Bounds &p_box_world, const LightSnapshot &p_light, const LightView &p_camera);

} // namespace gnomon
