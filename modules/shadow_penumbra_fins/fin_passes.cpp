#include "modules/shadow_penumbra_fins/fin_passes.h"

#include "modules/core/error.h"

#include <algorithm>

namespace gnomon {

namespace {

constexpr uint32_t VERTICES_PER_HALF = 6; // two triangles
// Distances of fins from the light are clamped to at least this fraction of the farthest distance.
// Otherwise inner depths, which are divided by inner_divisor (K), could underflow in float32.
constexpr float MIN_DISTANCE_FRACTION = 1e-6f;

/// The draw of one caster's fins.
struct FinDraw {
	const GpuTopology *gpu = nullptr;
	uint32_t draw_index = 0; // in SilhouetteLists::draws
	shader::FinsPush push;
};

std::vector<FinDraw> build_draws(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index,
		const SilhouetteCasters &p_casters, TopologyBuffer p_buffers) {
	std::vector<FinDraw> draws;
	const LightView &view = p_inputs.views[p_view_index];
	for (uint32_t index : p_inputs.casters[p_view_index].instances) {
		const SilhouetteCaster *caster = p_casters.find(index);
		if (!caster) {
			continue;
		}
		FinDraw draw;
		draw.gpu = &p_inputs.meshes.get_topology(
				p_inputs.scene.instances[index].caster_mesh, p_buffers);
		draw.draw_index = static_cast<uint32_t>(caster - p_casters.casters.data());
		const glm::dmat4 &world_from_node = p_inputs.scene.instances[index].world_from_node;
		draw.push.view_from_node = glm::mat4(view.view_from_world * world_from_node);
		draw.push.light_position_node = caster->light_position_node;
		draw.push.first_in_list = caster->first_in_list;
		draw.push.normal_sign =
				compute_normal_sign(*caster->gpu->topology, p_inputs.scene.instances[index]);
		draw.push.padding0 = 0;
		draw.push.padding1 = 0;
		draws.push_back(draw);
	}
	return draws;
}

RasterPipelineDesc make_pipeline_desc(
		const RenderingDevice &p_device, const FinsSettings &p_settings) {
	RasterPipelineDesc desc;
	if (p_settings.method == FinMethod::GEOMETRY_SHADER) {
		desc.name = "fins, geometry shader";
		desc.vertex_shader = "shadow_penumbra_fins/fins.vert";
		desc.geometry_shader = "shadow_penumbra_fins/fins.geom";
		// Positions and normals, a vec4 each.
		desc.attributes = { { 0, 0, Format::R32_SFLOAT, 4, 0 },
			{ 1, 1, Format::R32_SFLOAT, 4, 0 } };
		desc.vertex_strides_bytes = { sizeof(glm::vec4), sizeof(glm::vec4) };
		desc.topology = Topology::TRIANGLES_WITH_ADJACENCY;
	} else {
		desc.name = "fins, listed edges";
		desc.vertex_shader = "shadow_penumbra_fins/edge_fins.vert";
	}
	desc.fragment_shader = "shadow_penumbra_fins/fins.frag";
	desc.constants = { { FINS_CONSTANT_HAS_OUTER, p_settings.outer_width_m > 0 ? 1u : 0u },
		{ FINS_CONSTANT_HAS_INNER, p_settings.inner_width_m > 0 ? 1u : 0u },
		{ FINS_CONSTANT_LAYER_COUNT, p_settings.layer_count },
		{ FINS_CONSTANT_CURVE, p_settings.curve },
		{ FINS_CONSTANT_STARTS_DARK, p_settings.has_inner_half ? 0u : 1u } };
	desc.color_formats = { Format::RG16_SFLOAT };
	desc.depth_compare = CompareOp::GREATER;
	desc.clamps_depth = p_device.get_features().depth_clamp;
	return desc;
}

} // namespace

uint32_t count_zero_normals(const SilhouetteCasters &p_casters) {
	uint32_t count = 0;
	for (const SilhouetteCaster &caster : p_casters.casters) {
		count += caster.gpu->topology->counts.zero_normal_count;
	}
	return count;
}

float compute_normal_sign(const MeshTopology &p_topology, const InstanceSnapshot &p_instance) {
	const bool is_inside_out =
			p_topology.mesh_class == MeshClass::CLOSED && p_topology.signed_volume_m3 < 0;
	return p_instance.is_mirrored() != is_inside_out ? -1.0f : 1.0f;
}

uint32_t get_vertices_per_edge(const FinsSettings &p_settings) {
	return VERTICES_PER_HALF *
			((p_settings.outer_width_m > 0 ? 1 : 0) + (p_settings.inner_width_m > 0 ? 1 : 0));
}

shader::FinsViewConstants compute_fins_view_constants(const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, const FinsSettings &p_settings) {
	const LightView &view = p_inputs.views[p_view_index];
	double farthest_m = 0;
	for (uint32_t index : p_inputs.casters[p_view_index].instances) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		farthest_m = std::max(farthest_m, view.compute_distance_range_m(instance).y);
	}
	farthest_m += std::max(p_settings.outer_width_m, p_settings.inner_width_m);
	const float nearest_limit_m = static_cast<float>(farthest_m) * MIN_DISTANCE_FRACTION;
	shader::FinsViewConstants constants = {};
	constants.half_extent = view.half_extent;
	constants.depth_scale = view.is_orthographic ? 1.0f / (view.far_m - view.near_m) : view.near_m;
	constants.view_far_m = view.far_m;
	constants.is_orthographic = view.is_orthographic ? 1 : 0;
	constants.layer = p_view_index;
	constants.outer_width_m = p_settings.outer_width_m;
	constants.inner_width_m = p_settings.inner_width_m;
	constants.beta_m = p_settings.beta_m;
	constants.nearest_m = std::max({ view.near_m, nearest_limit_m, 1e-30f });
	constants.farthest_m = std::max(static_cast<float>(farthest_m), constants.nearest_m);
	// K of Sun et al. 2010, section 2.1.3: puts every inner depth below every outer one.
	constants.inner_divisor = 2.0f * constants.farthest_m / constants.nearest_m;
	return constants;
}

void add_fin_pass(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, const FinsSettings &p_settings, const SilhouetteCasters &p_casters,
		const SilhouetteLists &p_lists, const FinTargets &p_targets) {
	const bool is_geometry_shader = p_settings.method == FinMethod::GEOMETRY_SHADER;
	const RGBuffer constants = r_graph.upload_constants("fins view",
			compute_fins_view_constants(p_inputs, p_view_index, p_settings), BufferUsage::UNIFORM);
	const RGTexture layer_1 = p_targets.layer_1;
	// When layer 2 was not peeled, layer 1 fills its binding, which the shader then does not read.
	const RGTexture layer_2 = p_targets.layer_2 ? p_targets.layer_2 : layer_1;
	PassBuilder pass = r_graph.add_pass(text("fins view ", p_view_index));
	pass.reads(constants, Access::UNIFORM_READ)
			.reads(layer_1, Access::SHADER_READ_FRAGMENT)
			.reads(layer_2, Access::SHADER_READ_FRAGMENT)
			.color(p_targets.color, LoadOp::CLEAR, glm::vec4(0.0f), p_view_index)
			.depth(p_targets.penumbra_depth, LoadOp::CLEAR, 0.0f, p_view_index);
	const TopologyBuffer buffers = TopologyBuffer::POSITIONS | TopologyBuffer::NORMALS |
			(is_geometry_shader ? TopologyBuffer::FACE_FLAGS | TopologyBuffer::ADJACENCY
								: TopologyBuffer::EDGES);
	const std::vector<FinDraw> draws = build_draws(p_inputs, p_view_index, p_casters, buffers);
	if (draws.empty() || !p_settings.has_fins()) {
		pass.execute([](PassContext &) {}); // only clears the attachments
		return;
	}
	const PipelineRID pipeline =
			p_inputs.device.get_raster_pipeline(make_pipeline_desc(p_inputs.device, p_settings));
	if (!is_geometry_shader) {
		pass.reads(p_lists.list, Access::SHADER_READ_VERTEX)
				.reads(p_lists.draws, Access::INDIRECT_READ);
	}
	pass.execute([=](PassContext &p_context) {
		CommandList &commands = p_context.commands;
		commands.bind_pipeline(pipeline);
		for (const FinDraw &draw : draws) {
			std::vector<Binding> bindings = {
				{ FINS_BINDING_CONSTANTS, p_context.get(constants) },
				{ FINS_BINDING_LAYER_1, p_context.get(layer_1) },
				{ FINS_BINDING_LAYER_2, p_context.get(layer_2) },
			};
			if (is_geometry_shader) {
				bindings.emplace_back(FINS_BINDING_FACE_FLAGS, draw.gpu->face_flags.get());
				const BufferRID vertices[] = { draw.gpu->positions.get(), draw.gpu->normals.get() };
				commands.bind_vertex_buffers(vertices);
				commands.bind_index_buffer(draw.gpu->adjacency_indices.get());
			} else {
				bindings.emplace_back(FINS_BINDING_POSITIONS, draw.gpu->positions.get());
				bindings.emplace_back(FINS_BINDING_NORMALS, draw.gpu->normals.get());
				bindings.emplace_back(FINS_BINDING_EDGES, draw.gpu->edges.get());
				bindings.emplace_back(FINS_BINDING_LIST, p_context.get(p_lists.list));
			}
			commands.bind_resources(bindings);
			commands.push_constants(draw.push);
			if (is_geometry_shader) {
				commands.draw_indexed(draw.gpu->adjacency_index_count);
			} else {
				commands.draw_indirect(p_context.get(p_lists.draws),
						draw.draw_index * sizeof(shader::SilhouetteDraw));
			}
		}
	});
}

} // namespace gnomon
