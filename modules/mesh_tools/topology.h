#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace gnomon {

/// Replaces the index of the missing second face of a boundary edge.
constexpr uint32_t NO_FACE = 0xffffffffu;
/// Replaces the index of a welded vertex for a position that no triangle uses.
constexpr uint32_t NO_VERTEX = 0xffffffffu;

/// States what a shadow algorithm may assume about the edges of a mesh. Only edges matter: two
/// parts that touch at one vertex are still CLOSED, because every silhouette is still a set of
/// closed loops.
enum class MeshClass {
	/// Every edge has two faces that run along it in opposite directions. An empty mesh is CLOSED.
	CLOSED,
	/// Some edges have one face; all others have two of opposite direction.
	OPEN,
	/// An edge has more than two faces, or two that run along it in the same direction
	/// (inconsistent winding). There may be boundary edges as well.
	NON_MANIFOLD,
};

/// An edge with one or two faces. An edge with more faces is stored several times, see
/// build_topology.
struct MeshEdge {
	uint32_t a = 0; // welded vertices; a -> b as face0 winds
	uint32_t b = 0;
	uint32_t face0 = 0;
	uint32_t face1 = NO_FACE;
	/// Both faces run a -> b. Code that needs one orientation negates face1's plane for this edge.
	bool is_inconsistent = false;
	/// Both faces are in one flat region (MeshTopology::plane_faces). The edge is then no
	/// silhouette for any viewpoint, provided that both faces use the region's plane. Never set for
	/// a boundary, a fold, a zero-area face, an inconsistent edge or one at which a pose may bend
	/// the mesh.
	bool is_coplanar = false;
};

/// The plane dot(normal, p) + offset_m = 0 in node space, with a unit normal. The value is positive
/// in front of the face. All zero for a face without area, which is back-facing from every
/// viewpoint.
struct FacePlane {
	glm::vec3 normal = glm::vec3(0.0f);
	float offset_m = 0.0f;
};

/// A connected component of faces, where the two faces of a MeshEdge are connected. Parts that
/// touch along an edge or duplicate each other can each be closed although the mesh is not.
struct MeshPart {
	/// Every edge has two faces that run along it in opposite directions.
	bool is_closed = true;
	uint32_t face_count = 0;
	/// Enclosed volume; negative if the part is inside out. Meaningful only if closed.
	double signed_volume_m3 = 0;

	/// Returns whether the part is closed and not inside out. Its front faces alone then occlude
	/// the same as all of its faces, for any viewpoint outside of it.
	bool is_solid() const { return is_closed && signed_volume_m3 >= 0; }
};

/// Statistics and defects of a mesh. Some decide its MeshClass; the frame plan of penumbra_fins
/// shows zero_normal_count.
struct TopologyCounts {
	uint32_t degenerate_triangle_count = 0; // two equal welded vertices; not in the topology
	uint32_t zero_area_triangle_count = 0;	// three vertices on a line; retained to close gaps
	/// Triangles with the same three vertices as an earlier one, in any order; retained.
	uint32_t duplicate_triangle_count = 0;
	uint32_t boundary_edge_count = 0;
	uint32_t inconsistent_edge_count = 0;
	uint32_t non_manifold_edge_count = 0; // pairs of vertices joined by more than two faces
	uint32_t zero_normal_count = 0;		  // welded vertices whose face normals cancel
	uint32_t part_count = 0;
	uint32_t closed_part_count = 0;
};

/// Edges and adjacency of a mesh. The faces are the triangles of the mesh in the same order,
/// without the degenerate ones. Lengths are in metres of node space.
struct MeshTopology {
	std::vector<uint32_t> welded_from_position; // per mesh position; NO_VERTEX where unused
	std::vector<glm::vec3> welded_positions_node;
	std::vector<uint32_t> triangles;		// three welded vertices per face
	std::vector<uint32_t> source_triangles; // per face the index of the mesh's triangle
	std::vector<MeshEdge> edges;			// ordered by their vertices
	std::vector<FacePlane> planes;			// one per face
	/// Flat regions: faces that are connected by edges at which both are in one plane (within 1e-6
	/// rad, computed in double). Per face, the face whose plane its region uses: the one with the
	/// largest height above its longest side, whose plane is the most precise in float. The own
	/// plane of a sliver of the region is only rounding error after a transformation in float, so
	/// that code which computes planes in float and skips coplanar edges must use this one.
	std::vector<uint32_t> plane_faces;
	/// Normalized area-weighted sums of the face normals; zero where they cancel out, so that there
	/// is no direction for extrusion.
	std::vector<glm::vec3> normals_node; // one per welded vertex
	/// Six welded vertices per face, in the order of a geometry shader's triangles with adjacency:
	/// corners at 0, 2, 4; at 1, 3, 5 the neighbour's vertex opposite to edges 02, 24, 40. On a
	/// boundary edge the face's own opposite vertex is repeated: the neighbour is then the flipped
	/// face itself, so that the edge is a silhouette for every viewpoint.
	std::vector<uint32_t> adjacency_indices;
	std::vector<MeshPart> parts;		// ordered by their first face
	std::vector<uint32_t> part_indices; // one per face, into parts
	TopologyCounts counts;
	/// Whether poses deform the mesh. Planes, normals, volumes and is_coplanar are those at rest.
	bool is_deformable = false;
	MeshClass mesh_class = MeshClass::CLOSED;
	/// Enclosed volume; negative if the mesh is inside out. Meaningful only if CLOSED.
	double signed_volume_m3 = 0;

	/// Returns the third vertex of a face, given the two others.
	uint32_t find_opposite_vertex(uint32_t p_face, uint32_t p_a, uint32_t p_b) const;
	uint32_t get_face_count() const { return static_cast<uint32_t>(planes.size()); }
	const MeshPart &get_part(uint32_t p_face) const { return parts[part_indices[p_face]]; }
	/// Returns whether the mesh is not CLOSED.
	bool is_double_sided() const { return mesh_class != MeshClass::CLOSED; }
	/// Returns whether the face's part is not closed. It is then double-sided, see
	/// build_silhouette.
	bool is_double_sided(uint32_t p_face) const { return !get_part(p_face).is_closed; }
};

/// Builds the topology. Vertices are welded if their positions are equal (bit for bit, but -0
/// equals 0) and, for a mesh with a rig, if their joints, weights and morph targets are equal too.
/// An edge with more than two faces is split into several: faces of opposite winding that enclose a
/// wedge of the inside are paired first, then the others by their angle about the edge; an unpaired
/// face gets a boundary edge (pair_faces_at_edge). The silhouette weights of these edges have the
/// same sum for any pairing. Positions must be finite and indices valid, as make_mesh guarantees.
/// An invalid index is a programming error (GNOMON_ASSERT).
MeshTopology build_topology(const Mesh &p_mesh);

/// Returns the topology of a mesh, or of the mesh at rest for a posed mesh (Mesh::rest). It is
/// built once and cached as long as the mesh exists; for a mesh with id 0 (not from make_mesh) it
/// is rebuilt each time. Callable from any thread.
std::shared_ptr<const MeshTopology> get_topology(const std::shared_ptr<const Mesh> &p_mesh);
/// Frees the cached topologies of meshes that were freed. Callable from any thread.
void drop_unused_topologies();
/// Returns the number of cached topologies.
size_t get_cached_topology_count();

} // namespace gnomon
