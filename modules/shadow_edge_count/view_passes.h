#pragma once

#include "modules/shadow_edge_count/count_buffers.h"

namespace gnomon {

/// What the passes of one view need.
struct CountViewPasses {
	uint32_t index = 0;
	glm::uvec2 map_size_px = glm::uvec2(0);
	uint32_t layer_count = 0; // see CountSettings
	RGBuffer constants;		  // CountViewConstants
	const CountCasters &casters;
	CountCapacities capacities;
	CountFrameBuffers light;
	CountViewBuffers view;
};

/// Passes that find the edges of one view's casters that are silhouettes from a point of the light,
/// and list them in order. Of casters that did not move, what was found before is listed again.
void add_find_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountViewPasses &p_passes);

/// Passes that make one view's layer map, then mark texels beside a silhouette.
void add_layer_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountViewPasses &p_passes);

} // namespace gnomon
