#include "modules/shadows/surface_points.h"

#include "modules/shadows/camera_view.h"
#include "modules/shadows/normal_packing.h"

#include <cstring>

namespace gnomon {

std::vector<SurfacePoint> read_surfaces(const shader::FrameConstants &p_frame, glm::uvec2 p_size_px,
		const SurfaceTexels &p_texels) {
	std::vector<SurfacePoint> surfaces(size_t(p_size_px.x) * p_size_px.y);
	for (size_t index = 0; index < surfaces.size(); ++index) {
		float depth = 0;
		uint32_t packed_normal = 0;
		uint16_t material[4] = {};
		std::memcpy(&depth, p_texels.depth + index * sizeof(depth), sizeof(depth));
		std::memcpy(&packed_normal, p_texels.geometric_normal + index * sizeof(packed_normal),
				sizeof(packed_normal));
		if (p_texels.material) {
			std::memcpy(&material, p_texels.material + index * sizeof(material), sizeof(material));
		}
		if (depth > 0.0f) {
			const glm::uvec2 pixel(index % p_size_px.x, index / p_size_px.x);
			const float distance_m = p_frame.near_m / depth; // along the view
			surfaces[index] = { /*is_valid=*/true,
				compute_position(p_frame, p_size_px, pixel, depth), unpack_normal(packed_normal),
				{ glm::unpackHalf1x16(material[0]), glm::unpackHalf1x16(material[1]) },
				p_frame.pixel_size_per_m * distance_m,
				compute_receiver_offset_m(p_frame, distance_m) };
		}
	}
	return surfaces;
}

} // namespace gnomon
