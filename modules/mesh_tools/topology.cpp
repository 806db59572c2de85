#include "modules/mesh_tools/topology.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/mesh_tools/edge_pairing.h"
#include "modules/mesh_tools/flat_regions.h"
#include "modules/mesh_tools/mesh_parts.h"
#include "modules/scene/mesh_rig.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <unordered_map>

namespace gnomon {

namespace {

constexpr uint32_t NO_HALF_EDGE = 0xffffffffu;
/// Triangles with a smaller sine between two sides have no area. It exceeds the rounding error of
/// the cross product in double, and is below that of any real sliver.
constexpr double ZERO_AREA_SINE = 8 * DBL_EPSILON;
/// A sum of normals that is shorter than this, relative to the sum of their lengths, is mostly
/// rounding error and has no useful direction.
constexpr double ZERO_NORMAL_RATIO = 1e-6;

/// Gives access to the half edges of all faces. Half edge h runs along face h / 3 from its corner
/// h % 3 to the next corner.
struct HalfEdges {
	const std::vector<uint32_t> &triangles;

	uint32_t get_start(uint32_t p_half) const { return triangles[p_half]; }
	uint32_t get_end(uint32_t p_half) const {
		return triangles[p_half % 3 == 2 ? p_half - 2 : p_half + 1];
	}
	uint32_t get_opposite(uint32_t p_half) const {
		return triangles[p_half % 3 == 0 ? p_half + 2 : p_half - 1];
	}
};

struct SortedHalfEdge {
	uint32_t high_vertex;
	uint32_t half;
	bool operator<(const SortedHalfEdge &p_other) const {
		return high_vertex != p_other.high_vertex ? high_vertex < p_other.high_vertex
												  : half < p_other.half;
	}
};

void weld(const Mesh &p_mesh, MeshTopology &r_topology) {
	const size_t position_count = p_mesh.positions_node.size();
	for (const uint32_t index : p_mesh.indices) {
		GNOMON_ASSERT(index < position_count, "mesh ", p_mesh.name, ": index ", index, " of ",
				position_count);
	}
	r_topology.welded_from_position.assign(position_count, NO_VERTEX);
	// Vertices are compared by the bits of their position, so that NaN equals itself, and by the
	// hash of their joints, weights and morph targets.
	using Bits = std::array<uint32_t, 5>;
	const MeshRig *rig = p_mesh.attributes.rig.get();
	const auto hash = [](const Bits &p_bits) { return compute_value_hash(p_bits, /*p_seed=*/1); };
	std::unordered_map<Bits, uint32_t, decltype(hash)> vertices(position_count, hash);
	for (const uint32_t index : p_mesh.indices) {
		uint32_t &welded = r_topology.welded_from_position[index];
		if (welded != NO_VERTEX) {
			continue;
		}
		const glm::vec3 position = p_mesh.positions_node[index] + 0.0f; // -0 becomes 0
		const uint32_t next = static_cast<uint32_t>(r_topology.welded_positions_node.size());
		const auto bits = std::bit_cast<std::array<uint32_t, 3>>(position);
		const uint64_t motion = rig ? rig->compute_vertex_hash(index) : 0;
		const auto [vertex, is_new] = vertices.emplace(
				Bits{ bits[0], bits[1], bits[2], uint32_t(motion), uint32_t(motion >> 32) }, next);
		welded = vertex->second;
		if (is_new) {
			r_topology.welded_positions_node.push_back(position);
		}
	}
}

void collect_triangles(const Mesh &p_mesh, MeshTopology &r_topology) {
	r_topology.triangles.reserve(p_mesh.indices.size());
	r_topology.source_triangles.reserve(p_mesh.indices.size() / 3);
	for (uint32_t i = 0; i + 2 < p_mesh.indices.size(); i += 3) {
		const uint32_t a = r_topology.welded_from_position[p_mesh.indices[i]];
		const uint32_t b = r_topology.welded_from_position[p_mesh.indices[i + 1]];
		const uint32_t c = r_topology.welded_from_position[p_mesh.indices[i + 2]];
		if (a == b || b == c || c == a) {
			++r_topology.counts.degenerate_triangle_count;
			continue;
		}
		r_topology.triangles.insert(r_topology.triangles.end(), { a, b, c });
		r_topology.source_triangles.push_back(i / 3);
	}
}

/// Returns the cross product of two sides of a triangle; zero if it is only rounding error.
glm::dvec3 compute_cross(const glm::dvec3 &p_0, const glm::dvec3 &p_1, const glm::dvec3 &p_2) {
	const glm::dvec3 cross = glm::cross(p_1 - p_0, p_2 - p_0);
	const bool has_area =
			glm::length(cross) > ZERO_AREA_SINE * glm::length(p_1 - p_0) * glm::length(p_2 - p_0);
	return has_area ? cross : glm::dvec3(0.0);
}

/// Like compute_cross above, for a triangle of a mesh.
glm::dvec3 compute_cross(const Mesh &p_mesh, uint32_t p_triangle) {
	const uint32_t *corner = &p_mesh.indices[3 * size_t(p_triangle)];
	return compute_cross(p_mesh.positions_node[corner[0]], p_mesh.positions_node[corner[1]],
			p_mesh.positions_node[corner[2]]);
}

/// Computes planes, vertex normals and volume. Returns the unit face normals in double; zero for a
/// face without area.
std::vector<glm::dvec3> compute_normals(const Mesh &p_mesh, MeshTopology &r_topology) {
	const size_t face_count = r_topology.source_triangles.size();
	const size_t vertex_count = r_topology.welded_positions_node.size();
	std::vector<glm::dvec3> unit_normals(face_count, glm::dvec3(0.0));
	std::vector<glm::dvec3> sums(vertex_count, glm::dvec3(0.0));
	std::vector<double> areas(vertex_count, 0.0);
	std::vector<bool> is_used(vertex_count, false); // by a face, not only by a degenerate triangle
	r_topology.planes.resize(face_count);
	// Null unless the mesh was cut out of another one, which still exists (MeshSource).
	const std::shared_ptr<const Mesh> source = p_mesh.source.mesh.lock();
	// Relative to a point of the mesh: far from the origin, the volume's terms would lose precision
	// by cancellation.
	const glm::dvec3 reference_point =
			vertex_count > 0 ? glm::dvec3(r_topology.welded_positions_node[0]) : glm::dvec3(0.0);
	for (size_t face = 0; face < face_count; ++face) {
		const uint32_t *corner = &r_topology.triangles[3 * face];
		is_used[corner[0]] = is_used[corner[1]] = is_used[corner[2]] = true;
		const glm::dvec3 p0 = r_topology.welded_positions_node[corner[0]];
		const glm::dvec3 p1 = r_topology.welded_positions_node[corner[1]];
		const glm::dvec3 p2 = r_topology.welded_positions_node[corner[2]];
		const glm::dvec3 cross = compute_cross(p0, p1, p2);
		const double length = glm::length(cross);
		r_topology.signed_volume_m3 += glm::dot(p0 - reference_point, cross) / 6;
		r_topology.counts.zero_area_triangle_count += length > 0 ? 0 : 1;
		const glm::dvec3 source_cross = source
				? compute_cross(*source, p_mesh.source.triangles[r_topology.source_triangles[face]])
				: cross;
		if (!(glm::length(source_cross) > 0)) {
			continue;
		}
		unit_normals[face] = glm::normalize(source_cross);
		FacePlane &plane = r_topology.planes[face];
		plane.normal = glm::vec3(unit_normals[face]);
		// Computed from the normal after rounding, so that the plane fits the triangle best.
		plane.offset_m =
				static_cast<float>(-glm::dot(glm::dvec3(plane.normal), (p0 + p1 + p2) / 3.0));
		for (int k = 0; k < 3; ++k) {
			sums[corner[k]] += cross;
			areas[corner[k]] += length;
		}
	}
	r_topology.normals_node.assign(vertex_count, glm::vec3(0.0f));
	for (size_t vertex = 0; vertex < vertex_count; ++vertex) {
		const double length = glm::length(sums[vertex]);
		if (length > ZERO_NORMAL_RATIO * areas[vertex]) {
			r_topology.normals_node[vertex] = glm::vec3(sums[vertex] / length);
		} else if (is_used[vertex]) {
			++r_topology.counts.zero_normal_count;
		}
	}
	return unit_normals;
}

/// Returns the half edges grouped by their lower vertex, and sorted by the higher vertex within
/// each group. r_first_of_vertex: offset of each vertex's group, and the total number at the end.
/// This counting sort with small sorts takes a fifth of the time of one large sort.
std::vector<SortedHalfEdge> sort_half_edges(
		const MeshTopology &p_topology, std::vector<uint32_t> &r_first_of_vertex) {
	const HalfEdges half_edges{ p_topology.triangles };
	const uint32_t half_count = static_cast<uint32_t>(p_topology.triangles.size());
	r_first_of_vertex.assign(p_topology.welded_positions_node.size() + 1, 0);
	for (uint32_t half = 0; half < half_count; ++half) {
		++r_first_of_vertex[std::min(half_edges.get_start(half), half_edges.get_end(half)) + 1];
	}
	for (size_t i = 1; i < r_first_of_vertex.size(); ++i) {
		r_first_of_vertex[i] += r_first_of_vertex[i - 1];
	}
	std::vector<SortedHalfEdge> sorted(half_count);
	std::vector<uint32_t> next = r_first_of_vertex;
	for (uint32_t half = 0; half < half_count; ++half) {
		const uint32_t start = half_edges.get_start(half);
		const uint32_t end = half_edges.get_end(half);
		sorted[next[std::min(start, end)]++] = { std::max(start, end), half };
	}
	for (size_t i = 0; i + 1 < r_first_of_vertex.size(); ++i) {
		std::sort(sorted.begin() + r_first_of_vertex[i], sorted.begin() + r_first_of_vertex[i + 1]);
	}
	return sorted;
}

/// Counts the duplicates among the faces of an edge. Each triangle is checked only at its edge
/// opposite to its highest vertex, so that no duplicate is counted twice.
uint32_t count_duplicates(
		const HalfEdges &p_halves, const SortedHalfEdge *p_group, uint32_t p_count) {
	if (p_count < 2) {
		return 0;
	}
	std::vector<uint32_t> opposites;
	for (uint32_t i = 0; i < p_count; ++i) {
		const uint32_t opposite = p_halves.get_opposite(p_group[i].half);
		if (opposite > p_group[i].high_vertex) {
			opposites.push_back(opposite);
		}
	}
	std::sort(opposites.begin(), opposites.end());
	const auto unique_end = std::unique(opposites.begin(), opposites.end());
	return static_cast<uint32_t>(opposites.end() - unique_end);
}

/// Builds edges from pairs of half edges; also records each half edge's partner.
class EdgeBuilder {
public:
	EdgeBuilder(const Mesh &p_mesh, MeshTopology &r_topology,
			const std::vector<glm::dvec3> &p_unit_normals) :
			mesh(p_mesh),
			topology(r_topology), unit_normals(p_unit_normals), half_edges{ r_topology.triangles },
			partners(r_topology.triangles.size(), NO_HALF_EDGE) {}

	/// Adds the edges between two vertices. The group has all of their half edges.
	void add_group(uint32_t p_low_vertex, const SortedHalfEdge *p_group, uint32_t p_count) {
		topology.counts.duplicate_triangle_count += count_duplicates(half_edges, p_group, p_count);
		if (p_count == 1) {
			add_edge(p_group[0].half, NO_HALF_EDGE);
		} else if (p_count == 2) {
			add_edge(p_group[0].half, p_group[1].half);
		} else {
			++topology.counts.non_manifold_edge_count;
			split_group(p_low_vertex, p_group, p_count);
		}
	}

	void write_adjacency() {
		topology.adjacency_indices.resize(2 * partners.size());
		for (uint32_t half = 0; half < partners.size(); ++half) {
			const uint32_t other = partners[half] == NO_HALF_EDGE ? half : partners[half];
			topology.adjacency_indices[2 * half] = half_edges.get_start(half);
			topology.adjacency_indices[2 * half + 1] = half_edges.get_opposite(other);
		}
	}

private:
	const Mesh &mesh;
	MeshTopology &topology;
	const std::vector<glm::dvec3> &unit_normals;
	HalfEdges half_edges;
	std::vector<uint32_t> partners;

	void add_edge(uint32_t p_half0, uint32_t p_half1) {
		MeshEdge edge;
		edge.a = half_edges.get_start(p_half0);
		edge.b = half_edges.get_end(p_half0);
		edge.face0 = p_half0 / 3;
		if (p_half1 == NO_HALF_EDGE) {
			++topology.counts.boundary_edge_count;
		} else {
			edge.face1 = p_half1 / 3;
			edge.is_inconsistent = half_edges.get_start(p_half1) == edge.a;
			topology.counts.inconsistent_edge_count += edge.is_inconsistent ? 1 : 0;
			edge.is_coplanar = !edge.is_inconsistent && stays_coplanar(edge) &&
					are_coplanar(unit_normals[edge.face0], unit_normals[edge.face1]);
			partners[p_half0] = p_half1;
			partners[p_half1] = p_half0;
		}
		topology.edges.push_back(edge);
	}

	/// Returns false if a pose may bend the mesh at the edge, even if it is flat at rest. Triangles
	/// cut out of the same source triangle always stay in one plane.
	bool stays_coplanar(const MeshEdge &p_edge) const {
		if (!topology.is_deformable) {
			return true;
		}
		const std::vector<uint32_t> &sources = mesh.source.triangles;
		return !sources.empty() &&
				sources[topology.source_triangles[p_edge.face0]] ==
				sources[topology.source_triangles[p_edge.face1]];
	}

	void split_group(uint32_t p_low_vertex, const SortedHalfEdge *p_group, uint32_t p_count) {
		const glm::dvec3 low = topology.welded_positions_node[p_low_vertex];
		const glm::dvec3 high = topology.welded_positions_node[p_group[0].high_vertex];
		std::vector<EdgeFace> faces(p_count);
		for (uint32_t i = 0; i < p_count; ++i) {
			const uint32_t half = p_group[i].half;
			const glm::dvec3 opposite =
					topology.welded_positions_node[half_edges.get_opposite(half)];
			faces[i].toward_face = opposite - low;
			faces[i].runs_along = half_edges.get_start(half) == p_low_vertex;
		}
		for (const FacePair &pair : pair_faces_at_edge(high - low, faces)) {
			add_edge(p_group[pair.first].half,
					pair.second == NO_FACE ? NO_HALF_EDGE : p_group[pair.second].half);
		}
	}
};

} // namespace

uint32_t MeshTopology::find_opposite_vertex(uint32_t p_face, uint32_t p_a, uint32_t p_b) const {
	const uint32_t *corners = &triangles[3 * size_t(p_face)];
	for (int corner = 0; corner < 3; ++corner) {
		if (corners[corner] != p_a && corners[corner] != p_b) {
			return corners[corner];
		}
	}
	GNOMON_ASSERT(false, "face ", p_face, " has no third vertex");
	return 0;
}

MeshTopology build_topology(const Mesh &p_mesh) {
	GNOMON_ASSERT(p_mesh.indices.size() % 3 == 0 && p_mesh.indices.size() < NO_HALF_EDGE / 4,
			"mesh ", p_mesh.name, ": ", p_mesh.indices.size(),
			" indices, must be a multiple of 3 below ", NO_HALF_EDGE / 4);
	MeshTopology topology;
	topology.is_deformable = p_mesh.is_deformable();
	weld(p_mesh, topology);
	collect_triangles(p_mesh, topology);
	const std::vector<glm::dvec3> unit_normals = compute_normals(p_mesh, topology);

	std::vector<uint32_t> first_of_vertex;
	const std::vector<SortedHalfEdge> sorted = sort_half_edges(topology, first_of_vertex);
	topology.edges.reserve(sorted.size() / 2 + 16); // enough if at most 32 edges are boundaries
	EdgeBuilder builder(p_mesh, topology, unit_normals);
	for (uint32_t vertex = 0; vertex + 1 < first_of_vertex.size(); ++vertex) {
		uint32_t begin = first_of_vertex[vertex];
		while (begin < first_of_vertex[vertex + 1]) {
			uint32_t end = begin + 1;
			while (end < first_of_vertex[vertex + 1] &&
					sorted[end].high_vertex == sorted[begin].high_vertex) {
				++end;
			}
			builder.add_group(vertex, &sorted[begin], end - begin);
			begin = end;
		}
	}
	builder.write_adjacency();
	find_flat_regions(unit_normals, topology);
	find_mesh_parts(topology);

	const TopologyCounts &counts = topology.counts;
	if (counts.non_manifold_edge_count > 0 || counts.inconsistent_edge_count > 0) {
		topology.mesh_class = MeshClass::NON_MANIFOLD;
	} else if (counts.boundary_edge_count > 0) {
		topology.mesh_class = MeshClass::OPEN;
	}
	return topology;
}

} // namespace gnomon
