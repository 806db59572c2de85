#include "modules/godot_addon/view_depth.h"

#include "modules/shadows/camera_view.h"

#include "godot_addon/godot_addon_shared.h"
#include "shadows/shadows_shared.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

// Depths that differ by at most this fraction belong to one surface. The depths of a surface that
// two shaders compute differ by about 1e-6.
const float SURFACE_TOLERANCE = 2e-5f;
// A reduced mesh deviates by about threshold_px pixels across the image, and by up to this many
// times as much along the view direction.
const float MAX_DEVIATION_FACTOR = 16.0f;

RasterPipelineDesc make_mesh_pipeline() {
	RasterPipelineDesc desc;
	desc.name = "depth of meshes";
	desc.vertex_shader = "shadows/depth.vert";
	desc.attributes = get_position_attributes();
	desc.vertex_strides_bytes = { sizeof(glm::vec3) };
	desc.depth_compare = CompareOp::GREATER;
	return desc;
}

RasterPipelineDesc make_screen_depth_pipeline(const char *p_name, const char *p_shader) {
	RasterPipelineDesc desc;
	desc.name = p_name;
	desc.vertex_shader = "shadows/screen.vert";
	desc.fragment_shader = p_shader;
	desc.depth_compare = CompareOp::ALWAYS;
	return desc;
}

RGTexture create_depth(RenderGraph &r_graph, const char *p_name, glm::uvec2 p_size_px) {
	return r_graph.create_texture({ p_name, Format::D32_SFLOAT, p_size_px, 1,
			TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED });
}

/// Adds a pass that draws the depth, near / z, of one mesh of each instance: of the member p_mesh.
RGTexture add_mesh_depth(RenderGraph &r_graph, MeshStore &r_meshes, const char *p_name,
		glm::uvec2 p_size_px, const std::shared_ptr<const ReducedInstances> &p_reduced,
		std::shared_ptr<const Mesh> ReducedInstance::*p_mesh) {
	const RGTexture depth = create_depth(r_graph, p_name, p_size_px);
	const PipelineRID pipeline = r_meshes.get_device().get_raster_pipeline(make_mesh_pipeline());
	r_graph.add_pass(p_name)
			.depth(depth, LoadOp::CLEAR, 0.0f)
			.execute([=, &r_meshes](PassContext &p_context) {
				p_context.commands.bind_pipeline(pipeline);
				for (const ReducedInstance &instance : p_reduced->list) {
					const GpuMesh &mesh = r_meshes.get(instance.*p_mesh);
					const BufferRID vertices[] = { r_meshes.get(instance.full).positions.get() };
					p_context.commands.push_constants(shader::DepthPush{ instance.clip_from_node });
					p_context.commands.bind_vertex_buffers(vertices);
					p_context.commands.bind_index_buffer(mesh.indices.get());
					p_context.commands.draw_indexed(mesh.index_count);
				}
			});
	return depth;
}

/// Returns the position of a pixel's first sample from its centre, in pixels, right and down:
/// Vulkan's standard sample locations.
glm::vec2 get_first_sample(uint32_t p_sample_count) {
	switch (p_sample_count) {
		case 2:
			return { 0.25f, 0.25f };
		case 4:
			return { -0.125f, -0.375f };
		case 8:
			return { 0.0625f, -0.1875f };
		default:
			return glm::vec2(0.0f);
	}
}

std::string find_unsupported_view(
		const glm::mat4 &p_projection, glm::uvec2 p_size_px, int64_t p_view_count) {
	if (p_view_count > 1) {
		return "has several views at once (XR)";
	}
	// Temporal antialiasing shifts the projection by less than a pixel, which is 2 / size in clip
	// space.
	if (std::abs(p_projection[2][0]) * float(p_size_px.x) > 2.0f ||
			std::abs(p_projection[2][1]) * float(p_size_px.y) > 2.0f) {
		return "has a projection that is not centred";
	}
	const float aspect = float(p_size_px.x) / float(p_size_px.y);
	const float ratio = std::abs(p_projection[1][1] / p_projection[0][0]) / aspect;
	if (!(std::abs(ratio - 1.0f) < 0.01f)) { // more than 1 % apart, or NaN
		return "has pixels that are not square";
	}
	return {};
}

} // namespace

GodotView read_view(GodotDevice &r_device, const godot::RenderData &p_data,
		const godot::RenderSceneBuffersRD &p_buffers) {
	const godot::RenderSceneData data = p_data.get_render_scene_data();
	GodotView view;
	view.size_px = glm::uvec2(p_buffers.get_internal_size());
	// Before opaque objects are drawn, Godot has not always resolved the samples: with a normal and
	// roughness buffer, which SSAO, SSIL, SSR and SDFGI need, it does so later.
	const int64_t samples = p_buffers.get_texture_samples();
	view.depth = p_buffers.get_depth_texture(
			/*msaa=*/samples != godot::RenderingDevice::TEXTURE_SAMPLES_1);
	static_assert(godot::RenderingDevice::TEXTURE_SAMPLES_1 == 0 &&
			godot::RenderingDevice::TEXTURE_SAMPLES_8 == 3); // logarithms
	if (samples != godot::RenderingDevice::TEXTURE_SAMPLES_2 || r_device.has_two_samples()) {
		view.sample_count = 1u << samples;
	}
	view.color = p_buffers.get_color_texture(/*msaa=*/false);
	view.camera_transform = data.get_cam_transform();
	const glm::mat4 projection = data.get_cam_projection();
	view.is_orthogonal = projection[3][3] != 0.0f;
	if (view.is_orthogonal) {
		return view;
	}
	view.unsupported_reason =
			find_unsupported_view(projection, view.size_px, p_buffers.get_view_count());
	if (view.unsupported_reason.empty()) {
		const glm::dmat4 world_from_camera = view.camera_transform.to_matrix();
		view.camera.name = "Camera";
		view.camera.position_world = glm::dvec3(world_from_camera[3]);
		view.camera.world_from_camera =
				compute_orientation(world_from_camera, "Camera", view.camera.name);
		view.camera.vertical_fov_rad =
				static_cast<float>(2.0 * std::atan(1.0 / std::abs(double(projection[1][1]))));
		view.horizontal_scale = projection[0][0];
		view.depth_offset = projection[2][2];
		const glm::vec2 sample =
				2.0f * get_first_sample(view.sample_count) / glm::vec2(view.size_px);
		view.camera.shift = glm::vec2(projection[2][0] + sample.x,
				-projection[2][1] - sample.y); // clip y is down
		// Where the depth P[3][2] / z - P[2][2] is 1.
		view.camera.near_m = projection[3][2] / (1.0f + projection[2][2]);
	}
	return view;
}

ViewDetail find_view_detail(const ScenarioFrame &p_frame, const GodotView &p_view) {
	const auto found = std::find_if(p_frame.views.begin(), p_frame.views.end(),
			[&](const ViewDetail &p_detail) { return p_detail.camera == p_view.camera_transform; });
	return found != p_frame.views.end() ? *found
			: p_frame.views.empty()		? ViewDetail()
										: p_frame.views.front();
}

ReducedInstances find_reduced_instances(const ScenarioFrame &p_frame, const SceneSnapshot &p_scene,
		const GodotView &p_view, const ViewDetail &p_detail) {
	const LightView view = make_camera_view(p_scene.camera, p_view.size_px);
	const float aspect = float(p_view.size_px.x) / float(p_view.size_px.y);
	const float width_px = float(p_view.size_px.x) / p_detail.resolution_scale;
	const glm::mat4 shift(compute_shift(p_scene.camera));
	ReducedInstances reduced;
	// 2 * half_extent.x / width_px is the size of a pixel at distance 1.
	reduced.lod_tolerance =
			MAX_DEVIATION_FACTOR * p_detail.threshold_px * 2.0f * view.half_extent.x / width_px;
	for (const InstanceDetail &candidate : p_frame.details) {
		const InstanceSnapshot &instance = p_scene.instances[candidate.instance];
		if (!view.may_see(instance)) {
			continue;
		}
		if (const std::shared_ptr<const Mesh> drawn = choose_detail_level(
					candidate, p_scene.camera, aspect, p_detail.threshold_px, width_px)) {
			reduced.list.push_back({ instance.mesh, drawn,
					shift * view.compute_clip_from_node(instance.world_from_node) });
		}
	}
	return reduced;
}

RGTexture add_view_depth(RenderGraph &r_graph, MeshStore &r_meshes, const GodotView &p_view,
		RGTexture p_depth, std::shared_ptr<const ReducedInstances> p_reduced,
		RGTexture p_published) {
	const RGTexture scene = create_depth(r_graph, "depth", p_view.size_px);
	const PipelineRID convert =
			r_meshes.get_device().get_raster_pipeline(make_screen_depth_pipeline("convert depth",
					p_view.has_depth_samples() ? "godot_addon/convert_sample_depth.frag"
							: p_published	   ? "godot_addon/convert_published_depth.frag"
											   : "godot_addon/convert_depth.frag"));
	shader::ConvertDepthPush convert_push = {};
	convert_push.offset = p_view.depth_offset;
	PassBuilder pass = r_graph.add_pass("convert depth");
	pass.reads(p_depth, Access::SHADER_READ_FRAGMENT).depth(scene, LoadOp::CLEAR, 0.0f);
	if (p_published) {
		pass.writes(p_published, Access::SHADER_WRITE_FRAGMENT);
	}
	pass.execute([=](PassContext &p_context) {
		std::vector<Binding> bindings = { { CONVERT_BINDING_DEPTH, p_context.get(p_depth) } };
		if (p_published) {
			bindings.push_back({ CONVERT_BINDING_PUBLISHED, p_context.get(p_published) });
		}
		p_context.commands.bind_pipeline(convert);
		p_context.commands.bind_resources(bindings);
		p_context.commands.push_constants(convert_push);
		p_context.commands.draw(3);
	});
	if (p_reduced->list.empty()) {
		return scene;
	}
	const RGTexture drawn = add_mesh_depth(r_graph, r_meshes, "depth of reduced meshes",
			p_view.size_px, p_reduced, &ReducedInstance::drawn);
	const RGTexture full = add_mesh_depth(r_graph, r_meshes, "depth of full meshes", p_view.size_px,
			p_reduced, &ReducedInstance::full);
	const RGTexture merged = create_depth(r_graph, "depth of receivers", p_view.size_px);
	const PipelineRID merge = r_meshes.get_device().get_raster_pipeline(
			make_screen_depth_pipeline("merge depth", "godot_addon/merge_depth.frag"));
	shader::MergeDepthPush merge_push = {};
	merge_push.surface_tolerance = SURFACE_TOLERANCE;
	merge_push.lod_tolerance = p_reduced->lod_tolerance;
	r_graph.add_pass("merge depth")
			.reads(scene, Access::SHADER_READ_FRAGMENT)
			.reads(drawn, Access::SHADER_READ_FRAGMENT)
			.reads(full, Access::SHADER_READ_FRAGMENT)
			.depth(merged, LoadOp::CLEAR, 0.0f)
			.execute([=](PassContext &p_context) {
				p_context.commands.bind_pipeline(merge);
				p_context.commands.bind_resources({ { MERGE_BINDING_SCENE, p_context.get(scene) },
						{ MERGE_BINDING_DRAWN, p_context.get(drawn) },
						{ MERGE_BINDING_FULL, p_context.get(full) } });
				p_context.commands.push_constants(merge_push);
				p_context.commands.draw(3);
			});
	return merged;
}

} // namespace gnomon
