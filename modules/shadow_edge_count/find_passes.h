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
};

/// Adds passes over the casters that write their faces and planes in light space, an ordered list
/// of the edges that may be silhouettes from some point of the light, and the trees over both.
/// Results of casters that did not move are reused.
void add_find_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountFindPasses &p_passes);

} // namespace gnomon
