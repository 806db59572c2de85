#include "modules/renderer/gbuffer.h"

#include "modules/core/error.h"
#include "modules/shadows/camera_view.h"

#include "renderer/renderer_shared.h"

namespace gnomon {

GBuffer add_gbuffer_pass(RenderGraph &r_graph, RenderingDevice &p_device, MeshStore &p_meshes,
		const SceneSnapshot &p_scene, glm::uvec2 p_size_px, RGBuffer p_frame,
		uint32_t &r_drawn_count) {
	// The corners of a face are found by the primitive's index.
	const bool has_face_normals = p_device.get_features().geometry_shader;
	const auto create = [&](const char *p_name, Format p_format) {
		const TextureUsage target = p_format == Format::D32_SFLOAT ? TextureUsage::DEPTH_ATTACHMENT
																   : TextureUsage::COLOR_ATTACHMENT;
		return r_graph.create_texture({ p_name, p_format, p_size_px, 1,
				target | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
	};
	GBuffer gbuffer;
	gbuffer.depth = create("camera depth", Format::D32_SFLOAT);
	gbuffer.base_color = create("base colour", Format::RGBA8_SRGB);
	if (has_face_normals) {
		gbuffer.geometric_normal = create("geometric normal", Format::R32_UINT);
	}
	gbuffer.shading_normal = create("shading normal", Format::R32_UINT);
	gbuffer.material = create("material", Format::RGBA16_SFLOAT);
	gbuffer.emissive = create("emissive", Format::RGBA16_SFLOAT);

	RasterPipelineDesc desc;
	desc.name = "G-buffer";
	desc.vertex_shader = "renderer/gbuffer.vert";
	desc.fragment_shader =
			has_face_normals ? "renderer/gbuffer.frag" : "renderer/gbuffer_without_faces.frag";
	desc.attributes = get_position_normal_attributes();
	desc.vertex_strides_bytes = { sizeof(glm::vec3), sizeof(glm::vec3) };
	desc.color_formats = { Format::RGBA8_SRGB, Format::R32_UINT, Format::RGBA16_SFLOAT,
		Format::RGBA16_SFLOAT };
	if (has_face_normals) {
		desc.color_formats.push_back(Format::R32_UINT);
	}
	desc.depth_compare = CompareOp::GREATER;
	PipelineRID pipelines[2][2]; // mirrored, double-sided; made when first needed
	const auto get_pipeline = [&](bool p_is_mirrored, bool p_is_double_sided) {
		PipelineRID &r_pipeline = pipelines[p_is_mirrored][p_is_double_sided];
		if (!r_pipeline) {
			desc.winding = p_is_mirrored ? Winding::MIRRORED : Winding::NORMAL;
			desc.cull_mode = p_is_double_sided ? CullMode::NONE : CullMode::BACK;
			r_pipeline = p_device.get_raster_pipeline(desc);
		}
		return r_pipeline;
	};

	struct Draw {
		const GpuMesh *mesh;
		shader::InstancePush push;
		PipelineRID pipeline;
	};
	std::vector<Draw> draws;
	const LightView camera_view = make_camera_view(p_scene.camera, p_size_px);
	for (const InstanceSnapshot &instance : p_scene.instances) {
		if (!camera_view.may_see(instance)) {
			continue;
		}
		const Material &material = *instance.material;
		shader::InstancePush push = {};
		push.camera_relative_from_node = p_scene.get_camera_relative_from_node(instance);
		// Below 0: Phong's, see brdf_inc.glsl.
		const float roughness = material.shading_model == ShadingModel::PHONG
				? -1.0f - material.roughness
				: material.roughness;
		push.base_color_roughness = glm::vec4(material.base_color, roughness);
		push.emissive_metallic = glm::vec4(material.emissive, material.metallic);
		push.scatter = material.scatter;
		push.scatter_distance_m = material.scatter_distance_m;
		push.is_mirrored = instance.is_mirrored() ? 1u : 0u;
		draws.push_back({ &p_meshes.get(instance.mesh), push,
				get_pipeline(instance.is_mirrored(), material.is_double_sided) });
	}
	r_drawn_count = static_cast<uint32_t>(draws.size());
	PassBuilder pass = r_graph.add_pass("G-buffer");
	pass.reads(p_frame, Access::UNIFORM_READ)
			.color(gbuffer.base_color)
			.color(gbuffer.shading_normal)
			.color(gbuffer.material)
			.color(gbuffer.emissive);
	if (has_face_normals) {
		pass.color(gbuffer.geometric_normal);
	}
	pass.depth(gbuffer.depth, LoadOp::CLEAR, 0.0f)
			.execute([draws = std::move(draws), p_frame, has_face_normals](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				for (const Draw &draw : draws) {
					const BufferRID vertices[] = { draw.mesh->positions.get(),
						draw.mesh->normals.get() };
					std::vector<Binding> bindings = { { GBUFFER_BINDING_FRAME,
							p_context.get(p_frame) } };
					if (has_face_normals) {
						bindings.emplace_back(
								GBUFFER_BINDING_POSITIONS, draw.mesh->positions.get());
						bindings.emplace_back(GBUFFER_BINDING_INDICES, draw.mesh->indices.get());
					}
					commands.bind_pipeline(draw.pipeline);
					commands.bind_resources(bindings);
					commands.push_constants(draw.push);
					commands.bind_vertex_buffers(vertices);
					commands.bind_index_buffer(draw.mesh->indices.get());
					commands.draw_indexed(draw.mesh->index_count);
				}
			});
	return gbuffer;
}

} // namespace gnomon
