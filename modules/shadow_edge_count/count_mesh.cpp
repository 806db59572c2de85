#include "modules/shadow_edge_count/count_mesh.h"

#include "modules/core/files.h"
#include "modules/shadow_edge_count/hilbert_curve.h"
#include "modules/shadow_edge_count/source_parts.h"

#include <algorithm>
#include <utility>

namespace gnomon {

static_assert(NO_FACE == EDGE_COUNT_NO_FACE);

namespace {

constexpr uint32_t CURVE_BITS = 10; // the curve has 2^CURVE_BITS cells per axis

/// The mesh's edges, sorted by their midpoints along a Hilbert curve through a cube around the
/// mesh, so that bundles of consecutive edges are compact.
std::vector<MeshEdge> sort_edges(const MeshTopology &p_topology) {
	const std::vector<glm::vec3> &positions = p_topology.welded_positions_node;
	glm::dvec3 minimum(1e300);
	glm::dvec3 maximum(-1e300);
	for (const glm::vec3 &position : positions) {
		minimum = glm::min(minimum, glm::dvec3(position));
		maximum = glm::max(maximum, glm::dvec3(position));
	}
	const HilbertCurve curve(minimum, maximum, CURVE_BITS);
	std::vector<std::pair<uint64_t, MeshEdge>> ordered;
	ordered.reserve(p_topology.edges.size());
	for (const MeshEdge &edge : p_topology.edges) {
		const glm::dvec3 middle =
				0.5 * (glm::dvec3(positions[edge.a]) + glm::dvec3(positions[edge.b]));
		ordered.emplace_back(curve.find_position(middle), edge);
	}
	std::stable_sort(ordered.begin(), ordered.end(),
			[](const auto &p_left, const auto &p_right) { return p_left.first < p_right.first; });
	std::vector<MeshEdge> edges;
	edges.reserve(ordered.size());
	for (const auto &[key, edge] : ordered) {
		edges.push_back(edge);
	}
	return edges;
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
	mesh.faces.reserve(p_topology.get_face_count());
	for (uint32_t face = 0; face < p_topology.get_face_count(); ++face) {
		const uint32_t *corners = &p_topology.triangles[3 * size_t(face)];
		const uint32_t source_part = source ? parts.part_of_triangle.at(p_source.triangles.at(
													  p_topology.source_triangles[face]))
											: 0u;
		const uint32_t *plane = &p_topology.triangles[3 * size_t(p_topology.plane_faces[face])];
		mesh.faces.push_back({ corners[0], corners[1], corners[2],
				(p_topology.is_double_sided(face) ? EDGE_COUNT_DOUBLE_SIDED : 0u) | source_part,
				plane[0], plane[1], plane[2], /*padding=*/0 });
	}
	for (const MeshEdge &edge : sort_edges(p_topology)) {
		if (!edge.is_coplanar) {
			const uint32_t kind = (edge.is_inconsistent ? EDGE_COUNT_INCONSISTENT : 0u) |
					(mesh.faces[edge.face0].kind & EDGE_COUNT_DOUBLE_SIDED);
			mesh.edges.push_back({ edge.a, edge.b, edge.face0 | kind, edge.face1 });
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
