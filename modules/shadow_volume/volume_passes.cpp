#include "modules/shadow_volume/volume_passes.h"

#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/shadow_volume/cpu_volumes.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/mesh_store.h"

#include "shadow_volume/shadow_volume_shared.h"

namespace gnomon {

namespace {

const uint32_t CORNERS_PER_CAP = 3;
static_assert(VOLUMES_FACES_NONE == uint32_t(VolumeFaces::NONE) &&
		VOLUMES_FACES_NOT_SOLID == uint32_t(VolumeFaces::NOT_SOLID) &&
		VOLUMES_FACES_ALL == uint32_t(VolumeFaces::ALL));

/// The draws of one caster and their pipelines.
struct VolumeDraw {
	const VolumeCaster *caster = nullptr;
	PipelineRID pipeline;	   // of the whole volume, or only of its sides
	PipelineRID caps_pipeline; // only without a geometry shader
	shader::VolumePush push;
	uint32_t cap_vertex_count = 0;
	uint32_t draw_index = 0; // index of the indirect draw in SilhouetteLists::draws
	RGBuffer corners;		 // vertices of a volume built on the CPU
	uint32_t corner_count = 0;
};

StencilTest make_stencil_test(StencilMethod p_method) {
	StencilTest test;
	if (p_method == StencilMethod::Z_PASS) {
		test.front.pass = StencilOp::INCREMENT_WRAP;
		test.back.pass = StencilOp::DECREMENT_WRAP;
	} else {
		test.front.depth_fail = StencilOp::DECREMENT_WRAP;
		test.back.depth_fail = StencilOp::INCREMENT_WRAP;
	}
	return test;
}

/// p_variant: "geometry shader"; "sides" or "caps" for listed edges; "corners" for CPU volumes.
RasterPipelineDesc make_volume_desc(const VolumeCaster &p_caster, const std::string &p_variant) {
	RasterPipelineDesc desc;
	desc.name = text("volumes, ", p_variant);
	desc.constants = { { VOLUMES_CONSTANT_ROBUST_FACES, uint32_t(p_caster.shape.robust) },
		{ VOLUMES_CONSTANT_HAS_FAR_CAP, p_caster.shape.has_far_cap ? 1u : 0u } };
	desc.has_stencil = true;
	desc.stencil = make_stencil_test(p_caster.stencil_method);
	desc.winding = p_caster.is_mirrored ? Winding::MIRRORED : Winding::NORMAL;
	desc.writes_depth = false;
	desc.depth_compare = CompareOp::GREATER; // reversed: nearer
	if (p_variant == "geometry shader") {
		desc.vertex_shader = "shadow_volume/volumes.vert";
		desc.geometry_shader = "shadow_volume/volumes.geom";
		desc.topology = Topology::TRIANGLES_WITH_ADJACENCY;
	} else {
		desc.vertex_shader = text("shadow_volume/", p_variant, ".vert");
	}
	if (p_variant == "geometry shader" || p_variant == "corners") {
		desc.attributes = { { /*location=*/0, /*buffer_index=*/0, Format::R32_SFLOAT,
				/*component_count=*/4, /*offset_bytes=*/0 } };
		desc.vertex_strides_bytes = { sizeof(glm::vec4) };
	}
	return desc;
}

PipelineRID get_pipeline(const ShadowTechnique::Inputs &p_inputs, const VolumeSettings &p_settings,
		const VolumeCaster &p_caster, const std::string &p_variant) {
	RasterPipelineDesc desc = make_volume_desc(p_caster, p_variant);
	desc.has_depth_bounds = p_settings.has_scissor && p_inputs.device.get_features().depth_bounds;
	return p_inputs.device.get_raster_pipeline(desc);
}

std::vector<VolumeDraw> build_volume_draws(RenderGraph &r_graph,
		const ShadowTechnique::Inputs &p_inputs, const VolumeSettings &p_settings,
		const VolumeCasters &p_casters, const SilhouetteCasters &p_listed) {
	const LightView camera = make_volume_camera(p_inputs);
	const glm::mat4 shift(compute_shift(p_inputs.scene.camera));
	std::vector<VolumeDraw> draws;
	for (const VolumeCaster &caster : p_casters.casters) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[caster.instance_index];
		VolumeDraw draw;
		draw.caster = &caster;
		draw.push.clip_from_node = shift * camera.compute_clip_from_node(instance.world_from_node);
		draw.push.light_position_node = caster.light_position_node;
		if (caster.extruder == VolumeExtruder::GEOMETRY_SHADER) {
			draw.pipeline = get_pipeline(p_inputs, p_settings, caster, "geometry shader");
			// Uploads what record_draw binds.
			p_inputs.meshes.get_topology(instance.caster_mesh,
					TopologyBuffer::POSITIONS | TopologyBuffer::FACE_FLAGS |
							TopologyBuffer::ADJACENCY);
		} else if (caster.extruder == VolumeExtruder::CPU) {
			const auto topology = get_topology(instance.get_posed_caster_mesh());
			const std::vector<glm::vec4> corners = build_cpu_volume(
					*topology, glm::dvec4(caster.light_position_node), caster.shape);
			if (corners.empty()) {
				continue;
			}
			draw.corner_count = static_cast<uint32_t>(corners.size());
			draw.corners = r_graph.upload(
					"volume corners", BufferUsage::VERTEX, bytes_of(std::span(corners)));
			draw.pipeline = get_pipeline(p_inputs, p_settings, caster, "corners");
		} else {
			const SilhouetteCaster *listed = p_listed.find(caster.instance_index);
			draw.draw_index = static_cast<uint32_t>(listed - p_listed.casters.data());
			draw.push.first_in_list = listed->first_in_list;
			draw.pipeline = get_pipeline(p_inputs, p_settings, caster, "sides");
			const uint32_t cap_count = caster.shape.has_far_cap ? 2 : 1;
			draw.cap_vertex_count =
					cap_count * CORNERS_PER_CAP * caster.gpu->topology->get_face_count();
			draw.caps_pipeline = get_pipeline(p_inputs, p_settings, caster, "caps");
			// Uploads what record_draw binds.
			p_inputs.meshes.get_topology(instance.caster_mesh,
					TopologyBuffer::POSITIONS | TopologyBuffer::EDGES | TopologyBuffer::TRIANGLES |
							TopologyBuffer::FACE_FLAGS);
		}
		draws.push_back(draw);
	}
	return draws;
}

void record_draw(PassContext &r_context, const VolumeDraw &p_draw, const SilhouetteLists &p_lists) {
	CommandList &commands = r_context.commands;
	const VolumeCaster &caster = *p_draw.caster;
	const GpuTopology &gpu = *caster.gpu;
	commands.bind_pipeline(p_draw.pipeline);
	if (caster.extruder == VolumeExtruder::GEOMETRY_SHADER) {
		const BufferRID vertices[] = { gpu.positions.get() };
		commands.bind_vertex_buffers(vertices);
		commands.bind_index_buffer(gpu.adjacency_indices.get());
		commands.bind_resources({ { VOLUMES_BINDING_FACE_FLAGS, gpu.face_flags.get() } });
		commands.push_constants(p_draw.push);
		commands.draw_indexed(gpu.adjacency_index_count);
		return;
	}
	if (caster.extruder == VolumeExtruder::CPU) {
		const BufferRID vertices[] = { r_context.get(p_draw.corners) };
		commands.bind_vertex_buffers(vertices);
		commands.push_constants(p_draw.push);
		commands.draw(p_draw.corner_count);
		return;
	}
	commands.bind_resources({ { VOLUMES_BINDING_POSITIONS, gpu.positions.get() },
			{ VOLUMES_BINDING_EDGES, gpu.edges.get() },
			{ VOLUMES_BINDING_LIST, r_context.get(p_lists.list) } });
	commands.push_constants(p_draw.push);
	commands.draw_indirect(
			r_context.get(p_lists.draws), p_draw.draw_index * sizeof(shader::SilhouetteDraw));
	commands.bind_pipeline(p_draw.caps_pipeline);
	commands.bind_resources({ { VOLUMES_BINDING_POSITIONS, gpu.positions.get() },
			{ VOLUMES_BINDING_TRIANGLES, gpu.triangles.get() },
			{ VOLUMES_BINDING_FACE_FLAGS, gpu.face_flags.get() } });
	commands.push_constants(p_draw.push);
	commands.draw(p_draw.cap_vertex_count);
}

/// Adds a pass that writes shadow into the mask where the stencil is not 0.
void add_hidden_pass(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const VolumeTargets &p_targets, const std::string &p_name) {
	RasterPipelineDesc desc = make_screen_desc("hidden", "shadow_volume/hidden.frag");
	// Resets the stencil to 0 for the next group.
	desc.stencil.front = { CompareOp::NOT_EQUAL, StencilOp::KEEP, StencilOp::KEEP,
		StencilOp::ZERO };
	desc.stencil.back = desc.stencil.front;
	const PipelineRID pipeline = p_inputs.device.get_raster_pipeline(desc);
	r_graph.add_pass(p_name)
			.color(p_targets.mask, LoadOp::KEEP)
			.depth(p_targets.depth, LoadOp::KEEP)
			.execute([pipeline](PassContext &p_context) {
				p_context.commands.bind_pipeline(pipeline);
				p_context.commands.draw(3);
			});
}

} // namespace

SilhouetteCasters list_compute_casters(
		const ShadowTechnique::Inputs &p_inputs, const VolumeCasters &p_casters) {
	std::vector<uint32_t> instances;
	std::vector<uint32_t> vertices_per_edge;
	for (const VolumeCaster &caster : p_casters.casters) {
		if (caster.extruder == VolumeExtruder::COMPUTE) {
			instances.push_back(caster.instance_index);
			// Robust volumes extrude a side for each of an edge's two faces, see sides.vert.
			vertices_per_edge.push_back(
					VOLUMES_VERTICES_PER_SIDE * (caster.shape.robust != VolumeFaces::NONE ? 2 : 1));
		}
	}
	SilhouetteCasters listed =
			build_silhouette_casters(p_inputs, instances, VOLUMES_VERTICES_PER_SIDE);
	// build_volume_casters skipped all casters that build_silhouette_casters would skip, so the
	// indices agree.
	for (size_t i = 0; i < listed.casters.size(); ++i) {
		listed.casters[i].vertices_per_edge = vertices_per_edge[i];
	}
	return listed;
}

VolumeTargets add_volume_receivers_pass(
		RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs) {
	VolumeTargets targets;
	targets.mask = create_drawn_mask(r_graph, p_inputs.size_px);
	targets.depth = create_stencil_target(r_graph, "volume depth", p_inputs.size_px);
	RasterPipelineDesc desc = make_screen_desc("volume receivers", "shadow_volume/receivers.frag");
	desc.writes_depth = true;
	const PipelineRID pipeline = p_inputs.device.get_raster_pipeline(desc);
	const RGBuffer frame = p_inputs.frame;
	const RGBuffer light = p_inputs.light_constants;
	const RGTexture depth = p_inputs.depth;
	const RGTexture normal = p_inputs.geometric_normal;
	const RGTexture receivers = p_inputs.receivers;
	shader::VolumeReceiversPush push = {};
	push.camera_move_m = compute_volume_camera_move_m(p_inputs);
	r_graph.add_pass("receivers' depth")
			.reads(frame, Access::UNIFORM_READ)
			.reads(light, Access::UNIFORM_READ)
			.reads(depth, Access::SHADER_READ_FRAGMENT)
			.reads(normal, Access::SHADER_READ_FRAGMENT)
			.reads(receivers, Access::SHADER_READ_FRAGMENT)
			.color(targets.mask)
			.depth(targets.depth, LoadOp::CLEAR, 0.0f)
			.execute([=](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.bind_pipeline(pipeline);
				commands.bind_resources({ { RECEIVERS_BINDING_FRAME, p_context.get(frame) },
						{ RECEIVERS_BINDING_LIGHT, p_context.get(light) },
						{ RECEIVERS_BINDING_DEPTH, p_context.get(depth) },
						{ RECEIVERS_BINDING_NORMAL, p_context.get(normal) },
						{ RECEIVERS_BINDING_RECEIVERS, p_context.get(receivers) } });
				commands.push_constants(push);
				commands.draw(3);
			});
	return targets;
}

void add_volume_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const VolumeSettings &p_settings, const VolumeCasters &p_casters,
		const DrawPredicates &p_predicates, const VolumeTargets &p_targets, CachedEdges &r_edges) {
	const SilhouetteCasters listed = list_compute_casters(p_inputs, p_casters);
	SilhouetteLists lists;
	if (!listed.casters.empty()) {
		lists = r_edges.add_passes(r_graph, p_inputs, listed, p_predicates);
	}
	const std::vector<VolumeDraw> draws =
			build_volume_draws(r_graph, p_inputs, p_settings, p_casters, listed);
	for (uint32_t group = 0; group < p_casters.group_count; ++group) {
		const std::string suffix = p_casters.group_count > 1 ? text(" ", group) : "";
		PassBuilder pass = r_graph.add_pass("volumes" + suffix);
		pass.depth(p_targets.depth, LoadOp::KEEP);
		p_predicates.add_to(pass);
		if (lists.list) {
			pass.reads(lists.list, Access::SHADER_READ_VERTEX)
					.reads(lists.draws, Access::INDIRECT_READ);
		}
		std::vector<VolumeDraw> group_draws;
		for (const VolumeDraw &draw : draws) {
			if (draw.caster->group == group) {
				group_draws.push_back(draw);
				if (draw.corners) {
					pass.reads(draw.corners, Access::VERTEX_READ);
				}
			}
		}
		const bool has_depth_bounds =
				p_settings.has_scissor && p_inputs.device.get_features().depth_bounds;
		pass.execute([group_draws, lists, has_depth_bounds, p_predicates](PassContext &p_context) {
			for (const VolumeDraw &draw : group_draws) {
				const VolumeArea &area = draw.caster->area;
				p_context.commands.set_scissor(area.offset_px, area.size_px);
				if (has_depth_bounds) {
					p_context.commands.set_depth_bounds(area.min_depth, area.max_depth);
				}
				p_predicates.record(p_context, draw.caster->instance_index,
						[&] { record_draw(p_context, draw, lists); });
			}
		});
		add_hidden_pass(r_graph, p_inputs, p_targets, "hidden" + suffix);
	}
}

} // namespace gnomon
