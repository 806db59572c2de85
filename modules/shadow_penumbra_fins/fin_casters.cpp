#include "modules/shadow_penumbra_fins/fin_casters.h"

#include "modules/core/error.h"
#include "modules/renderer/mesh_store.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace gnomon {

namespace {

// Twelve vertices an edge still have 32-bit indices.
constexpr uint32_t MAX_EDGE_COUNT = 300'000'000;

uint32_t divide_up(uint32_t p_value, uint32_t p_divisor) {
	return (p_value + p_divisor - 1) / p_divisor;
}

} // namespace

glm::vec4 compute_light_node(const LightSnapshot &p_light, const glm::dmat4 &p_world_from_node) {
	const glm::dvec4 light_world = p_light.type == LightType::DIRECTIONAL
			? glm::dvec4(-p_light.get_direction_world(), 0.0)
			: glm::dvec4(p_light.position_world, 1.0);
	return glm::vec4(glm::inverse(p_world_from_node) * light_world);
}

float compute_normal_sign(const MeshTopology &p_topology, const InstanceSnapshot &p_instance) {
	const bool is_inside_out =
			p_topology.mesh_class == MeshClass::CLOSED && p_topology.signed_volume_m3 < 0;
	return p_instance.is_mirrored() != is_inside_out ? -1.0f : 1.0f;
}

const FinCaster *FinCasters::find(uint32_t p_instance_index) const {
	const auto found = std::lower_bound(casters.begin(), casters.end(), p_instance_index,
			[](const FinCaster &p_caster, uint32_t p_index) {
				return p_caster.instance_index < p_index;
			});
	return found != casters.end() && found->instance_index == p_instance_index ? &*found : nullptr;
}

FinCasters build_fin_casters(
		const ShadowTechnique::Inputs &p_inputs, const std::vector<uint32_t> &p_view_indices) {
	std::set<uint32_t> instances;
	for (uint32_t view : p_view_indices) {
		const std::vector<uint32_t> &listed = p_inputs.casters[view].instances;
		instances.insert(listed.begin(), listed.end());
	}
	FinCasters result;
	for (uint32_t index : instances) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		FinCaster caster;
		caster.instance_index = index;
		caster.light_node = compute_light_node(p_inputs.light, instance.world_from_node);
		if (!std::isfinite(glm::dot(caster.light_node, glm::vec4(1.0f)))) {
			++result.flat_instance_count;
			continue;
		}
		caster.gpu = &p_inputs.meshes.get_topology(instance.mesh);
		if (caster.gpu->edge_count == 0) {
			continue;
		}
		if (caster.gpu->edge_count > MAX_EDGE_COUNT - result.edge_count) {
			fail("Light \"", p_inputs.light.name, "\": its casters have more than ", MAX_EDGE_COUNT,
					" edges, which is the most for fins. Let fewer meshes cast shadows.");
		}
		caster.normal_sign = compute_normal_sign(*caster.gpu->topology, instance);
		caster.first_word = result.word_count;
		caster.first_block = result.block_count;
		caster.first_in_list = result.edge_count;
		caster.word_count = divide_up(caster.gpu->edge_count, FINS_EDGES_PER_WORD);
		result.word_count += caster.word_count;
		result.block_count += divide_up(caster.word_count, FINS_WORDS_PER_BLOCK);
		result.edge_count += caster.gpu->edge_count;
		result.zero_normal_count += caster.gpu->topology->counts.zero_normal_count;
		result.casters.push_back(caster);
	}
	return result;
}

} // namespace gnomon
