#include "modules/shadows/gpu_topology.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

namespace gnomon {

namespace {

constexpr uint32_t NO_EDGE = ~0u;

} // namespace

std::vector<uint32_t> order_edges_by_face(const MeshTopology &p_topology) {
	// Each corner of a face begins at most one edge that is the face's own.
	std::vector<uint32_t> edge_of_corner(p_topology.triangles.size(), NO_EDGE);
	for (uint32_t index = 0; index < p_topology.edges.size(); ++index) {
		const MeshEdge &edge = p_topology.edges[index];
		const size_t first = 3 * size_t(edge.face0);
		for (size_t corner = first; corner < first + 3; ++corner) {
			if (p_topology.triangles[corner] == edge.a) {
				edge_of_corner[corner] = index;
			}
		}
	}
	std::erase(edge_of_corner, NO_EDGE);
	GNOMON_ASSERT(edge_of_corner.size() == p_topology.edges.size(), "two edges at one corner");
	return edge_of_corner;
}

std::vector<shader::TopologyEdge> build_edge_records(const MeshTopology &p_topology) {
	std::vector<shader::TopologyEdge> records;
	records.reserve(p_topology.edges.size());
	for (uint32_t index : order_edges_by_face(p_topology)) {
		const MeshEdge &edge = p_topology.edges[index];
		shader::TopologyEdge record = {};
		record.a = edge.a;
		record.b = edge.b;
		record.opposite0 = p_topology.find_opposite(edge.face0, edge.a, edge.b);
		record.opposite1 = edge.face1 == NO_FACE
				? TOPOLOGY_NO_VERTEX
				: p_topology.find_opposite(edge.face1, edge.a, edge.b) |
						(edge.is_inconsistent ? TOPOLOGY_EDGE_INCONSISTENT : 0) |
						(p_topology.get_part(edge.face0).is_solid() ? 0 : TOPOLOGY_EDGE_NOT_SOLID);
		records.push_back(record);
	}
	return records;
}

std::vector<uint32_t> build_face_flags(const MeshTopology &p_topology) {
	std::vector<uint32_t> flags(p_topology.get_face_count(), 0);
	for (uint32_t face = 0; face < p_topology.get_face_count(); ++face) {
		flags[face] |= p_topology.get_part(face).is_solid() ? 0 : TOPOLOGY_FACE_NOT_SOLID;
	}
	for (const MeshEdge &edge : p_topology.edges) {
		const uint32_t *corners = &p_topology.triangles[3 * size_t(edge.face0)];
		for (uint32_t corner = 0; corner < 3; ++corner) {
			if (corners[corner] == edge.a) {
				flags[edge.face0] |= TOPOLOGY_FACE_OWNS_EDGE << corner;
				flags[edge.face0] |=
						edge.face1 == NO_FACE ? TOPOLOGY_FACE_HAS_BOUNDARY << corner : 0;
				flags[edge.face0] |=
						edge.is_inconsistent ? TOPOLOGY_FACE_HAS_INCONSISTENT << corner : 0;
			}
		}
	}
	return flags;
}

GpuTopology build_gpu_topology(
		RenderingDevice &p_device, const std::shared_ptr<const Mesh> &p_mesh) {
	GpuTopology gpu;
	gpu.mesh = p_mesh;
	gpu.topology = get_topology(p_mesh);
	const MeshTopology &topology = *gpu.topology;
	if (topology.edges.empty()) {
		return gpu;
	}
	const auto upload = [&](const char *p_what, BufferUsage p_usage, const auto &p_values) {
		const BufferDesc desc{ text(p_mesh->name, " ", p_what),
			bytes_of(std::span(p_values)).size(), p_usage | BufferUsage::COPY_TARGET };
		return OwnedBuffer(
				p_device, p_device.create_buffer_with_data(desc, bytes_of(std::span(p_values))));
	};
	std::vector<glm::vec4> positions;
	std::vector<glm::vec4> normals;
	for (size_t vertex = 0; vertex < topology.welded_positions_node.size(); ++vertex) {
		positions.emplace_back(topology.welded_positions_node[vertex], 1.0f);
		normals.emplace_back(topology.normals_node[vertex], 0.0f);
	}
	const BufferUsage vertex_usage = BufferUsage::VERTEX | BufferUsage::STORAGE;
	gpu.positions = upload("welded positions", vertex_usage, positions);
	gpu.normals = upload("welded normals", vertex_usage, normals);
	gpu.edges = upload("edges", BufferUsage::STORAGE, build_edge_records(topology));
	gpu.face_flags = upload("face flags", BufferUsage::STORAGE, build_face_flags(topology));
	gpu.adjacency_indices = upload(
			"adjacency", BufferUsage::INDEX | BufferUsage::STORAGE, topology.adjacency_indices);
	gpu.edge_count = static_cast<uint32_t>(topology.edges.size());
	gpu.adjacency_index_count = static_cast<uint32_t>(topology.adjacency_indices.size());
	return gpu;
}

} // namespace gnomon
