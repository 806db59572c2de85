#include "modules/shadows/mesh_store.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/scene/cut_mesh.h"

namespace gnomon {

const GpuMesh &MeshStore::get(const std::shared_ptr<const Mesh> &p_mesh) {
	const auto found = meshes.find(p_mesh->id);
	if (found != meshes.end()) {
		return found->second;
	}
	GNOMON_ASSERT(!p_mesh->indices.empty(), "mesh ", p_mesh->name, " has no triangles");
	const SharedBuffer rest_indices = p_mesh->rest ? get(p_mesh->rest).indices : SharedBuffer();
	GpuMesh mesh;
	const auto upload = [&](const char *p_what, BufferUsage p_usage, auto p_values) {
		const std::span<const uint8_t> bytes = bytes_of(p_values);
		BufferDesc desc{ text(p_mesh->name, " ", p_what), bytes.size(),
			p_usage | BufferUsage::COPY_TARGET };
		return OwnedBuffer(device, device.create_buffer_with_data(desc, bytes));
	};
	// Deformed vertices can be read back. The second VERTEX adds nothing.
	const BufferUsage usage = BufferUsage::VERTEX | BufferUsage::STORAGE |
			(p_mesh->rest ? BufferUsage::COPY_SOURCE : BufferUsage::VERTEX);
	mesh.positions = upload("positions", usage, std::span<const glm::vec3>(p_mesh->positions_node));
	mesh.normals = upload("normals", usage, std::span<const glm::vec3>(p_mesh->normals_node));
	mesh.indices = rest_indices ? rest_indices
								: upload("indices", BufferUsage::INDEX | BufferUsage::STORAGE,
										  std::span<const uint32_t>(p_mesh->indices));
	mesh.index_count = static_cast<uint32_t>(p_mesh->indices.size());
	mesh.mesh = p_mesh;
	if (p_mesh->rest) {
		prepare_deform(p_mesh, /*p_has_topology=*/false);
	}
	return meshes.emplace(p_mesh->id, std::move(mesh)).first->second;
}

BufferRID MeshStore::get_deformed_tangents(
		const std::shared_ptr<const Mesh> &p_mesh, BufferRID p_rest) {
	get(p_mesh); // adds it to `meshes`
	GpuMesh &mesh = meshes.at(p_mesh->id);
	if (!mesh.tangents) {
		const BufferDesc &rest = device.get_desc(p_rest);
		mesh.tangents = OwnedBuffer(device,
				device.create_buffer({ text(p_mesh->name, " tangents"), rest.size_bytes,
						BufferUsage::VERTEX | BufferUsage::STORAGE }));
	}
	if (mesh.rest_tangents != p_rest) {
		mesh.rest_tangents = p_rest;
		mesh.pose_hash = 0;
	}
	return mesh.tangents.get();
}

const GpuTopology &MeshStore::get_topology(
		const std::shared_ptr<const Mesh> &p_mesh, TopologyBuffer p_buffers) {
	GpuTopology &topology = topologies.try_emplace(p_mesh->id, p_mesh).first->second;
	if (p_mesh->rest) {
		const TopologyBuffer deformed = TopologyBuffer::POSITIONS | TopologyBuffer::NORMALS;
		const bool has_normals = (p_buffers & TopologyBuffer::NORMALS) != TopologyBuffer::NONE;
		// The deform pass computes normals from deformed positions and triangles.
		const TopologyBuffer buffers = has_normals
				? p_buffers | TopologyBuffer::POSITIONS | TopologyBuffer::TRIANGLES
				: p_buffers;
		topology.share(get_topology(p_mesh->rest, buffers & ~deformed));
		topology.upload(device, buffers & deformed);
		if (topology.positions) { // the deform pass computes them from the mesh's positions
			get(p_mesh);		  // uploads those
			prepare_deform(p_mesh, /*p_has_topology=*/true);
		}
	} else {
		topology.upload(device, p_buffers);
	}
	return topology;
}

SamplerRID MeshStore::get_sampler(const ProgramTexture &p_texture) {
	OwnedSampler &sampler = samplers[{ p_texture.is_nearest, p_texture.repeats }];
	if (!sampler) {
		const Filter filter = p_texture.is_nearest ? Filter::NEAREST : Filter::LINEAR;
		const AddressMode address = p_texture.repeats ? AddressMode::REPEAT : AddressMode::CLAMP;
		sampler = OwnedSampler(device,
				device.create_sampler({ "texture of a vertex program", filter, filter,
						MipMode::NONE, address, address }));
	}
	return sampler.get();
}

void MeshStore::collect_garbage() {
	drop_unused_cut_meshes();
	const auto is_gone = [](const auto &p_entry) { return p_entry.second.mesh.expired(); };
	const size_t gone_count = std::erase_if(meshes, is_gone) + std::erase_if(topologies, is_gone) +
			std::erase_if(derived, is_gone);
	if (gone_count > 0) {
		drop_unused_topologies();
	}
}

// Attributes have three floats (VertexAttribute's default format) and a buffer each.

std::vector<VertexAttribute> get_position_attributes() {
	return { { .location = 0, .buffer_index = 0 } };
}

std::vector<VertexAttribute> get_position_normal_attributes() {
	return { { .location = 0, .buffer_index = 0 }, { .location = 1, .buffer_index = 1 } };
}

} // namespace gnomon
