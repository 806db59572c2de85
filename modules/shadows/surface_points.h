#pragma once

#include "modules/shadows/surface_spread.h"

#include "shared/frame_shared.h"

#include <cstdint>
#include <vector>

namespace gnomon {

/// The surface that the camera sees in one pixel.
struct SurfacePoint {
	bool is_valid = false;						  // false: background
	glm::vec3 position = glm::vec3(0.0f);		  // camera-relative, world axes, metres
	glm::vec3 geometric_normal = glm::vec3(0.0f); // unit, towards the viewer
	SurfaceMaterial material;
	float pixel_size_m = 0;		 // width of a pixel at that distance, across the view
	float receiver_offset_m = 0; // how far the receiver is moved off the surface

	/// Where visibility is tested, camera-relative.
	glm::vec3 compute_receiver_position() const {
		return position + receiver_offset_m * geometric_normal;
	}
};

/// CPU copies of the texels of a host's textures, see HostSurfaces; rows from the top.
struct SurfaceTexels {
	const uint8_t *depth = nullptr;
	const uint8_t *geometric_normal = nullptr;
	const uint8_t *material = nullptr; // null: nothing scatters
};
/// Decodes the surface of each pixel, for passes that run on the CPU.
std::vector<SurfacePoint> read_surfaces(
		const shader::FrameConstants &p_frame, glm::uvec2 p_size_px, const SurfaceTexels &p_texels);

} // namespace gnomon
