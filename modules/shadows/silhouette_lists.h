#pragma once

#include "modules/shadows/caster_pass.h"
#include "modules/shadows/draw_predicates.h"
#include "modules/shadows/gpu_topology.h"
#include "modules/shadows/shadow_technique.h"

#include "shared/silhouette_shared.h"

#include <vector>

// Silhouette edges as the light's centre sees them, found by compute shaders and listed for draws
// without a geometry shader.

namespace gnomon {

/// One caster whose silhouette is needed: the same for all views of a light.
struct SilhouetteCaster {
	uint32_t instance_index = 0;
	const GpuTopology *gpu = nullptr;
	glm::vec4 light_node = glm::vec4(0.0f); // as SilhouettePush::light_node
	uint32_t vertices_per_edge = 0;			// what its draw needs for each listed edge
	// Where its edges are in the buffers that all casters share.
	uint32_t word_count = 0;
	uint32_t first_word = 0;
	uint32_t first_block = 0;
	uint32_t first_in_list = 0;
};

struct SilhouetteCasters {
	std::vector<SilhouetteCaster> casters; // ordered by instance_index
	uint32_t word_count = 0;
	uint32_t block_count = 0;
	uint32_t edge_count = 0;
	uint32_t flat_instance_count = 0; // with a singular transform: they have no inside and get none

	/// Null for an instance without silhouettes.
	const SilhouetteCaster *find(uint32_t p_instance_index) const;
};

/// Handles of one frame.
struct SilhouetteLists {
	RGBuffer list;	// indices in GpuTopology::edges, ascending, from a caster's first_in_list on
	RGBuffer draws; // one shader::SilhouetteDraw per caster
};

/// p_instances: ascending. More edges than a 32-bit index can name are an Error.
SilhouetteCasters build_silhouette_casters(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_instances, uint32_t p_vertices_per_edge);

/// Passes that find the silhouette edges and compact them. The light's views share them. There must
/// be at least one caster. Of a caster whose predicate is 0 nothing is listed: its draw must not
/// happen either. p_targets: buffers to fill, large enough; none: buffers of the frame.
SilhouetteLists add_silhouette_passes(RenderGraph &r_graph, RenderingDevice &p_device,
		const SilhouetteCasters &p_casters, const DrawPredicates &p_predicates = {},
		const SilhouetteLists &p_targets = {});

/// The light as seen from the instance's node, see SilhouettePush::light_node. Not finite when the
/// transform is singular.
glm::vec4 compute_light_node(const LightSnapshot &p_light, const glm::dmat4 &p_world_from_node);
/// False when it is not finite: the caster is flat and has no inside.
bool is_light_node_usable(const glm::vec4 &p_light_node);

} // namespace gnomon
