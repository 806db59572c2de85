#pragma once

#include "modules/shadows/camera_view.h"
#include "modules/shadows/shadow_frame.h"

// A minimal host of the shadow system: it draws depth, normals and materials, but no lighting.

namespace gnomon {

/// Adds the pass that draws what the camera sees. Draws normals only when they are needed and the
/// device supports the primitive's index in fragment shaders.
inline HostSurfaces add_surface_pass(RenderGraph &r_graph, ShadowSystem &r_shadows,
		const SceneSnapshot &p_scene, glm::uvec2 p_size_px, RGBuffer p_frame,
		bool p_wants_normals = true) {
	const bool draws_normals =
			p_wants_normals && r_shadows.get_device().get_features().geometry_shader;
	const auto create = [&](const char *p_name, Format p_format, TextureUsage p_usage) {
		return r_graph.create_texture({ p_name, p_format, p_size_px, 1,
				p_usage | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
	};
	const HostSurfaces surfaces = {
		create("depth", Format::D32_SFLOAT, TextureUsage::DEPTH_ATTACHMENT),
		draws_normals ? create("normal", Format::R32_UINT, TextureUsage::COLOR_ATTACHMENT)
					  : RGTexture(),
		create("material", Format::RGBA16_SFLOAT, TextureUsage::COLOR_ATTACHMENT),
	};
	RasterPipelineDesc desc;
	desc.name = "surfaces";
	desc.vertex_shader = "tests/surfaces.vert";
	desc.fragment_shader = draws_normals ? "tests/surfaces.frag" : "tests/materials.frag";
	desc.attributes = get_position_attributes();
	desc.vertex_strides_bytes = { sizeof(glm::vec3) };
	desc.color_formats = { Format::RGBA16_SFLOAT };
	if (draws_normals) {
		desc.color_formats.push_back(Format::R32_UINT);
	}
	desc.depth_compare = CompareOp::GREATER;
	struct Push {
		glm::mat4 camera_relative_from_node;
		glm::vec4 material;
	};
	struct Draw {
		const GpuMesh *mesh;
		Push push;
		PipelineRID pipeline;
	};
	std::vector<Draw> draws;
	const LightView camera_view = make_camera_view(p_scene.camera, p_size_px);
	for (const InstanceSnapshot &instance : p_scene.instances) {
		if (!camera_view.may_see(instance)) {
			continue;
		}
		const Material &material = *instance.material;
		desc.cull_mode = material.is_double_sided ? CullMode::NONE : CullMode::BACK;
		desc.winding = instance.is_mirrored() ? Winding::MIRRORED : Winding::NORMAL;
		draws.push_back({ &r_shadows.get_meshes().get(instance.mesh),
				{ p_scene.get_camera_relative_from_node(instance),
						{ material.scatter, material.scatter_distance_m, 0, 0 } },
				r_shadows.get_device().get_raster_pipeline(desc) });
	}
	PassBuilder pass = r_graph.add_pass("surfaces");
	pass.reads(p_frame, Access::UNIFORM_READ).color(surfaces.material);
	if (draws_normals) {
		pass.color(surfaces.geometric_normal);
	}
	pass.depth(surfaces.depth, LoadOp::CLEAR, 0.0f)
			.execute([=, draws = std::move(draws)](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				for (const Draw &draw : draws) {
					const BufferRID vertices[] = { draw.mesh->positions.get() };
					std::vector<Binding> bindings = { { 0, p_context.get(p_frame) } };
					if (draws_normals) {
						bindings.emplace_back(1, draw.mesh->positions.get());
						bindings.emplace_back(2, draw.mesh->indices.get());
					}
					commands.bind_pipeline(draw.pipeline);
					commands.bind_resources(bindings);
					commands.push_constants(draw.push);
					commands.bind_vertex_buffers(vertices);
					commands.bind_index_buffer(draw.mesh->indices.get());
					commands.draw_indexed(draw.mesh->index_count);
				}
			});
	return surfaces;
}

} // namespace gnomon
