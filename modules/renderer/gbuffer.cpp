#include "modules/renderer/gbuffer.h"

#include "modules/core/error.h"
#include "modules/renderer/normal_packing.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gnomon {

namespace {

// Ambient light relative to the exposure: enough to read shapes in the umbra.
constexpr float AMBIENT_SHOWN = 0.06f;
constexpr float WHITE_SHOWN = 0.8f;

float compute_light_illuminance(const LightSnapshot &p_light, const glm::dvec3 &p_position_world) {
	const float brightest = std::max({ p_light.color.x, p_light.color.y, p_light.color.z });
	const float intensity = p_light.intensity * brightest;
	if (p_light.type == LightType::DIRECTIONAL) {
		return intensity;
	}
	const glm::dvec3 to_light = p_light.position_world - p_position_world;
	return static_cast<float>(intensity / std::max(glm::dot(to_light, to_light), 1e-6));
}

} // namespace

glm::vec3 compute_position(const shader::FrameConstants &p_frame, glm::uvec2 p_size_px,
		glm::uvec2 p_pixel, float p_depth) {
	const glm::vec2 uv = (glm::vec2(p_pixel) + 0.5f) / glm::vec2(p_size_px);
	return p_frame.near_m / p_depth *
			(glm::vec3(p_frame.forward) + (2.0f * uv.x - 1.0f) * glm::vec3(p_frame.right_tangent) +
					(1.0f - 2.0f * uv.y) * glm::vec3(p_frame.up_tangent));
}

std::vector<SurfacePoint> read_surfaces(const shader::FrameConstants &p_frame, glm::uvec2 p_size_px,
		const GBufferTexels &p_texels) {
	const float tangent = glm::length(glm::vec3(p_frame.up_tangent));
	std::vector<SurfacePoint> surfaces(size_t(p_size_px.x) * p_size_px.y);
	for (size_t index = 0; index < surfaces.size(); ++index) {
		float depth = 0;
		uint32_t packed_normal = 0;
		uint16_t material[4] = {};
		std::memcpy(&depth, p_texels.depth + index * sizeof(depth), sizeof(depth));
		std::memcpy(&packed_normal, p_texels.geometric_normal + index * sizeof(packed_normal),
				sizeof(packed_normal));
		std::memcpy(&material, p_texels.material + index * sizeof(material), sizeof(material));
		if (depth > 0.0f) {
			const glm::uvec2 pixel(index % p_size_px.x, index / p_size_px.x);
			surfaces[index] = { true, compute_position(p_frame, p_size_px, pixel, depth),
				unpack_normal(packed_normal),
				{ glm::unpackHalf1x16(material[0]), glm::unpackHalf1x16(material[1]) },
				2.0f * p_frame.near_m / depth * tangent / static_cast<float>(p_size_px.y) };
		}
	}
	return surfaces;
}

float compute_exposure(const SceneSnapshot &p_scene) {
	Bounds bounds;
	for (const InstanceSnapshot &instance : p_scene.instances) {
		bounds.add(instance.bounds_world);
	}
	float brightest = 0;
	if (!bounds.is_empty()) {
		const glm::dvec3 centre = 0.5 * (bounds.minimum + bounds.maximum);
		for (const LightSnapshot &light : p_scene.lights) {
			brightest = std::max(brightest, compute_light_illuminance(light, centre));
		}
	}
	return brightest > 0 && std::isfinite(brightest) ? WHITE_SHOWN * 3.14159265f / brightest : 1.0f;
}

LightView make_camera_view(const CameraSnapshot &p_camera, glm::uvec2 p_size_px) {
	const double tangent = std::tan(0.5 * p_camera.vertical_fov_rad);
	const double aspect = double(p_size_px.x) / p_size_px.y;
	LightView view;
	const glm::dmat3 &axes = p_camera.world_from_camera;
	const glm::dmat3 rotation = glm::transpose(glm::dmat3(axes[0], -axes[1], -axes[2]));
	view.view_from_world = glm::dmat4(rotation);
	view.view_from_world[3] = glm::dvec4(-(rotation * p_camera.position_world), 1.0);
	view.half_extent = glm::vec2(tangent * aspect, tangent);
	view.near_m = p_camera.near_m;
	view.size_px = p_size_px;
	return view;
}

shader::FrameConstants compute_frame_constants(const SceneSnapshot &p_scene, glm::uvec2 p_size_px) {
	const CameraSnapshot &camera = p_scene.camera;
	const LightView view = make_camera_view(camera, p_size_px);
	shader::FrameConstants frame = {};
	frame.clip_from_camera_relative = glm::mat4(view.compute_clip_from_view() *
			glm::dmat4(glm::dmat3(view.view_from_world))); // the camera is the origin
	const glm::dmat3 &axes = camera.world_from_camera;
	frame.right_tangent = glm::vec4(glm::vec3(axes[0]) * view.half_extent.x, 0.0f);
	frame.up_tangent = glm::vec4(glm::vec3(axes[1]) * view.half_extent.y, 0.0f);
	frame.forward = glm::vec4(glm::vec3(-axes[2]), 0.0f);
	frame.size_px = p_size_px;
	frame.near_m = camera.near_m;
	frame.scene_size_m = static_cast<float>(p_scene.scene_size_m);
	const float exposure = compute_exposure(p_scene);
	frame.ambient = glm::vec4(glm::vec3(AMBIENT_SHOWN / exposure), exposure);
	return frame;
}

GBuffer add_gbuffer_pass(RenderGraph &r_graph, RenderingDevice &p_device, MeshStore &p_meshes,
		const SceneSnapshot &p_scene, glm::uvec2 p_size_px, RGBuffer p_frame,
		uint32_t &r_drawn_count) {
	if (!p_device.get_features().geometry_shader) {
		fail("Device \"", p_device.get_info().name, "\" cannot read a primitive's index in the ",
				"fragment stage (feature geometryShader). Choose another one with --device; ",
				"`gnomon info` lists them.");
	}
	const auto create = [&](const char *p_name, Format p_format) {
		const TextureUsage target = p_format == Format::D32_SFLOAT ? TextureUsage::DEPTH_ATTACHMENT
																   : TextureUsage::COLOR_ATTACHMENT;
		return r_graph.create_texture({ p_name, p_format, p_size_px, 1,
				target | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
	};
	GBuffer gbuffer;
	gbuffer.depth = create("camera depth", Format::D32_SFLOAT);
	gbuffer.base_color = create("base colour", Format::RGBA8_SRGB);
	gbuffer.geometric_normal = create("geometric normal", Format::R32_UINT);
	gbuffer.shading_normal = create("shading normal", Format::R32_UINT);
	gbuffer.material = create("material", Format::RGBA16_SFLOAT);
	gbuffer.emissive = create("emissive", Format::RGBA16_SFLOAT);

	RasterPipelineDesc desc;
	desc.name = "G-buffer";
	desc.vertex_shader = "renderer/gbuffer.vert";
	desc.fragment_shader = "renderer/gbuffer.frag";
	desc.attributes = get_position_normal_attributes();
	desc.vertex_strides_bytes = { sizeof(glm::vec3), sizeof(glm::vec3) };
	desc.color_formats = { Format::RGBA8_SRGB, Format::R32_UINT, Format::R32_UINT,
		Format::RGBA16_SFLOAT, Format::RGBA16_SFLOAT };
	desc.depth_compare = CompareOp::GREATER;
	const PipelineRID pipeline = p_device.get_raster_pipeline(desc);

	struct Draw {
		const GpuMesh *mesh;
		shader::InstancePush push;
		bool is_double_sided;
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
		draws.push_back({ &p_meshes.get(instance.mesh), push, material.is_double_sided });
	}
	r_drawn_count = static_cast<uint32_t>(draws.size());
	r_graph.add_pass("G-buffer")
			.reads(p_frame, Access::UNIFORM_READ)
			.color(gbuffer.base_color)
			.color(gbuffer.geometric_normal)
			.color(gbuffer.shading_normal)
			.color(gbuffer.material)
			.color(gbuffer.emissive)
			.depth(gbuffer.depth, LoadOp::CLEAR, 0.0f)
			.execute([draws = std::move(draws), pipeline, p_frame](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.bind_pipeline(pipeline);
				for (const Draw &draw : draws) {
					const BufferRID vertices[] = { draw.mesh->positions.get(),
						draw.mesh->normals.get() };
					commands.bind_resources({
							{ GBUFFER_BINDING_FRAME, p_context.get(p_frame) },
							{ GBUFFER_BINDING_POSITIONS, draw.mesh->positions.get() },
							{ GBUFFER_BINDING_INDICES, draw.mesh->indices.get() },
					});
					commands.push_constants(draw.push);
					commands.set_cull_mode(draw.is_double_sided ? CullMode::NONE : CullMode::BACK);
					commands.set_winding(draw.push.is_mirrored ? CommandList::Winding::MIRRORED
															   : CommandList::Winding::NORMAL);
					commands.bind_vertex_buffers(vertices);
					commands.bind_index_buffer(draw.mesh->indices.get());
					commands.draw_indexed(draw.mesh->index_count);
				}
			});
	return gbuffer;
}

} // namespace gnomon
