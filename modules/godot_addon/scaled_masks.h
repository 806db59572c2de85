#pragma once

#include "modules/godot_addon/view_depth.h"

namespace gnomon {

/// Masks with fewer pixels than their view, for speed. Their depth (near / z, which is linear on
/// planes) is extrapolated from the nearest pixel of the view along the surface there. Each pixel
/// of the view then averages the mask pixels around it, mainly those on its own surface.
class ScaledMasks {
public:
	/// p_depth: the view's depth, near / z. p_scale: mask width / view width, above 0, at most 1,
	/// where 1 scales nothing. p_count: number of masks, at least 1.
	ScaledMasks(RenderGraph &r_graph, RenderingDevice &p_device, RGTexture p_depth, float p_scale,
			uint32_t p_count);
	/// Returns the size of masks, at least 1 x 1, for a view of p_size_px.
	static glm::uvec2 compute_size(glm::uvec2 p_size_px, float p_scale);
	glm::uvec2 get_size_px() const { return size_px; }
	/// Returns the depth of the masks' pixels, near / z.
	RGTexture get_depth() const { return depth; }
	/// Returns the array texture, a layer for each mask, that ShadowFrame::hold writes. p_result:
	/// R16_SFLOAT, at least as large as the view. It is itself returned if nothing is scaled.
	RGTexture create_target(RGTexture p_result);
	/// Call after all masks were written to the target: scales them into p_result.
	void write(RGTexture p_result);

private:
	RenderGraph &graph;
	RenderingDevice &device;
	RGTexture full_depth;
	glm::uvec2 full_size_px;
	uint32_t count;
	glm::uvec2 size_px;
	RGTexture depth;
	RGTexture target; // empty if nothing is scaled
};

} // namespace gnomon
