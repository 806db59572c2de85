#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace gnomon {

/// Instead of a face index: the edge is a boundary.
constexpr uint32_t NO_FACE = 0xffffffffu;
/// Instead of a welded vertex: no triangle uses the position.
constexpr uint32_t NO_VERTEX = 0xffffffffu;

/// What a shadow algorithm may assume about the edges. Only edges decide: two parts that touch in
/// one vertex are still CLOSED, because every silhouette is still a set of closed loops.
enum class MeshClass {
	/// Every edge has two faces that run along it in opposite directions. An empty mesh is closed
	/// too.
	CLOSED,
	/// Some edges have one face; all others have two of opposite direction.
	OPEN,
	/// An edge has more than two faces, or two that run along it in the same direction
	/// (inconsistent winding). Boundary edges may be there as well.
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
	/// Both faces lie in one plane (to 1e-6 rad, in double), so that no viewpoint off that plane
	/// sees a silhouette here. Never set for a boundary, a fold, a zero-area face, or where a pose
	/// may bend the mesh.
	bool is_coplanar = false;
};

/// dot(normal, p) + offset_m = 0 in node space; above 0 in front of the face. All zero for a face
/// without area: such a face counts as back-facing from every viewpoint.
struct FacePlane {
	glm::vec3 normal = glm::vec3(0.0f);
	float offset_m = 0.0f;
};

/// A connected component of faces, as build_topology pairs the faces of an edge. Parts that share
/// an edge or duplicate each other can each be closed although the mesh is not.
struct MeshPart {
	/// Every edge has two faces that run along it in opposite directions.
	bool is_closed = true;
	uint32_t face_count = 0;
	/// Enclosed volume; negative if the part is inside out. Meaningful only if closed.
	double signed_volume_m3 = 0;

	/// Seen from outside, the part's front faces alone cover everything that it occludes.
	bool is_solid() const { return is_closed && signed_volume_m3 >= 0; }
};

/// Statistics and defects of a mesh, for the validation at import and for the frame plan.
struct TopologyCounts {
	uint32_t degenerate_triangle_count = 0; // has a welded vertex twice; not in the topology
	uint32_t zero_area_triangle_count = 0;	// three vertices on a line; retained, they close gaps
	uint32_t duplicate_triangle_count =
			0; // copies beyond the first, whatever their winding; retained
	uint32_t boundary_edge_count = 0;
	uint32_t inconsistent_edge_count = 0;
	uint32_t non_manifold_edge_count = 0; // pairs of vertices joined by more than two faces
	uint32_t zero_normal_count = 0;		  // welded vertices whose face normals cancel
	uint32_t part_count = 0;
	uint32_t closed_part_count = 0;
};

/// Edges and adjacency of a mesh. Faces and face indices refer to the retained triangles, in the
/// mesh's order; lengths are in metres of node space.
struct MeshTopology {
	std::vector<uint32_t> welded_from_position; // per mesh position; NO_VERTEX where unused
	std::vector<glm::vec3> welded_positions_node;
	std::vector<uint32_t> triangles;		// three welded vertices per face
	std::vector<uint32_t> source_triangles; // per face the index of the mesh's triangle
	std::vector<MeshEdge> edges;			// ordered by their vertices
	std::vector<FacePlane> planes;			// one per face
	/// Area-weighted sum of the face normals, unit; zero where the faces cancel: no direction to
	/// extrude along.
	std::vector<glm::vec3> normals_node; // one per welded vertex
	/// Six welded vertices per face, in the order of a geometry shader's triangles with adjacency:
	/// corners at 0, 2, 4; at 1, 3, 5 the neighbour's vertex opposite to edges 02, 24, 40. On a
	/// boundary edge the face's own opposite vertex is repeated: the neighbour is then the face
	/// itself turned over, so that every viewpoint sees a silhouette there.
	std::vector<uint32_t> adjacency_indices;
	std::vector<MeshPart> parts;		// ordered by their first face
	std::vector<uint32_t> part_indices; // one per face, into parts
	TopologyCounts counts;
	bool is_deformable = false; // planes, normals, volumes and what is flat are those at rest
	MeshClass mesh_class = MeshClass::CLOSED;
	/// Enclosed volume; negative if the mesh is inside out. Meaningful only if CLOSED.
	double signed_volume_m3 = 0;

	/// Returns the third vertex of a face, given the two others.
	uint32_t find_opposite(uint32_t p_face, uint32_t p_a, uint32_t p_b) const;
	uint32_t get_face_count() const { return static_cast<uint32_t>(planes.size()); }
	const MeshPart &get_part(uint32_t p_face) const { return parts[part_indices[p_face]]; }
	/// Whether the mesh is not CLOSED.
	bool is_double_sided() const { return mesh_class != MeshClass::CLOSED; }
	/// Whether the face's part is not closed. Its edges count for both sides, see build_silhouette.
	bool is_double_sided(uint32_t p_face) const { return !get_part(p_face).is_closed; }
};

/// Builds the topology. Vertices are welded if their positions are equal (bit for bit, but -0
/// equals 0) and, for a mesh with a rig, their joints, weights and morph targets are too. An edge
/// of more than two faces is split: first faces of opposite winding that enclose a wedge of the
/// inside are paired, then the rest by angle about the edge; an unpaired face makes its edge a
/// boundary. The sum over faces that a silhouette weight is does not depend on this choice.
/// Positions must be finite and indices valid, as make_mesh guarantees; a bad index is a
/// programming error.
MeshTopology build_topology(const Mesh &p_mesh);

/// Returns a topology that is cached as long as the mesh lives; for a mesh that poses deform, that
/// of its mesh at rest. A mesh with id 0 (not from make_mesh) is rebuilt each time. Callable from
/// any thread; each mesh is built only once.
std::shared_ptr<const MeshTopology> get_topology(const std::shared_ptr<const Mesh> &p_mesh);
/// Frees the cached topologies of meshes that were freed. Callable from any thread.
void drop_unused_topologies();
/// Returns the number of cached topologies.
size_t get_cached_topology_count();

} // namespace gnomon
