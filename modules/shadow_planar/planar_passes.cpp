#include "modules/shadow_planar/planar_passes.h"

#include "modules/core/text.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/mesh_store.h"

#include "shadow_planar/shadow_planar_shared.h"

#include <cmath>

namespace gnomon {

namespace {

const uint32_t ON_PLANE = 1; // stencil value of the plane's pixels that are not in shadow yet

// Maximum distance of a pixel's surface from the plane: a fraction of S plus a fraction of the
// distance from the camera.
const float PLANE_TOLERANCE = 1e-5f;
const float PLANE_TOLERANCE_PER_DISTANCE = 2e-6f;

/// Declares what a pass with plane.frag reads: camera constants, surfaces and receivers.
void read_gbuffer(PassBuilder &r_pass, const ShadowTechnique::Inputs &p_inputs) {
	r_pass.reads(p_inputs.frame, Access::UNIFORM_READ)
			.reads(p_inputs.depth, Access::SHADER_READ_FRAGMENT)
			.reads(p_inputs.geometric_normal, Access::SHADER_READ_FRAGMENT)
			.reads(p_inputs.receivers, Access::SHADER_READ_FRAGMENT);
}

/// Moves the plane towards the light by the offset of the nearest receiver that it may have, right
/// before the camera. Farther receivers have larger offsets, but by less than RECEIVER_OFFSET_PX of
/// a pixel.
glm::dvec4 move_plane(const ShadowTechnique::Inputs &p_inputs, const glm::dvec4 &p_plane) {
	const double camera_distance_m = std::abs(p_plane.w);
	const float offset_m =
			compute_receiver_offset_m(compute_frame_constants(p_inputs.scene, p_inputs.size_px),
					static_cast<float>(camera_distance_m));
	return p_plane - glm::dvec4(0, 0, 0, offset_m);
}

struct PlanarDraw {
	const GpuMesh *mesh = nullptr;
	shader::FlattenPush push;
};

std::vector<PlanarDraw> build_draws(const ShadowTechnique::Inputs &p_inputs,
		const glm::dvec4 &p_plane, const std::vector<uint32_t> &p_casters) {
	const SceneSnapshot &scene = p_inputs.scene;
	const LightSnapshot &light = p_inputs.light;
	const bool is_point = light.type != LightType::DIRECTIONAL;
	const glm::dvec4 light_position = is_point
			? glm::dvec4(light.position_world - scene.camera.position_world, 1.0)
			: glm::dvec4(-light.get_direction_world(), 0.0);
	const double light_height = glm::dot(p_plane, light_position);
	// p -> (plane . light) p - (plane . p) light (Blinn 1988)
	const glm::dmat4 flatten =
			glm::dmat4(1.0) * light_height - glm::outerProduct(light_position, p_plane);
	const LightView camera = make_camera_view(scene.camera, p_inputs.size_px);
	const glm::dmat4 clip_from_relative = compute_shift(scene.camera) *
			camera.compute_clip_from_view() * glm::dmat4(glm::dmat3(camera.view_from_world)) *
			flatten;
	std::vector<PlanarDraw> draws;
	for (uint32_t index : p_casters) {
		const InstanceSnapshot &instance = scene.instances[index];
		glm::dmat4 relative_from_node = instance.world_from_node;
		relative_from_node[3] -= glm::dvec4(scene.camera.position_world, 0.0);
		PlanarDraw draw;
		draw.mesh = &p_inputs.meshes.get(instance.caster_mesh);
		draw.push.clip_from_node = glm::mat4(clip_from_relative * relative_from_node);
		draw.push.plane_node = glm::vec4(glm::transpose(relative_from_node) * p_plane);
		// Points higher than the light hide nothing. No point is higher than a sun.
		draw.push.max_height_m = is_point ? static_cast<float>(light_height) : 1e30f;
		draws.push_back(draw);
	}
	return draws;
}

} // namespace

PlanarTargets add_lit_pass(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs) {
	PlanarTargets targets;
	targets.mask = create_drawn_mask(r_graph, p_inputs.size_px);
	targets.stencil = create_stencil_target(r_graph, "planar stencil", p_inputs.size_px);
	RasterPipelineDesc desc = make_screen_desc("lit receivers", "shadow_planar/lit.frag");
	desc.has_depth = desc.has_stencil = false;
	const PipelineRID pipeline = p_inputs.device.get_raster_pipeline(desc);
	const RGTexture receivers = p_inputs.receivers;
	r_graph.add_pass("lit receivers")
			.reads(receivers, Access::SHADER_READ_FRAGMENT)
			.color(targets.mask)
			.execute([=](PassContext &p_context) {
				p_context.commands.bind_pipeline(pipeline);
				p_context.commands.bind_resources(
						{ { PLANAR_BINDING_RECEIVERS, p_context.get(receivers) } });
				p_context.commands.draw(3); // one triangle over the whole image
			});
	return targets;
}

void add_plane_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const ReceiverPlane &p_plane, uint32_t p_plane_index,
		const std::vector<uint32_t> &p_casters, const PlanarTargets &p_targets) {
	const glm::dvec4 plane(p_plane.normal, p_plane.offset_m);
	RasterPipelineDesc mark_desc = make_screen_desc("plane", "shadow_planar/plane.frag");
	mark_desc.color_formats.clear();
	mark_desc.stencil.reference = ON_PLANE;
	mark_desc.stencil.front.pass = mark_desc.stencil.back.pass = StencilOp::REPLACE;
	const PipelineRID mark_pipeline = p_inputs.device.get_raster_pipeline(mark_desc);
	shader::PlanePush mark_push = {};
	mark_push.plane = glm::vec4(plane);
	mark_push.tolerance_m = PLANE_TOLERANCE * static_cast<float>(p_inputs.scene.scene_size_m);
	mark_push.tolerance_per_distance = PLANE_TOLERANCE_PER_DISTANCE;
	const RGBuffer frame = p_inputs.frame;
	const RGTexture depth = p_inputs.depth;
	const RGTexture normal = p_inputs.geometric_normal;
	const RGTexture receivers = p_inputs.receivers;
	PassBuilder mark_pass = r_graph.add_pass(text("plane ", p_plane_index));
	read_gbuffer(mark_pass, p_inputs);
	mark_pass.depth(p_targets.stencil, LoadOp::CLEAR, 0.0f).execute([=](PassContext &p_context) {
		CommandList &commands = p_context.commands;
		commands.bind_pipeline(mark_pipeline);
		commands.bind_resources({ { PLANAR_BINDING_FRAME, p_context.get(frame) },
				{ PLANAR_BINDING_DEPTH, p_context.get(depth) },
				{ PLANAR_BINDING_NORMAL, p_context.get(normal) },
				{ PLANAR_BINDING_RECEIVERS, p_context.get(receivers) } });
		commands.push_constants(mark_push);
		commands.draw(3); // one triangle over the whole image
	});

	RasterPipelineDesc desc;
	desc.name = "flattened casters";
	desc.vertex_shader = "shadow_planar/flatten.vert";
	desc.fragment_shader = "shadow_planar/flatten.frag";
	desc.attributes = get_position_attributes();
	desc.vertex_strides_bytes = { sizeof(glm::vec3) };
	desc.color_formats = { Format::R16_SFLOAT };
	desc.has_stencil = true;
	// The first caster that covers a pixel clears its stencil, so that it is not drawn again.
	desc.stencil.front = { .compare = CompareOp::EQUAL, .pass = StencilOp::ZERO };
	desc.stencil.back = desc.stencil.front;
	desc.stencil.reference = ON_PLANE;
	desc.depth_compare = CompareOp::ALWAYS;
	desc.writes_depth = false;
	const PipelineRID pipeline = p_inputs.device.get_raster_pipeline(desc);
	r_graph.add_pass(text("casters on plane ", p_plane_index))
			.color(p_targets.mask, LoadOp::KEEP)
			.depth(p_targets.stencil, LoadOp::KEEP)
			.execute([draws = build_draws(p_inputs, move_plane(p_inputs, plane), p_casters),
							 pipeline](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.bind_pipeline(pipeline);
				for (const PlanarDraw &draw : draws) {
					const BufferRID positions[] = { draw.mesh->positions.get() };
					commands.push_constants(draw.push);
					commands.bind_vertex_buffers(positions);
					commands.bind_index_buffer(draw.mesh->indices.get());
					commands.draw_indexed(draw.mesh->index_count);
				}
			});
}

} // namespace gnomon
