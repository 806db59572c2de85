#pragma once

#include "modules/render_graph/compute_pass.h"
#include "modules/shadow_edge_count/count_buffers.h"

namespace gnomon {

/// What the passes that find a light's faces and edges need.
struct CountFindPasses {
	const CountCasters &casters;
	CountCapacities capacities;
	CountFrameBuffers buffers;
	RGBuffer constants;		  // CountLightConstants
	bool has_edges = true;	  // R is above 0
	bool may_be_short = true; // the nodes of a view's face lists may have no room
};

/// Passes over the casters: their faces and planes in light space, and a list, in order, of the
/// edges that are silhouettes from some point of the light. Of casters that did not move, what was
/// found before is listed again.
void add_find_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountFindPasses &p_passes);

/// The face lists of one view's texels.
void add_face_list_passes(RenderGraph &r_graph, RenderingDevice &p_device,
		const CountFindPasses &p_passes, uint32_t p_view_index);

} // namespace gnomon
