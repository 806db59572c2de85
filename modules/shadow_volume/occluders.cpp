#include "modules/shadow_volume/occluders.h"

#include "modules/core/text.h"
#include "modules/shadows/caster_pass.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/mesh_store.h"
#include "modules/shadows/silhouette_lists.h"

#include "shadow_volume/culling_shared.h"

#include <algorithm>
#include <array>

namespace gnomon {

namespace {

const size_t MAX_OCCLUDER_COUNT = 128;
const uint32_t MAX_TRIANGLE_COUNT = 16384; // of all occluders together
const uint32_t MAX_TRIANGLES_PER_OCCLUDER = 4096;
const double MIN_SIZE_PX = 8.0; // a smaller occluder consists of edges, drawn 3 texels wide
const double ROUNDING = 4e-7;	// relative error of a matrix-vector product in float32
const double MAX_ROUNDING_PER_DISTANCE = 1e-3; // as MIN_GAP of cull.comp
// Occluders nearer to the light than this many near distances count as being that far away.
const double MIN_DISTANCE_PER_NEAR = 10.0;
const uint32_t VERTICES_PER_EDGE = 6;
const uint32_t CORNERS_PER_FACE = 3;

/// Approximate size of the box's diagonal in texels of the view.
double estimate_size_px(const ShadowTechnique::Inputs &p_inputs, const Bounds &p_box_world) {
	const LightView &view = p_inputs.views[0];
	double half_width_m = view.half_extent.x;
	if (!view.is_orthographic) {
		const glm::dvec3 centre = 0.5 * (p_box_world.minimum + p_box_world.maximum);
		half_width_m *=
				std::max(glm::distance(centre, p_inputs.light.position_world), double(view.near_m));
	}
	return 0.5 * CULLING_MAP_SIZE_PX * p_box_world.get_diagonal() / half_width_m;
}

/// Vertices far from the node's origin lose their low bits in float32, while boxes are computed in
/// double. Rounding must not shift an occluder by more than the gap of cull.comp (MIN_GAP), or the
/// occluder could hide a caster that is in front of it.
bool is_precise(const ShadowTechnique::Inputs &p_inputs, const InstanceSnapshot &p_instance) {
	const Bounds &box = p_instance.caster_bounds_node;
	const double reach = glm::length(glm::max(glm::abs(box.minimum), glm::abs(box.maximum)));
	double scale = 0;
	for (int axis = 0; axis < 3; ++axis) {
		scale = std::max(scale, glm::length(glm::dvec3(p_instance.world_from_node[axis])));
	}
	const LightView &view = p_inputs.views[0];
	double distance_m = double(view.far_m) - view.near_m;
	if (!view.is_orthographic) {
		distance_m =
				std::max(p_instance.bounds_world.compute_distance(p_inputs.light.position_world),
						MIN_DISTANCE_PER_NEAR * view.near_m);
	}
	return reach * scale * ROUNDING <= MAX_ROUNDING_PER_DISTANCE * distance_m;
}

/// One occluder in one view.
struct OccluderDraw {
	double begin_m = 0; // minimum distance of its box along the view
	const GpuTopology *gpu = nullptr;
	shader::OccluderPush push;
};

std::vector<OccluderDraw> build_occluder_draws(const ShadowTechnique::Inputs &p_inputs,
		const LightView &p_view, const std::vector<uint32_t> &p_occluders) {
	std::vector<OccluderDraw> draws;
	for (uint32_t index : p_occluders) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		if (!p_view.may_see(instance)) {
			continue;
		}
		OccluderDraw draw;
		draw.begin_m = p_view.compute_distance_range_m(instance).x;
		draw.gpu = &p_inputs.meshes.get_topology(instance.caster_mesh,
				TopologyBuffer::POSITIONS | TopologyBuffer::EDGES | TopologyBuffer::TRIANGLES);
		draw.push.clip_from_node = p_view.compute_clip_from_node(instance.world_from_node);
		draw.push.near_m = p_view.is_orthographic ? 0.0f : p_view.near_m;
		draw.push.light_position_node =
				compute_light_position_node(p_inputs.light, instance.world_from_node);
		// A caster without edges, or collapsed to a line or point, has no volume and hides nothing.
		if (draw.gpu->edge_count > 0 && is_light_position_finite(draw.push.light_position_node)) {
			draws.push_back(draw);
		}
	}
	// Front to back: a farther occluder fills the texels that the edges of a nearer one cleared.
	std::stable_sort(draws.begin(), draws.end(), [](const auto &p_left, const auto &p_right) {
		return p_left.begin_m < p_right.begin_m;
	});
	return draws;
}

/// The stencil identifies occluders by numbers from 1 to NUMBER_COUNT, used cyclically, since each
/// number needs its own pipeline. On a software driver 128 boxes in one map take 4.0 ms with 8
/// numbers, 3.8 with 16, 4.6 with 4, and 3.3 with a dynamic stencil reference; 16 numbers make the
/// first frame 90 ms longer.
constexpr size_t NUMBER_COUNT = 8;

struct OccluderPipelines {
	std::array<PipelineRID, NUMBER_COUNT> faces; // index 0: stencil number 1
	std::array<PipelineRID, NUMBER_COUNT> edges;
	PipelineRID clear_numbers; // resets the stencil to 0, which is no number
};

/// Returns the pipelines for p_count occluders; those of unused numbers are not created.
OccluderPipelines get_pipelines(RenderingDevice &p_device, size_t p_count) {
	RasterPipelineDesc desc;
	desc.name = "occluders";
	desc.vertex_shader = "shadow_volume/occluders.vert";
	desc.fragment_shader = "shadow_volume/occluders.frag";
	desc.depth_compare = CompareOp::GREATER; // reversed: nearer
	desc.has_stencil = true;
	desc.stencil.front.pass = StencilOp::REPLACE;
	desc.stencil.back = desc.stencil.front;
	OccluderPipelines pipelines;
	const auto get_numbered = [&](std::array<PipelineRID, NUMBER_COUNT> &r_pipelines) {
		for (uint32_t number = 1; number <= std::min(p_count, NUMBER_COUNT); ++number) {
			desc.stencil.reference = number;
			r_pipelines[number - 1] = p_device.get_raster_pipeline(desc);
		}
	};
	get_numbered(pipelines.faces);
	desc.name = "occluders' edges";
	desc.vertex_shader = "shadow_volume/occluder_edges.vert";
	desc.fragment_shader = "";
	desc.depth_compare = CompareOp::LESS; // reversed: farther
	desc.stencil.front = { .compare = CompareOp::EQUAL };
	desc.stencil.back = desc.stencil.front;
	get_numbered(pipelines.edges);
	if (p_count > NUMBER_COUNT) {
		desc = make_screen_desc("occluders' numbers", "");
		desc.color_formats.clear();
		desc.stencil.front.pass = desc.stencil.back.pass = StencilOp::ZERO;
		pipelines.clear_numbers = p_device.get_raster_pipeline(desc);
	}
	return pipelines;
}

/// Draws the faces of each occluder and then its edges, which correct the texels that they cross
/// before the next occluder is drawn. The stencil test limits the correction to the occluder's own
/// texels.
void record_draws(CommandList &r_commands, const OccluderPipelines &p_pipelines,
		const std::vector<OccluderDraw> &p_draws) {
	for (size_t index = 0; index < p_draws.size(); ++index) {
		const OccluderDraw &draw = p_draws[index];
		const size_t number_index = index % NUMBER_COUNT;
		if (index > 0 && number_index == 0) {
			r_commands.bind_pipeline(p_pipelines.clear_numbers);
			r_commands.draw(3);
		}
		r_commands.bind_pipeline(p_pipelines.faces[number_index]);
		r_commands.bind_resources({ { CULLING_BINDING_POSITIONS, draw.gpu->positions.get() },
				{ CULLING_BINDING_TRIANGLES, draw.gpu->triangles.get() } });
		r_commands.push_constants(draw.push);
		r_commands.draw(CORNERS_PER_FACE * draw.gpu->topology->get_face_count());
		r_commands.bind_pipeline(p_pipelines.edges[number_index]);
		r_commands.bind_resources({ { CULLING_BINDING_POSITIONS, draw.gpu->positions.get() },
				{ CULLING_BINDING_EDGES, draw.gpu->edges.get() } });
		r_commands.push_constants(draw.push);
		r_commands.draw(VERTICES_PER_EDGE * draw.gpu->edge_count);
	}
}

/// Adds passes that build the depth pyramids of all views, see bounds.comp. Returns their buffer.
RGBuffer add_level_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, RGTexture p_map, uint32_t p_view_count) {
	const RGBuffer bounds = r_graph.create_buffer(
			{ "occluders' bounds", uint64_t(p_view_count) * CULLING_BOUNDS_PER_VIEW * sizeof(float),
					BufferUsage::STORAGE });
	const PipelineRID pipeline =
			p_device.get_compute_pipeline({ "occluders' bounds", "shadow_volume/bounds.comp", {} });
	uint32_t size_px = CULLING_MAP_SIZE_PX;
	for (uint32_t level = 1; level < CULLING_LEVEL_COUNT; ++level) {
		size_px /= CULLING_LEVEL_FACTOR;
		r_graph.add_pass(text("occluders' level ", level))
				.reads(p_map, Access::SHADER_READ_COMPUTE)
				.writes(bounds, Access::SHADER_WRITE_COMPUTE,
						level == 1 ? PassBuilder::Content::FRESH : PassBuilder::Content::UPDATE)
				.execute([=](PassContext &p_context) {
					CommandList &commands = p_context.commands;
					commands.bind_pipeline(pipeline);
					for (uint32_t view = 0; view < p_view_count; ++view) {
						Binding map = { CULLING_BINDING_DEPTH, p_context.get(p_map) };
						map.layer = view;
						commands.bind_resources(
								{ map, { CULLING_BINDING_BOUNDS, p_context.get(bounds) } });
						commands.push_constants(shader::BoundsPush{ view, level, 0, 0 });
						commands.dispatch_items({ size_px, size_px, 1 });
					}
				});
	}
	return bounds;
}

} // namespace

std::vector<uint32_t> choose_occluders(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_instances, const std::vector<bool> &p_was_hidden) {
	struct Candidate {
		uint32_t instance_index;
		bool was_hidden;
		double size_px;
	};
	std::vector<Candidate> candidates;
	for (size_t i = 0; i < p_instances.size(); ++i) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[p_instances[i]];
		const double size_px = estimate_size_px(p_inputs, instance.bounds_world);
		if (size_px >= MIN_SIZE_PX &&
				instance.caster_mesh->get_triangle_count() <= MAX_TRIANGLES_PER_OCCLUDER &&
				is_precise(p_inputs, instance)) {
			candidates.push_back(
					{ p_instances[i], !p_was_hidden.empty() && p_was_hidden[i], size_px });
		}
	}
	std::stable_sort(candidates.begin(), candidates.end(),
			[](const Candidate &p_left, const Candidate &p_right) {
				return p_left.was_hidden != p_right.was_hidden ? p_right.was_hidden
															   : p_left.size_px > p_right.size_px;
			});
	std::vector<uint32_t> occluders;
	uint32_t triangle_count = 0;
	for (const Candidate &candidate : candidates) {
		const uint32_t count = p_inputs.scene.instances[candidate.instance_index]
									   .caster_mesh->get_triangle_count();
		if (triangle_count + count <= MAX_TRIANGLE_COUNT && occluders.size() < MAX_OCCLUDER_COUNT) {
			triangle_count += count;
			occluders.push_back(candidate.instance_index);
		}
	}
	return occluders;
}

OccluderMap add_occluder_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_occluders) {
	const uint32_t view_count = static_cast<uint32_t>(p_inputs.views.size());
	const RGTexture map = r_graph.create_texture(
			{ "occluders", Format::D32_SFLOAT_S8_UINT, glm::uvec2(CULLING_MAP_SIZE_PX), view_count,
					TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED, /*is_array=*/true });
	const OccluderPipelines pipelines = get_pipelines(p_inputs.device, p_occluders.size());
	for (uint32_t view = 0; view < view_count; ++view) {
		r_graph.add_pass(text("occluders view ", view))
				.depth(map, LoadOp::CLEAR, 0.0f, view)
				.execute([pipelines,
								 draws = build_occluder_draws(p_inputs, p_inputs.views[view],
										 p_occluders)](PassContext &p_context) {
					record_draws(p_context.commands, pipelines, draws);
				});
	}
	return { map, add_level_passes(r_graph, p_inputs.device, map, view_count) };
}

} // namespace gnomon
