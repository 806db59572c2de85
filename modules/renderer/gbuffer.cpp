#include "modules/renderer/gbuffer.h"

#include "modules/core/error.h"
#include "modules/shadows/camera_view.h"

#include "renderer/renderer_shared.h"

#include <map>
#include <tuple>

namespace gnomon {

namespace {

/// The value of GBUFFER_CONSTANT_TEXTURES.
uint32_t find_textures(const Material &p_material) {
	const std::pair<const Texture &, uint32_t> textures[] = {
		{ p_material.base_color_texture, GBUFFER_HAS_BASE_COLOR },
		{ p_material.metallic_roughness_texture, GBUFFER_HAS_METALLIC_ROUGHNESS },
		{ p_material.normal_texture, GBUFFER_HAS_NORMAL_MAP },
		{ p_material.occlusion_texture, GBUFFER_HAS_OCCLUSION },
		{ p_material.emissive_texture, GBUFFER_HAS_EMISSIVE },
	};
	uint32_t sum = 0;
	for (const auto &[texture, value] : textures) {
		sum |= texture.image ? value : 0;
	}
	return sum;
}

/// The pipelines of a G-buffer pass, created when first needed.
class GBufferPipelines {
public:
	explicit GBufferPipelines(RenderingDevice &p_device) :
			device(p_device), has_geometric_normal(p_device.get_features().geometry_shader) {}

	/// For surfaces without textures, vertex colours and alpha cutoff.
	PipelineRID get_untextured(bool p_is_mirrored, bool p_is_double_sided) {
		PipelineRID &r_pipeline = untextured[p_is_mirrored][p_is_double_sided];
		if (!r_pipeline) {
			r_pipeline =
					device.get_raster_pipeline(make_desc(p_is_mirrored, p_is_double_sided, ""));
		}
		return r_pipeline;
	}
	PipelineRID get_textured(bool p_is_mirrored, const Material &p_material,
			const std::array<VertexStream, 4> &p_streams) {
		RasterPipelineDesc desc = make_desc(p_is_mirrored, p_material.is_double_sided, ".textured");
		desc.constants = { { GBUFFER_CONSTANT_TEXTURES, find_textures(p_material) } };
		const uint32_t component_counts[] = { 2, 2, 4, 4 }; // two uv sets, tangent, colour
		for (uint32_t stream = 0; stream < p_streams.size(); ++stream) {
			// Locations and buffers 0 and 1 are position and normal.
			desc.attributes.push_back(
					{ 2 + stream, 2 + stream, Format::R32_SFLOAT, component_counts[stream], 0 });
			desc.vertex_strides_bytes.push_back(p_streams[stream].is_constant
							? 0
							: component_counts[stream] * uint32_t(sizeof(float)));
		}
		return device.get_raster_pipeline(desc);
	}

private:
	/// p_variant: ".textured", or "" for the variant without textures, of both shaders.
	RasterPipelineDesc make_desc(
			bool p_is_mirrored, bool p_is_double_sided, const std::string &p_variant) const {
		RasterPipelineDesc desc;
		desc.name = "G-buffer";
		desc.vertex_shader = "renderer/gbuffer" + p_variant + ".vert";
		desc.fragment_shader =
				(has_geometric_normal ? "renderer/gbuffer" : "renderer/gbuffer_without_faces") +
				p_variant + ".frag";
		desc.attributes = get_position_normal_attributes();
		desc.vertex_strides_bytes = { sizeof(glm::vec3), sizeof(glm::vec3) };
		// Base colour, shading normal, material, emissive, geometric normal; as in gbuffer.frag.
		desc.color_formats = { Format::RGBA8_SRGB, Format::R32_UINT, Format::RGBA16_SFLOAT,
			Format::RGBA16_SFLOAT };
		if (has_geometric_normal) {
			desc.color_formats.push_back(Format::R32_UINT);
		}
		desc.depth_compare = CompareOp::GREATER;
		desc.winding = p_is_mirrored ? Winding::MIRRORED : Winding::NORMAL;
		desc.cull_mode = p_is_double_sided ? CullMode::NONE : CullMode::BACK;
		return desc;
	}

	RenderingDevice &device;
	bool has_geometric_normal;
	PipelineRID untextured[2][2]; // mirrored, double-sided
};

shader::GBufferInstance make_instance_data(
		const SceneSnapshot &p_scene, const InstanceSnapshot &p_instance) {
	const Material &material = *p_instance.material;
	shader::GBufferInstance data = {};
	data.camera_relative_from_node = p_scene.get_camera_relative_from_node(p_instance);
	// A negative value selects Phong's model, see brdf_inc.glsl.
	const float roughness = material.shading_model == ShadingModel::PHONG
			? -1.0f - material.roughness
			: material.roughness;
	data.base_color_roughness = glm::vec4(material.base_color, roughness);
	data.emissive_metallic = glm::vec4(material.emissive, material.metallic);
	data.scatter = material.scatter;
	data.scatter_distance_m = material.scatter_distance_m;
	data.is_mirrored = p_instance.is_mirrored() ? 1u : 0u;
	return data;
}

/// Mesh, material with textures, is mirrored, is double-sided.
using GroupKey = std::tuple<const Mesh *, const Material *, bool, bool>;

GroupKey make_group_key(const InstanceSnapshot &p_instance) {
	const Material *material = p_instance.material.get();
	return { p_instance.mesh.get(),
		needs_gpu_material(*p_instance.mesh, *material) ? material : nullptr,
		p_instance.is_mirrored(), material->is_double_sided };
}

struct GBufferDraw {
	const GpuMesh *mesh;
	PipelineRID pipeline;
	const GpuMaterial *material = nullptr; // null: GBufferInstance describes all of it
	std::array<VertexStream, 4> streams;
	uint32_t first_instance = 0;
	uint32_t instance_count = 0;
};

void record_draw(PassContext &p_context, const GBufferDraw &p_draw, RGBuffer p_frame,
		RGBuffer p_instances, bool p_has_geometric_normal) {
	CommandList &commands = p_context.commands;
	std::vector<BufferRID> vertices = { p_draw.mesh->positions.get(), p_draw.mesh->normals.get() };
	std::vector<Binding> bindings = { { GBUFFER_BINDING_FRAME, p_context.get(p_frame) },
		{ GBUFFER_BINDING_INSTANCES, p_context.get(p_instances) } };
	if (p_has_geometric_normal) { // the shader loads the corners by gl_PrimitiveID
		bindings.emplace_back(GBUFFER_BINDING_POSITIONS, p_draw.mesh->positions.get());
		bindings.emplace_back(GBUFFER_BINDING_INDICES, p_draw.mesh->indices.get());
	}
	if (p_draw.material) {
		const uint32_t texture_bindings[] = { GBUFFER_BINDING_BASE_COLOR,
			GBUFFER_BINDING_METALLIC_ROUGHNESS, GBUFFER_BINDING_NORMAL, GBUFFER_BINDING_OCCLUSION,
			GBUFFER_BINDING_EMISSIVE };
		bindings.emplace_back(GBUFFER_BINDING_MATERIAL, p_draw.material->constants.get());
		for (size_t index = 0; index < std::size(texture_bindings); ++index) {
			bindings.emplace_back(texture_bindings[index], p_draw.material->textures[index],
					p_draw.material->samplers[index]);
		}
		for (const VertexStream &stream : p_draw.streams) {
			vertices.push_back(stream.buffer);
		}
	}
	commands.bind_pipeline(p_draw.pipeline);
	commands.bind_resources(bindings);
	commands.bind_vertex_buffers(vertices);
	commands.bind_index_buffer(p_draw.mesh->indices.get());
	commands.draw_instances(p_draw.mesh->index_count, p_draw.instance_count, p_draw.first_instance);
}

} // namespace

void GBufferInstances::collect(const SceneSnapshot &p_scene,
		std::span<const VisibleReceiver> p_visible, const LightView &p_camera_view) {
	// Indices of instances, by group.
	std::map<GroupKey, std::vector<uint32_t>> members;
	std::vector<const std::vector<uint32_t> *> of_groups;
	groups.clear();
	for (const VisibleReceiver &item : p_visible) {
		const InstanceSnapshot &instance = p_scene.instances[item.instance_index];
		if (!p_camera_view.may_see(instance)) {
			continue;
		}
		const auto [entry, is_new] = members.try_emplace(make_group_key(instance));
		if (is_new) {
			groups.push_back({ item.instance_index });
			of_groups.push_back(&entry->second);
		}
		entry->second.push_back(item.instance_index);
	}
	instances.clear();
	places.assign(p_scene.instances.size(), NOT_DRAWN);
	for (size_t index = 0; index < of_groups.size(); ++index) {
		groups[index].first = static_cast<uint32_t>(instances.size());
		groups[index].count = static_cast<uint32_t>(of_groups[index]->size());
		for (const uint32_t member : *of_groups[index]) {
			places[member] = static_cast<uint32_t>(instances.size());
			instances.push_back(make_instance_data(p_scene, p_scene.instances[member]));
		}
	}
}

bool GBufferInstances::move(const SceneSnapshot &p_scene,
		std::span<const VisibleReceiver> p_visible, const LightView &p_camera_view) {
	for (const uint32_t page : p_scene.instances.find_changed_pages(scene_instances)) {
		auto index = static_cast<uint32_t>(page * SharedVector<InstanceSnapshot>::PAGE_SIZE);
		for (const InstanceSnapshot &instance : p_scene.instances.get_page(page)) {
			const bool is_drawn = std::ranges::binary_search(
										  p_visible, index, {}, &VisibleReceiver::instance_index) &&
					p_camera_view.may_see(instance);
			if (is_drawn != (places[index] != NOT_DRAWN)) {
				return false;
			}
			if (is_drawn) {
				if (make_group_key(instance) != make_group_key(scene_instances[index])) {
					return false;
				}
				instances[places[index]] = make_instance_data(p_scene, instance);
			}
			++index;
		}
	}
	return true;
}

void GBufferInstances::update(const SceneSnapshot &p_scene,
		std::span<const VisibleReceiver> p_visible, glm::uvec2 p_size_px) {
	const uint64_t hash = p_scene.camera.compute_hash(0);
	const bool is_same_view = camera_hash == hash && size_px == p_size_px &&
			scene_instances.size() == p_scene.instances.size();
	const LightView camera_view = make_camera_view(p_scene.camera, p_size_px);
	if (!is_same_view || !move(p_scene, p_visible, camera_view)) {
		collect(p_scene, p_visible, camera_view);
	}
	scene_instances = p_scene.instances;
	camera_hash = hash;
	size_px = p_size_px;
}

GBuffer add_gbuffer_pass(RenderGraph &r_graph, RenderingDevice &p_device, MeshStore &r_meshes,
		MaterialStore &r_materials, const GBufferInstances &p_instances, RGBuffer p_frame) {
	const bool has_geometric_normal = p_device.get_features().geometry_shader;
	const auto create = [&](const char *p_name, Format p_format) {
		const TextureUsage target = p_format == Format::D32_SFLOAT ? TextureUsage::DEPTH_ATTACHMENT
																   : TextureUsage::COLOR_ATTACHMENT;
		return r_graph.create_texture({ .name = p_name,
				.format = p_format,
				.size_px = p_instances.size_px,
				.usage = target | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
	};
	GBuffer gbuffer;
	gbuffer.depth = create("camera depth", Format::D32_SFLOAT);
	gbuffer.base_color = create("base colour", Format::RGBA8_SRGB);
	if (has_geometric_normal) {
		gbuffer.geometric_normal = create("geometric normal", Format::R32_UINT);
	}
	gbuffer.shading_normal = create("shading normal", Format::R32_UINT);
	gbuffer.material = create("material", Format::RGBA16_SFLOAT);
	gbuffer.emissive = create("emissive", Format::RGBA16_SFLOAT);

	GBufferPipelines pipelines(p_device);
	std::vector<GBufferDraw> draws;
	for (const GBufferInstances::Group &group : p_instances.groups) {
		const InstanceSnapshot &instance = p_instances.scene_instances[group.scene_instance];
		GBufferDraw &draw = draws.emplace_back();
		draw.mesh = &r_meshes.get(instance.mesh);
		draw.first_instance = group.first;
		draw.instance_count = group.count;
		if (needs_gpu_material(*instance.mesh, *instance.material)) {
			draw.material = &r_materials.get(instance.material);
			draw.streams = r_materials.get_streams(r_meshes, instance.mesh, *instance.material);
			draw.pipeline = pipelines.get_textured(
					instance.is_mirrored(), *instance.material, draw.streams);
		} else {
			draw.pipeline = pipelines.get_untextured(
					instance.is_mirrored(), instance.material->is_double_sided);
		}
	}
	const shader::GBufferInstance nothing = {}; // a buffer is not empty
	const std::span<const shader::GBufferInstance> instances = p_instances.instances.empty()
			? std::span(&nothing, 1)
			: std::span(p_instances.instances);
	const RGBuffer instance_buffer = r_graph.upload("G-buffer instances", BufferUsage::STORAGE,
			{ reinterpret_cast<const uint8_t *>(instances.data()), instances.size_bytes() });
	PassBuilder pass = r_graph.add_pass("G-buffer");
	pass.reads(p_frame, Access::UNIFORM_READ)
			.reads(instance_buffer, Access::UNIFORM_READ)
			.color(gbuffer.base_color)
			.color(gbuffer.shading_normal)
			.color(gbuffer.material)
			.color(gbuffer.emissive);
	if (has_geometric_normal) {
		pass.color(gbuffer.geometric_normal);
	}
	pass.depth(gbuffer.depth, LoadOp::CLEAR, 0.0f)
			.execute([draws = std::move(draws), p_frame, instance_buffer, has_geometric_normal](
							 PassContext &p_context) {
				for (const GBufferDraw &draw : draws) {
					record_draw(p_context, draw, p_frame, instance_buffer, has_geometric_normal);
				}
			});
	return gbuffer;
}

} // namespace gnomon
