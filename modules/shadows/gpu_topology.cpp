#include "modules/shadows/gpu_topology.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

namespace gnomon {

namespace {

constexpr uint32_t NO_EDGE = ~0u;

} // namespace

std::vector<uint32_t> order_edges_by_face(const MeshTopology &p_topology) {
	// Each vertex of a face starts at most one edge that the face owns.
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
		record.opposite0 = p_topology.find_opposite_vertex(edge.face0, edge.a, edge.b);
		record.opposite1 = edge.face1 == NO_FACE
				? TOPOLOGY_NO_VERTEX
				: p_topology.find_opposite_vertex(edge.face1, edge.a, edge.b) |
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

GpuTopology::GpuTopology(const std::shared_ptr<const Mesh> &p_mesh) :
		topology(gnomon::get_topology(p_mesh)), mesh(p_mesh) {
	edge_count = static_cast<uint32_t>(topology->edges.size());
	adjacency_index_count = static_cast<uint32_t>(topology->adjacency_indices.size());
}

void GpuTopology::upload(RenderingDevice &p_device, TopologyBuffer p_buffers) {
	if (edge_count == 0) {
		return;
	}
	const std::shared_ptr<const Mesh> named = mesh.lock();
	const auto make = [&](TopologyBuffer p_kind, auto &r_buffer, const char *p_what,
							  BufferUsage p_usage, auto p_build) {
		if (r_buffer || (uint32_t(p_buffers) & uint32_t(p_kind)) == 0) {
			return;
		}
		const auto &values = p_build();
		const auto bytes = bytes_of(std::span(values));
		r_buffer = OwnedBuffer(p_device,
				p_device.create_buffer_with_data(
						{ .name = text(named ? named->name : "mesh", " ", p_what),
								.size_bytes = bytes.size(),
								.usage = p_usage | BufferUsage::COPY_TARGET },
						bytes));
		pose_hash = 0; // so that the deform pass also fills the new buffer
	};
	const auto widen = [](const std::vector<glm::vec3> &p_values, float p_w) {
		std::vector<glm::vec4> wide;
		for (const glm::vec3 &value : p_values) {
			wide.emplace_back(value, p_w);
		}
		return wide;
	};
	const MeshTopology &source = *topology;
	const BufferUsage vertices = BufferUsage::VERTEX | BufferUsage::STORAGE;
	make(TopologyBuffer::POSITIONS, positions, "welded positions",
			vertices | BufferUsage::COPY_SOURCE,
			[&] { return widen(source.welded_positions_node, 1.0f); });
	make(TopologyBuffer::NORMALS, normals, "welded normals", vertices,
			[&] { return widen(source.normals_node, 0.0f); });
	make(TopologyBuffer::EDGES, edges, "edges", BufferUsage::STORAGE,
			[&] { return build_edge_records(source); });
	make(TopologyBuffer::TRIANGLES, triangles, "welded triangles", BufferUsage::STORAGE,
			[&] { return source.triangles; });
	make(TopologyBuffer::FACE_FLAGS, face_flags, "face flags", BufferUsage::STORAGE,
			[&] { return build_face_flags(source); });
	make(TopologyBuffer::ADJACENCY, adjacency_indices, "adjacency", BufferUsage::INDEX,
			[&] { return source.adjacency_indices; });
}

void GpuTopology::share(const GpuTopology &p_rest) {
	edges = p_rest.edges;
	triangles = p_rest.triangles;
	face_flags = p_rest.face_flags;
	adjacency_indices = p_rest.adjacency_indices;
}

} // namespace gnomon
