#include "modules/shadow_edge_count/count_mesh.h"

#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/shadow_edge_count/hilbert_curve.h"
#include "modules/shadow_edge_count/source_parts.h"
#include "modules/shadows/fetched_buffers.h"

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
		mesh.faces.push_back({ corners[0], corners[1], corners[2],
				(p_topology.is_double_sided(face) ? EDGE_COUNT_DOUBLE_SIDED : 0u) | source_part });
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

CountGpuMesh upload_count_mesh(
		RenderingDevice &p_device, const std::shared_ptr<const Mesh> &p_mesh) {
	const std::shared_ptr<const MeshTopology> topology = get_topology(p_mesh);
	CountGpuMesh gpu;
	gpu.face_count = topology->get_face_count();
	if (gpu.face_count == 0) {
		return gpu;
	}
	const auto upload = [&](const char *p_what, const auto &p_values, Format p_format) {
		const auto bytes = bytes_of(std::span(p_values));
		BufferDesc desc = make_fetched_buffer_desc(
				p_device, text(p_mesh->name, " ", p_what), bytes.size(), p_format);
		desc.usage = desc.usage | BufferUsage::COPY_TARGET;
		return OwnedBuffer(p_device, p_device.create_buffer_with_data(desc, bytes));
	};
	const CountMesh mesh = build_count_mesh(*topology, p_mesh->source);
	gpu.edge_count = static_cast<uint32_t>(mesh.edges.size());
	gpu.word_count = mesh.get_word_count();
	gpu.block_count = mesh.get_block_count();
	gpu.faces = upload("counted faces", mesh.faces, Format::RGBA32_UINT);
	gpu.source_parts = upload("source parts", mesh.source_parts, Format::RGBA32_SFLOAT);
	if (gpu.edge_count > 0) {
		gpu.edges = upload("counted edges", mesh.edges, Format::RGBA32_UINT);
	}
	return gpu;
}

} // namespace gnomon
