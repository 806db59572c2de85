#pragma once

#include "modules/godot_addon/view_depth.h"

namespace gnomon {

/// Masks of fewer pixels than their view, for speed. Their depth is interpolated where the surface
/// is one, near / z, which is linear over planes; each pixel of the view takes its mask from those
/// around it that are of its surface.
class ScaledMasks {
public:
	/// p_depth: the view's, near / z. p_scale: above 0 to 1, of each side; 1: they are the view's
	/// own. p_count: of masks, at least 1.
	ScaledMasks(RenderGraph &r_graph, RenderingDevice &p_device, RGTexture p_depth, float p_scale,
			uint32_t p_count);
	/// What get_size_px is for a view of p_size_px.
	static glm::uvec2 compute_size(glm::uvec2 p_size_px, float p_scale);
	glm::uvec2 get_size_px() const { return size_px; }
	RGTexture get_depth() const { return depth; }
	/// An array with a layer for each mask, that ShadowFrame::hold writes. p_result: R16_SFLOAT, at
	/// least of the view's size; where nothing is scaled it is returned.
	RGTexture create_target(RGTexture p_result);
	/// Once all are in the target: writes them into p_result.
	void write(RGTexture p_result);

private:
	RenderGraph &graph;
	RenderingDevice &device;
	RGTexture full_depth;
	glm::uvec2 full_size_px;
	uint32_t count;
	glm::uvec2 size_px;
	RGTexture depth;
	RGTexture target; // none where nothing is scaled
};

} // namespace gnomon
