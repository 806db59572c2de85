#include "modules/renderer/mesh_store.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

#include "shared/frame_shared.h"

namespace gnomon {

const GpuMesh &MeshStore::get(const std::shared_ptr<const Mesh> &p_mesh) {
	const auto found = meshes.find(p_mesh->id);
	if (found != meshes.end()) {
		return found->second;
	}
	GNOMON_ASSERT(!p_mesh->indices.empty(), "mesh ", p_mesh->name, " has no triangles");
	GpuMesh mesh;
	const auto upload = [&](const char *p_what, BufferUsage p_usage, auto p_values) {
		const std::span<const uint8_t> bytes = bytes_of(p_values);
		BufferDesc desc{ text(p_mesh->name, " ", p_what), bytes.size(),
			p_usage | BufferUsage::COPY_TARGET };
		return OwnedBuffer(device, device.create_buffer_with_data(desc, bytes));
	};
	mesh.positions = upload("positions", BufferUsage::VERTEX | BufferUsage::STORAGE,
			std::span<const glm::vec3>(p_mesh->positions_node));
	mesh.normals = upload(
			"normals", BufferUsage::VERTEX, std::span<const glm::vec3>(p_mesh->normals_node));
	mesh.indices = upload("indices", BufferUsage::INDEX | BufferUsage::STORAGE,
			std::span<const uint32_t>(p_mesh->indices));
	mesh.index_count = static_cast<uint32_t>(p_mesh->indices.size());
	mesh.mesh = p_mesh;
	return meshes.emplace(p_mesh->id, std::move(mesh)).first->second;
}

void MeshStore::collect_garbage() {
	std::erase_if(meshes, [](const auto &p_entry) { return p_entry.second.mesh.expired(); });
}

std::vector<VertexAttribute> get_position_attributes() {
	return { { 0, 0, Format::R32_SFLOAT, 3, 0 } };
}

std::vector<VertexAttribute> get_position_normal_attributes() {
	return { { 0, 0, Format::R32_SFLOAT, 3, 0 }, { 1, 1, Format::R32_SFLOAT, 3, 0 } };
}

void add_depth_pass(RenderGraph &r_graph, const std::string &p_name,
		const ShadowTechnique::Inputs &p_inputs, const LightView &p_view,
		const CasterList &p_casters, RGTexture p_target, uint32_t p_layer) {
	RasterPipelineDesc desc;
	desc.name = "light view depth";
	desc.vertex_shader = "renderer/depth.vert";
	desc.attributes = get_position_attributes();
	desc.vertex_strides_bytes = { sizeof(glm::vec3) };
	desc.depth_compare = CompareOp::GREATER;
	desc.clamps_depth = p_inputs.device.get_features().depth_clamp;
	const PipelineRID pipeline = p_inputs.device.get_raster_pipeline(desc);

	struct Draw {
		const GpuMesh *mesh;
		shader::DepthPush push;
	};
	std::vector<Draw> draws;
	for (uint32_t index : p_casters.instances) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		draws.push_back({ &p_inputs.meshes.get(instance.mesh),
				{ p_view.compute_clip_from_node(instance.world_from_node) } });
	}
	r_graph.add_pass(p_name)
			.depth(p_target, LoadOp::CLEAR, 0.0f, p_layer)
			.execute([draws = std::move(draws), pipeline](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.bind_pipeline(pipeline);
				for (const Draw &draw : draws) {
					const BufferRID positions[] = { draw.mesh->positions.get() };
					commands.push_constants(draw.push);
					commands.bind_vertex_buffers(positions);
					commands.bind_index_buffer(draw.mesh->indices.get());
					commands.draw_indexed(draw.mesh->index_count);
				}
			});
}

} // namespace gnomon
