#include "modules/shadow_edge_count/count_casters.h"

#include "modules/core/error.h"
#include "modules/renderer/mesh_store.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

// Per light view: six times as many must fit into 26 bits, beside what an edge is used for.
constexpr uint32_t MAX_COUNT = 10'000'000;

uint32_t add_up(uint32_t p_sum, uint32_t p_count, const char *p_what, const std::string &p_light) {
	if (p_count > MAX_COUNT - p_sum) {
		fail("Light \"", p_light, "\": its casters have more than ", MAX_COUNT, " ", p_what,
				", which is the most for edge_count. Let fewer meshes cast shadows.");
	}
	return p_sum + p_count;
}

} // namespace

CountCasters build_count_casters(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index) {
	const LightView &view = p_inputs.views[p_view_index];
	CountCasters result;
	for (const uint32_t index : p_inputs.casters[p_view_index].instances) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		const double volume = glm::determinant(glm::dmat3(instance.world_from_node));
		if (volume == 0 || !std::isfinite(volume)) {
			++result.flat_instance_count;
			continue;
		}
		const auto &gpu = p_inputs.meshes.get_derived<CountGpuMesh>(instance.mesh, [&] {
			return upload_count_mesh(
					p_inputs.device, instance.mesh->name, *get_topology(instance.mesh));
		});
		if (gpu.face_count == 0) {
			continue;
		}
		CountCaster caster;
		caster.gpu = &gpu;
		caster.mesh_id = instance.mesh->id;
		caster.push = { glm::mat4(view.view_from_world * instance.world_from_node), gpu.face_count,
			result.face_count, gpu.edge_count, result.word_count, result.block_count,
			gpu.inconsistent_from,
			(gpu.is_double_sided ? uint32_t(EDGE_COUNT_DOUBLE_SIDED) : 0u) |
					(volume < 0 ? uint32_t(EDGE_COUNT_MIRRORED) : 0u),
			0 };
		caster.clip_from_node = view.compute_clip_from_node(instance.world_from_node);
		result.face_count =
				add_up(result.face_count, gpu.face_count, "triangles", p_inputs.light.name);
		result.edge_count = add_up(result.edge_count, gpu.edge_count, "edges", p_inputs.light.name);
		result.word_count += gpu.word_count;
		result.block_count += gpu.block_count;
		result.casters.push_back(caster);
	}
	const auto last = std::find_if(result.casters.rbegin(), result.casters.rend(),
			[](const CountCaster &p_caster) { return p_caster.gpu->edge_count > 0; });
	if (last != result.casters.rend()) {
		last->push.kind |= EDGE_COUNT_LAST_CASTER;
	}
	return result;
}

void compare_casters(const CountCasters &p_before, CountCasters &r_casters) {
	const auto is_same_mesh = [](const CountCaster &p_a, const CountCaster &p_b) {
		return p_a.mesh_id == p_b.mesh_id && p_a.push.kind == p_b.push.kind;
	};
	if (!std::equal(p_before.casters.begin(), p_before.casters.end(), r_casters.casters.begin(),
				r_casters.casters.end(), is_same_mesh)) {
		return;
	}
	for (size_t index = 0; index < r_casters.casters.size(); ++index) {
		CountCaster &caster = r_casters.casters[index];
		caster.is_moved = caster.push.view_from_node != p_before.casters[index].push.view_from_node;
	}
}

} // namespace gnomon
