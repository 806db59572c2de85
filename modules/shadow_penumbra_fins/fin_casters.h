#pragma once

#include "modules/renderer/gpu_topology.h"
#include "modules/renderer/shadow_technique.h"

#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

#include <vector>

namespace gnomon {

/// One caster whose silhouette gets fins: the same for all views of a light.
struct FinCaster {
	uint32_t instance_index = 0;
	const GpuTopology *gpu = nullptr;
	glm::vec4 light_node = glm::vec4(0.0f); // as FinsPush::light_node
	float normal_sign = 1.0f;
	// Where its edges stand in the buffers that all casters share.
	uint32_t word_count = 0;
	uint32_t first_word = 0;
	uint32_t first_block = 0;
	uint32_t first_in_list = 0;
};

struct FinCasters {
	std::vector<FinCaster> casters; // ordered by instance_index
	uint32_t word_count = 0;
	uint32_t block_count = 0;
	uint32_t edge_count = 0;
	uint32_t zero_normal_count = 0;	  // vertices where fins end in the edge: normals cancel
	uint32_t flat_instance_count = 0; // with a singular transform: they have no inside and get none

	/// Null for an instance without fins.
	const FinCaster *find(uint32_t p_instance_index) const;
};

/// The casters of all views that are listed in p_view_indices. More edges than a 32-bit index can
/// name are an Error.
FinCasters build_fin_casters(
		const ShadowTechnique::Inputs &p_inputs, const std::vector<uint32_t> &p_view_indices);

/// The light as seen from the instance's node, see FinsPush::light_node. Not finite when the
/// transform is singular.
glm::vec4 compute_light_node(const LightSnapshot &p_light, const glm::dmat4 &p_world_from_node);

/// -1 where normals that are transformed by cofactors point into the solid: in mirrored instances,
/// and in closed meshes that are modelled inside out (not in both).
float compute_normal_sign(const MeshTopology &p_topology, const InstanceSnapshot &p_instance);

} // namespace gnomon
