#include "modules/shadow_edge_count/count_mesh.h"

#include "modules/core/files.h"
#include "modules/shadow_edge_count/hilbert_curve.h"
#include "modules/shadow_edge_count/source_parts.h"

#include <algorithm>
#include <utility>

namespace gnomon {

static_assert(NO_FACE == EDGE_COUNT_NO_FACE);

namespace {

constexpr uint32_t MESH_CURVE_BITS = 10; // the curve has 2^MESH_CURVE_BITS cells per axis

/// Sorts things by their positions along a Hilbert curve through a cube around the mesh, so that
/// clusters of consecutive ones are compact. p_get_middle(index): where a thing is. Returns their
/// indices in order.
std::vector<uint32_t> sort_along_curve(
		const MeshTopology &p_topology, size_t p_count, const auto &p_get_middle) {
	glm::dvec3 minimum(1e300);
	glm::dvec3 maximum(-1e300);
	for (const glm::vec3 &position : p_topology.welded_positions_node) {
		minimum = glm::min(minimum, glm::dvec3(position));
		maximum = glm::max(maximum, glm::dvec3(position));
	}
	const HilbertCurve curve(minimum, maximum, MESH_CURVE_BITS);
	std::vector<std::pair<uint64_t, uint32_t>> keys;
	keys.reserve(p_count);
	for (size_t index = 0; index < p_count; ++index) {
		keys.emplace_back(curve.find_position(p_get_middle(index)), uint32_t(index));
	}
	std::sort(keys.begin(), keys.end()); // equal positions: in mesh order
	std::vector<uint32_t> order;
	order.reserve(p_count);
	for (const auto &[key, index] : keys) {
		order.push_back(index);
	}
	return order;
}

} // namespace

CountMesh build_count_mesh(const MeshTopology &p_topology, const MeshSource &p_source) {
	CountMesh mesh;
	const std::shared_ptr<const Mesh> source = p_source.mesh.lock();
	SourceParts parts;
	if (source) {
		parts = find_source_parts(*source);
	}
	mesh.source_parts = source ? parts.spheres : std::vector(1, glm::vec4(0.0f));
	const auto get_position = [&](uint32_t p_vertex) {
		return glm::dvec3(p_topology.welded_positions_node[p_vertex]);
	};
	const auto get_corners = [&](size_t p_face) { return &p_topology.triangles[3 * p_face]; };
	const uint32_t face_count = p_topology.get_face_count();
	const std::vector<uint32_t> face_order =
			sort_along_curve(p_topology, face_count, [&](size_t p_face) {
				const uint32_t *corners = get_corners(p_face);
				return (get_position(corners[0]) + get_position(corners[1]) +
							   get_position(corners[2])) /
						3.0;
			});
	std::vector<uint32_t> new_faces(face_count); // by index in the topology
	mesh.faces.reserve(face_count);
	for (const uint32_t face : face_order) {
		new_faces[face] = uint32_t(mesh.faces.size());
		const uint32_t *corners = get_corners(face);
		const uint32_t source_part = source ? parts.part_of_triangle.at(p_source.triangles.at(
													  p_topology.source_triangles[face]))
											: 0u;
		const uint32_t *plane = get_corners(p_topology.plane_faces[face]);
		mesh.faces.push_back({ corners[0], corners[1], corners[2],
				(p_topology.is_double_sided(face) ? EDGE_COUNT_DOUBLE_SIDED : 0u) | source_part,
				plane[0], plane[1], plane[2], /*padding=*/0 });
	}
	const std::vector<uint32_t> edge_order =
			sort_along_curve(p_topology, p_topology.edges.size(), [&](size_t p_edge) {
				const MeshEdge &edge = p_topology.edges[p_edge];
				return 0.5 * (get_position(edge.a) + get_position(edge.b));
			});
	for (const uint32_t index : edge_order) {
		const MeshEdge &edge = p_topology.edges[index];
		if (!edge.is_coplanar) {
			const uint32_t kind = (edge.is_inconsistent ? EDGE_COUNT_INCONSISTENT : 0u) |
					(p_topology.is_double_sided(edge.face0) ? EDGE_COUNT_DOUBLE_SIDED : 0u);
			mesh.edges.push_back({ edge.a, edge.b, new_faces[edge.face0] | kind,
					edge.face1 == NO_FACE ? EDGE_COUNT_NO_FACE : new_faces[edge.face1] });
		}
	}
	return mesh;
}

CountMeshPools::CountMeshPools(RenderingDevice &p_device) :
		faces(std::make_shared<ItemPool>(p_device, "faces", Format::RGBA32_UINT)),
		edges(std::make_shared<ItemPool>(p_device, "edges", Format::RGBA32_UINT)),
		points(std::make_shared<ItemPool>(p_device, "vertices", Format::RGBA32_SFLOAT)) {}

const CountGpuMesh &CountMeshPools::get(
		MeshStore &r_store, const std::shared_ptr<const Mesh> &p_mesh) {
	return r_store.get_derived<CountGpuMesh>(p_mesh, [&] {
		const std::shared_ptr<const Mesh> &rest = p_mesh->rest ? p_mesh->rest : p_mesh;
		const std::shared_ptr<const MeshTopology> topology = get_topology(rest);
		CountGpuMesh gpu;
		if (topology->get_face_count() == 0) {
			return gpu;
		}
		const CountMesh mesh = build_count_mesh(*topology, rest->source);
		gpu.faces = faces->add(bytes_of(std::span(mesh.faces)));
		gpu.edges = edges->add(bytes_of(std::span(mesh.edges)));
		gpu.vertex_count = static_cast<uint32_t>(topology->welded_positions_node.size());
		std::vector<glm::vec4> values;
		values.reserve(gpu.vertex_count + mesh.source_parts.size());
		for (const glm::vec3 &position : topology->welded_positions_node) {
			values.emplace_back(position, 1.0f);
		}
		values.insert(values.end(), mesh.source_parts.begin(), mesh.source_parts.end());
		gpu.points = points->add(bytes_of(std::span(std::as_const(values))));
		return gpu;
	});
}

std::shared_ptr<CountPosedMesh> CountMeshPools::get_posed(
		MeshStore &r_store, const std::shared_ptr<const Mesh> &p_mesh) {
	std::shared_ptr<CountPosedMesh> &entry = posed[p_mesh->id];
	if (!entry) {
		entry = std::make_shared<CountPosedMesh>();
		entry->points = points->allocate(get(r_store, p_mesh).vertex_count);
		entry->mesh = p_mesh;
	}
	if (entry->forget_count != r_store.get_forget_count()) {
		entry->forget_count = r_store.get_forget_count();
		entry->pose_hash = 0;
	}
	return entry;
}

void CountMeshPools::upload() {
	std::erase_if(posed, [](const auto &p_entry) { return p_entry.second->mesh.expired(); });
	for (const std::shared_ptr<ItemPool> &pool : { faces, edges, points }) {
		pool->upload();
	}
}

} // namespace gnomon
