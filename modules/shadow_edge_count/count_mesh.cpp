#include "modules/shadow_edge_count/count_mesh.h"

#include "modules/core/files.h"
#include "modules/core/text.h"

namespace gnomon {

static_assert(NO_FACE == EDGE_COUNT_NO_FACE);

CountMesh build_count_mesh(const MeshTopology &p_topology) {
	CountMesh mesh;
	const auto add_edges = [&](bool p_is_inconsistent) {
		for (const MeshEdge &edge : p_topology.edges) {
			if (edge.is_inconsistent == p_is_inconsistent && !edge.is_coplanar) {
				mesh.edges.push_back({ edge.a, edge.b, edge.face0, edge.face1 });
			}
		}
	};
	add_edges(false);
	mesh.inconsistent_from = static_cast<uint32_t>(mesh.edges.size());
	add_edges(true);
	return mesh;
}

CountGpuMesh upload_count_mesh(
		RenderingDevice &p_device, const std::string &p_name, const MeshTopology &p_topology) {
	CountGpuMesh gpu;
	gpu.face_count = p_topology.get_face_count();
	gpu.is_double_sided = p_topology.is_double_sided();
	if (gpu.face_count == 0) {
		return gpu;
	}
	const auto upload = [&](const char *p_what, BufferUsage p_usage, const auto &p_values) {
		const auto bytes = bytes_of(std::span(p_values));
		const BufferDesc desc{ text(p_name, " ", p_what), bytes.size(),
			p_usage | BufferUsage::STORAGE | BufferUsage::COPY_TARGET };
		return OwnedBuffer(p_device, p_device.create_buffer_with_data(desc, bytes));
	};
	std::vector<glm::vec4> positions;
	for (const glm::vec3 &position : p_topology.welded_positions_node) {
		positions.emplace_back(position, 1.0f);
	}
	CountMesh mesh = build_count_mesh(p_topology);
	gpu.edge_count = static_cast<uint32_t>(mesh.edges.size());
	gpu.word_count = mesh.get_word_count();
	gpu.block_count = mesh.get_block_count();
	gpu.inconsistent_from = mesh.inconsistent_from;
	gpu.positions = upload("counted positions", BufferUsage::VERTEX, positions);
	gpu.faces = upload("counted faces", BufferUsage::INDEX, p_topology.triangles);
	if (gpu.edge_count > 0) {
		gpu.edges = upload("counted edges", BufferUsage::STORAGE, mesh.edges);
	}
	return gpu;
}

} // namespace gnomon
