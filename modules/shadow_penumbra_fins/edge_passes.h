#pragma once

#include "modules/shadow_penumbra_fins/fin_casters.h"

namespace gnomon {

/// Silhouette edges of all casters as buffers of one frame.
struct EdgeLists {
	RGBuffer list;	// places in GpuTopology::edges, ascending, from a caster's first_in_list on
	RGBuffer draws; // one shader::FinsDraw per caster
};

/// Passes that find the silhouette edges as the light's centre sees them, and compact them. The
/// light's views share them. p_vertices_per_edge: what a draw needs for each edge. There must be at
/// least one caster.
EdgeLists add_edge_passes(RenderGraph &r_graph, RenderingDevice &p_device,
		const FinCasters &p_casters, uint32_t p_vertices_per_edge);

} // namespace gnomon
