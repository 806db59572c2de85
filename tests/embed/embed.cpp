// A minimal host of the shadow modules: no renderer, no nodes, no scene files. It links core,
// scene, mesh_tools, render_graph, a rendering device, shadows and one technique; doc/embedding.md
// walks through it.
//
//     gnomon_embed OUT.f32
//         draws its own depth, from which a pass of the shadows derives the normals
//     gnomon_embed OUT.f32 DEPTH.f32 NORMAL.u32
//         reads the depth and normals that `gnomon visibility --surfaces` wrote
//
// OUT.f32: the light's visibility in each pixel, rows from the top; -1 where there is no receiver.

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/render_graph/transient_pool.h"
#include "modules/rendering_device/rendering_device.h"
#include "modules/shadow_edge_count/register_types.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/shadow_frame.h"

#include "shadows/shadows_shared.h"

#include <cstdio>
#include <cstring>

namespace {

using namespace gnomon;

const glm::uvec2 SIZE_PX(256);

std::shared_ptr<const Mesh> make_quad(const char *p_name, const glm::vec3 &p_corner,
		const glm::vec3 &p_right, const glm::vec3 &p_up) {
	const glm::vec3 normal = glm::normalize(glm::cross(p_right, p_up));
	return make_mesh(p_name,
			{ p_corner, p_corner + p_right, p_corner + p_right + p_up, p_corner + p_up },
			{ normal, normal, normal, normal }, { 0, 1, 2, 0, 2, 3 });
}

/// Describes the host's world for the shadow modules: casters, receivers, one light and the camera.
/// test_embed.py writes the same scene as a glTF file.
std::shared_ptr<const SceneSnapshot> make_snapshot() {
	auto snapshot = std::make_shared<SceneSnapshot>();
	snapshot->scene_size_m = 8;
	snapshot->camera.position_world = { 0, 0.5, 6 };
	const std::shared_ptr<const Mesh> meshes[] = {
		make_quad("wall", { -3, -1.5f, -1.5f }, { 6, 0, 0 }, { 0, 4.5f, 0 }),
		make_quad("ground", { -3, -1.5f, 4.5f }, { 6, 0, 0 }, { 0, 0, -6 }),
		make_quad("card", { -1, -0.75f, 0 }, { 1.25f, 0.25f, 0.5f }, { -0.25f, 1.5f, 0.25f }),
		make_quad("plank", { -0.5f, -1.5f, 1 }, { 2.5f, 2, -1 }, { -0.125f, 0.25f, 0.25f }),
	};
	for (const std::shared_ptr<const Mesh> &mesh : meshes) {
		snapshot->instances.push_back(make_instance(mesh, nullptr, glm::dmat4(1.0), mesh->name));
	}
	LightSnapshot light;
	light.name = "Lamp";
	light.type = LightType::OMNI;
	light.position_world = { 1.5, 2.25, 4 };
	light.properties["light_size"] = 0.25;
	light.decide_settings(snapshot->scene_size_m);
	snapshot->lights.push_back(light);
	return snapshot;
}

/// Draws the depth that a host has anyway, as reversed Z: near / z.
RGTexture add_depth_pass(
		RenderGraph &r_graph, ShadowSystem &r_shadows, const SceneSnapshot &p_scene) {
	const RGTexture depth = r_graph.create_texture({ "depth", Format::D32_SFLOAT, SIZE_PX, 1,
			TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED });
	RasterPipelineDesc desc;
	desc.name = "depth";
	desc.vertex_shader = "shadows/depth.vert";
	desc.attributes = get_position_attributes();
	desc.vertex_strides_bytes = { sizeof(glm::vec3) };
	desc.depth_compare = CompareOp::GREATER;
	const PipelineRID pipeline = r_shadows.get_device().get_raster_pipeline(desc);
	const LightView camera = make_camera_view(p_scene.camera, SIZE_PX);
	r_graph.add_pass("depth")
			.depth(depth, LoadOp::CLEAR, /*p_clear=*/0.0f) // the background
			.execute([=, &r_shadows, &p_scene](PassContext &p_context) {
				p_context.commands.bind_pipeline(pipeline);
				for (const InstanceSnapshot &instance : p_scene.instances) {
					const GpuMesh &mesh = r_shadows.get_meshes().get(instance.mesh);
					const BufferRID vertices[] = { mesh.positions.get() };
					p_context.commands.push_constants(shader::DepthPush{
							camera.compute_clip_from_node(instance.world_from_node) });
					p_context.commands.bind_vertex_buffers(vertices);
					p_context.commands.bind_index_buffer(mesh.indices.get());
					p_context.commands.draw_indexed(mesh.index_count);
				}
			});
	return depth;
}

/// Loads raw texels that another program drew. Throws Error if they are not SIZE_PX texels.
OwnedTexture load_texture(RenderingDevice &r_device, const char *p_path, Format p_format) {
	const std::vector<uint8_t> texels = load_file(p_path);
	const size_t size_bytes = size_t(SIZE_PX.x) * SIZE_PX.y * get_texel_size_bytes(p_format);
	if (texels.size() != size_bytes) {
		fail("\"", p_path, "\" has ", texels.size(), " bytes, must have ", size_bytes,
				". Write it with gnomon visibility --surfaces --size ", SIZE_PX.x, "x", SIZE_PX.y,
				".");
	}
	return { r_device,
		r_device.create_texture_with_data(
				{ p_path, p_format, SIZE_PX, 1, TextureUsage::SAMPLED }, texels) };
}

void run(const char *p_out, const char *p_depth, const char *p_normals) {
	DeviceOptions device_options;
	device_options.validation = true;
	const std::unique_ptr<RenderingDevice> device = create_rendering_device(device_options);
	TransientPool transients(*device);
	ShadowSystem shadows(*device); // one for all frames
	OwnedTexture loaded_depth;
	OwnedTexture loaded_normals;

	// One frame.
	const std::shared_ptr<const SceneSnapshot> scene = make_snapshot();
	RenderGraph graph(*device, transients);
	FramePlan plan;
	ShadowFrame frame(shadows, graph, plan, scene, SIZE_PX);
	HostSurfaces surfaces;
	if (p_depth != nullptr) {
		loaded_depth = load_texture(*device, p_depth, Format::D32_SFLOAT);
		loaded_normals = load_texture(*device, p_normals, Format::R32_UINT);
		surfaces.depth =
				graph.import_texture(loaded_depth.get(), RenderGraph::ImportedContent::PRESERVED);
		surfaces.geometric_normal =
				graph.import_texture(loaded_normals.get(), RenderGraph::ImportedContent::PRESERVED);
	} else {
		surfaces.depth = add_depth_pass(graph, shadows, *scene);
	}
	frame.set_surfaces(surfaces);
	MaskReadback readback; // a real host's passes would use the mask here
	for (const LightSnapshot &light : scene->lights) {
		const LightShadow shadow = frame.add_light(light);
		readback.add(graph, shadow.mask, shadow.receivers);
	}
	graph.execute(RenderGraph::Mode::WAIT);
	frame.end();
	std::printf("%s", plan.to_text().c_str());

	MaskValues values = readback.get_values();
	for (size_t pixel = 0; pixel < values.visibility.size(); ++pixel) {
		values.visibility[pixel] = values.receiver[pixel] > 0 ? values.visibility[pixel] : -1.0f;
	}
	save_file_atomically(p_out, bytes_of(std::span<const float>(values.visibility)));
}

} // namespace

int main(int p_argument_count, char **p_arguments) {
	if (p_argument_count != 2 && p_argument_count != 4) {
		std::fprintf(stderr, "Usage: gnomon_embed OUT.f32 [DEPTH.f32 NORMAL.u32]\n");
		return 2;
	}
	int result = 1;
	initialize_shadow_edge_count_module(ModuleLevel::FEATURES);
	try {
		const bool has_surfaces = p_argument_count == 4;
		run(p_arguments[1], has_surfaces ? p_arguments[2] : nullptr,
				has_surfaces ? p_arguments[3] : nullptr);
		result = get_validation_message_count() == 0 ? 0 : 1;
	} catch (const std::exception &error) {
		log_error(describe_failure(error));
	}
	uninitialize_shadow_edge_count_module(ModuleLevel::FEATURES);
	return result;
}
