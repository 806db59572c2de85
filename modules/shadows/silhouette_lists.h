#pragma once

#include "modules/shadows/caster_pass.h"
#include "modules/shadows/draw_predicates.h"
#include "modules/shadows/gpu_topology.h"
#include "modules/shadows/shadow_technique.h"

#include "shared/silhouette_shared.h"

#include <vector>

// Silhouette edges as seen from the light's centre, found by compute shaders and listed for draws
// without a geometry shader.

namespace gnomon {

/// One caster whose silhouette is needed. All views of a light share it.
struct SilhouetteCaster {
	uint32_t instance_index = 0;
	const GpuTopology *gpu = nullptr;
	glm::vec4 light_position_node = glm::vec4(0.0f); // see SilhouettePush
	uint32_t vertices_per_edge = 0; // vertices that its draw needs for each listed edge
	// The range of its edges in the buffers that all casters share, see silhouette_shared.h.
	uint32_t word_count = 0;
	uint32_t first_word = 0;
	uint32_t first_run = 0;
	uint32_t first_in_list = 0;
};

/// The casters of one light that have edges, and the sizes of their shared buffers.
struct SilhouetteCasters {
	std::vector<SilhouetteCaster> casters; // ordered by instance_index
	uint32_t word_count = 0;
	uint32_t run_count = 0;
	uint32_t edge_count = 0;
	uint32_t collapsed_instance_count = 0; // skipped: collapsed to a line or a point

	/// Returns null for an instance that is not one of the casters.
	const SilhouetteCaster *find(uint32_t p_instance_index) const;
};

/// Buffers of one frame.
struct SilhouetteLists {
	RGBuffer list;	// indices into GpuTopology::edges, ascending, from each first_in_list on
	RGBuffer draws; // one shader::SilhouetteDraw per caster
};

/// Lists the casters that have edges, and assigns each its ranges in the shared buffers.
/// p_instances: ascending. Throws an Error when all casters together have more than 300
/// million edges, since counts of their vertices (up to twelve an edge) have 32 bits.
SilhouetteCasters build_silhouette_casters(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_instances, uint32_t p_vertices_per_edge);

/// Adds passes that find the silhouette edges and compact them; all views of the light share the
/// lists. There must be at least one caster. A caster whose predicate is 0 is not listed, so its
/// draw must be predicated too. p_targets: buffers to fill, large enough for p_casters; empty: the
/// passes create transient ones.
SilhouetteLists add_silhouette_passes(RenderGraph &r_graph, RenderingDevice &p_device,
		const SilhouetteCasters &p_casters, const DrawPredicates &p_predicates = {},
		const SilhouetteLists &p_targets = {});

/// Transforms the light's position into the instance's node space. Homogeneous: xyz / w is the
/// light's centre; w = 0: xyz is the direction towards it. Not finite when the transform is
/// singular.
glm::vec4 compute_light_position_node(
		const LightSnapshot &p_light, const glm::dmat4 &p_world_from_node);
/// False when p_light_position_node is not finite: the transform is singular, and collapses the
/// caster to a line or a point (build_snapshot thickens flat ones).
bool is_light_position_finite(const glm::vec4 &p_light_position_node);

} // namespace gnomon
