#pragma once

#include "modules/render_graph/compute_pass.h"
#include "modules/shadow_edge_count/count_buffers.h"

namespace gnomon {

/// The inputs of the passes that find a light's faces and edges.
struct CountFindPasses {
	const CountCasters &casters;
	const CountMeshPools &meshes; // after CountMeshPools::upload()
	CountCapacities capacities;
	CountFrameBuffers buffers;
	RGBuffer constants; // CountLightConstants
	bool is_directional = false;
	bool has_edges = true;	  // R > 0: a light without size needs no edges
	bool may_overflow = true; // a view's face lists may need more nodes than their capacity
};

/// Adds passes over the casters that write their faces and planes in light space, and an ordered
/// list of the edges that may be silhouettes from some point of the light. Results of casters that
/// did not move are reused.
void add_find_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountFindPasses &p_passes);

/// Adds passes that build the face lists of one view's texels. If may_overflow, they include up to
/// four further attempts with larger texels, which the GPU skips if the lists fit.
void add_face_list_passes(RenderGraph &r_graph, RenderingDevice &p_device,
		const CountFindPasses &p_passes, uint32_t p_view_index);

} // namespace gnomon
