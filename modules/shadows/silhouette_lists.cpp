#include "modules/shadows/silhouette_lists.h"

#include "modules/core/error.h"
#include "modules/shadows/mesh_store.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

// Of all casters of a light, so that sums of edges and their vertices (up to twelve each) fit into
// 32 bits.
constexpr uint32_t MAX_EDGE_COUNT = 300'000'000;

uint32_t divide_up(uint32_t p_value, uint32_t p_divisor) {
	return (p_value + p_divisor - 1) / p_divisor;
}

/// The dispatches of one caster. Its buffers live as long as its mesh, which the scene owns.
struct SilhouetteDispatch {
	uint32_t instance_index = 0;
	BufferRID positions;
	BufferRID edges;
	uint32_t word_count = 0;
	shader::SilhouettePush push;
};

std::vector<SilhouetteDispatch> build_dispatches(const SilhouetteCasters &p_casters) {
	std::vector<SilhouetteDispatch> dispatches;
	for (const SilhouetteCaster &caster : p_casters.casters) {
		SilhouetteDispatch dispatch;
		dispatch.instance_index = caster.instance_index;
		dispatch.positions = caster.gpu->positions.get();
		dispatch.edges = caster.gpu->edges.get();
		dispatch.word_count = caster.word_count;
		dispatch.push = { caster.light_position_node, caster.gpu->edge_count, caster.first_word,
			caster.first_run, caster.first_in_list, static_cast<uint32_t>(dispatches.size()),
			caster.vertices_per_edge, /*padding0=*/0, /*padding1=*/0 };
		dispatches.push_back(dispatch);
	}
	return dispatches;
}

} // namespace

glm::vec4 compute_light_position_node(
		const LightSnapshot &p_light, const glm::dmat4 &p_world_from_node) {
	const glm::dvec4 light_world = p_light.type == LightType::DIRECTIONAL
			? glm::dvec4(-p_light.get_direction_world(), 0.0)
			: glm::dvec4(p_light.position_world, 1.0);
	return glm::vec4(glm::inverse(p_world_from_node) * light_world);
}

bool is_light_position_finite(const glm::vec4 &p_light_position_node) {
	return std::isfinite(glm::dot(p_light_position_node, glm::vec4(1.0f)));
}

const SilhouetteCaster *SilhouetteCasters::find(uint32_t p_instance_index) const {
	const auto found = std::lower_bound(casters.begin(), casters.end(), p_instance_index,
			[](const SilhouetteCaster &p_caster, uint32_t p_index) {
				return p_caster.instance_index < p_index;
			});
	return found != casters.end() && found->instance_index == p_instance_index ? &*found : nullptr;
}

SilhouetteCasters build_silhouette_casters(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_instances, uint32_t p_vertices_per_edge) {
	SilhouetteCasters result;
	for (uint32_t index : p_instances) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		SilhouetteCaster caster;
		caster.instance_index = index;
		caster.vertices_per_edge = p_vertices_per_edge;
		caster.light_position_node =
				compute_light_position_node(p_inputs.light, instance.world_from_node);
		if (!is_light_position_finite(caster.light_position_node)) {
			++result.collapsed_instance_count;
			continue;
		}
		caster.gpu = &p_inputs.meshes.get_topology(
				instance.caster_mesh, TopologyBuffer::POSITIONS | TopologyBuffer::EDGES);
		if (caster.gpu->edge_count == 0) {
			continue;
		}
		if (caster.gpu->edge_count > MAX_EDGE_COUNT - result.edge_count) {
			fail_capacity("Light \"", p_inputs.light.name, "\": its casters have more than ",
					MAX_EDGE_COUNT,
					" edges, which is the most that can be listed. Let fewer meshes cast shadows.");
		}
		caster.first_word = result.word_count;
		caster.first_run = result.run_count;
		caster.first_in_list = result.edge_count;
		caster.word_count = divide_up(caster.gpu->edge_count, SILHOUETTE_EDGES_PER_WORD);
		result.word_count += caster.word_count;
		result.run_count += divide_up(caster.word_count, SILHOUETTE_WORDS_PER_RUN);
		result.edge_count += caster.gpu->edge_count;
		result.casters.push_back(caster);
	}
	return result;
}

SilhouetteLists add_silhouette_passes(RenderGraph &r_graph, RenderingDevice &p_device,
		const SilhouetteCasters &p_casters, const DrawPredicates &p_predicates,
		const SilhouetteLists &p_targets) {
	GNOMON_ASSERT(!p_casters.casters.empty(), "add_silhouette_passes needs at least one caster");
	const auto make_buffer = [&](const char *p_name, uint64_t p_count, uint64_t p_item_bytes,
									 BufferUsage p_usage) {
		return r_graph.create_buffer(
				{ p_name, p_count * p_item_bytes, BufferUsage::STORAGE | p_usage });
	};
	const RGBuffer words =
			make_buffer("edge words", p_casters.word_count, sizeof(uint32_t), BufferUsage::STORAGE);
	// For each run of edge words, the number of silhouette edges.
	const RGBuffer runs = make_buffer(
			"edge runs", p_casters.run_count, sizeof(uint32_t), BufferUsage::COPY_TARGET);
	SilhouetteLists lists = p_targets;
	if (!lists.list) {
		lists.list = make_buffer("silhouette edges", p_casters.edge_count, sizeof(uint32_t),
				BufferUsage::COPY_SOURCE);
		lists.draws = make_buffer("silhouette draws", p_casters.casters.size(),
				sizeof(shader::SilhouetteDraw), BufferUsage::INDIRECT | BufferUsage::COPY_SOURCE);
	}
	const std::vector<SilhouetteDispatch> dispatches = build_dispatches(p_casters);
	r_graph.add_pass("clear edge counts")
			.writes(runs, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.clear_buffer(p_context.get(runs));
			});
	const PipelineRID find_pipeline =
			p_device.get_compute_pipeline({ "find edges", "shadows/find_edges.comp", {} });
	PassBuilder find_pass = r_graph.add_pass("find edges");
	p_predicates.add_to(find_pass);
	find_pass.writes(words, Access::SHADER_WRITE_COMPUTE)
			.writes(runs, Access::SHADER_WRITE_COMPUTE, PassBuilder::Content::UPDATE)
			.execute([=](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.bind_pipeline(find_pipeline);
				for (const SilhouetteDispatch &dispatch : dispatches) {
					p_predicates.record(p_context, dispatch.instance_index, [&] {
						commands.bind_resources(
								{ { SILHOUETTE_BINDING_POSITIONS, dispatch.positions },
										{ SILHOUETTE_BINDING_EDGES, dispatch.edges },
										{ SILHOUETTE_BINDING_WORDS, p_context.get(words) },
										{ SILHOUETTE_BINDING_RUNS, p_context.get(runs) } });
						commands.push_constants(dispatch.push);
						commands.dispatch_items({ dispatch.word_count, 1, 1 });
					});
				}
			});
	const PipelineRID list_pipeline =
			p_device.get_compute_pipeline({ "list edges", "shadows/list_edges.comp", {} });
	PassBuilder list_pass = r_graph.add_pass("list edges");
	p_predicates.add_to(list_pass);
	list_pass.reads(words, Access::SHADER_READ_COMPUTE)
			.reads(runs, Access::SHADER_READ_COMPUTE)
			.writes(lists.list, Access::SHADER_WRITE_COMPUTE)
			.writes(lists.draws, Access::SHADER_WRITE_COMPUTE)
			.execute([=](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.bind_pipeline(list_pipeline);
				commands.bind_resources({ { SILHOUETTE_BINDING_WORDS, p_context.get(words) },
						{ SILHOUETTE_BINDING_RUNS, p_context.get(runs) },
						{ SILHOUETTE_BINDING_LIST, p_context.get(lists.list) },
						{ SILHOUETTE_BINDING_DRAWS, p_context.get(lists.draws) } });
				for (const SilhouetteDispatch &dispatch : dispatches) {
					p_predicates.record(p_context, dispatch.instance_index, [&] {
						commands.push_constants(dispatch.push);
						commands.dispatch_items({ dispatch.word_count, 1, 1 });
					});
				}
			});
	return lists;
}

} // namespace gnomon
