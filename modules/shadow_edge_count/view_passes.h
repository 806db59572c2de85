#pragma once

#include "modules/render_graph/compute_pass.h"
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

/// A compute pass over the view's part of the light's buffers, see CountPartPush.
void add_part_pass(RenderGraph &r_graph, RenderingDevice &p_device, const std::string &p_name,
		const char *p_shader, const CountViewPasses &p_passes, std::vector<PassBinding> p_bindings,
		uint32_t p_items, const std::vector<SpecializationConstant> &p_constants = {});

/// Passes that find the edges of one view's casters that are silhouettes from a point of the light,
/// and list them in order. Of casters that did not move, what was found before is listed again.
void add_find_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountViewPasses &p_passes);

/// Passes that make one view's layer map, then mark texels beside a silhouette.
void add_layer_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountViewPasses &p_passes);

} // namespace gnomon
