#pragma once

#include "modules/mesh_tools/topology.h"
#include "modules/rendering_device/rendering_device.h"

#include "shared/topology_shared.h"

#include <memory>
#include <vector>

namespace gnomon {

/// The buffers of a mesh's topology that a technique reads on the GPU; bits, combined with |.
enum class TopologyBuffer : uint32_t {
	NONE = 0,
	POSITIONS = 1,
	NORMALS = 2,
	EDGES = 4,
	TRIANGLES = 8,
	FACE_FLAGS = 16,
	ADJACENCY = 32,
};
constexpr TopologyBuffer operator|(TopologyBuffer p_left, TopologyBuffer p_right) {
	return TopologyBuffer(uint32_t(p_left) | uint32_t(p_right));
}
constexpr TopologyBuffer operator&(TopologyBuffer p_left, TopologyBuffer p_right) {
	return TopologyBuffer(uint32_t(p_left) & uint32_t(p_right));
}
constexpr TopologyBuffer operator~(TopologyBuffer p_buffers) {
	return TopologyBuffer(~uint32_t(p_buffers));
}

/// A mesh's welded vertices and edges in GPU memory, as silhouette_inc.glsl reads them, in node
/// space. A buffer exists once it was requested, see MeshStore::get_topology.
struct GpuTopology {
	OwnedBuffer positions;			// VERTEX | STORAGE | COPY_SOURCE, vec4 per welded vertex, w = 1
	OwnedBuffer normals;			// VERTEX | STORAGE, vec4; zero where the face normals cancel
	SharedBuffer edges;				// STORAGE, shader::TopologyEdge, see order_edges_by_face
	SharedBuffer triangles;			// STORAGE, three welded vertices per face
	SharedBuffer face_flags;		// STORAGE, one word per face, TOPOLOGY_FACE_*
	SharedBuffer adjacency_indices; // INDEX, six per face, see MeshTopology
	/// Hash of the pose that positions and normals have; 0: at rest, or to be deformed again.
	uint64_t pose_hash = 0;
	uint32_t edge_count = 0;
	uint32_t adjacency_index_count = 0;
	std::shared_ptr<const MeshTopology> topology;
	std::weak_ptr<const Mesh> mesh;

	/// Creates no buffers yet. A mesh of which all triangles are degenerate has no edges and never
	/// gets buffers.
	explicit GpuTopology(const std::shared_ptr<const Mesh> &p_mesh);
	/// Uploads the requested buffers that do not exist yet. New positions and normals are those at
	/// rest.
	void upload(RenderingDevice &p_device, TopologyBuffer p_buffers);
	/// Shares the buffers that a deformed mesh has in common with its mesh at rest.
	void share(const GpuTopology &p_rest);
};

/// Indices into MeshTopology::edges in the order in which the GPU holds the edges: by first face,
/// then by that face's winding. A geometry shader visits them in the same order.
std::vector<uint32_t> order_edges_by_face(const MeshTopology &p_topology);
/// The edges as the shaders read them, in the order of order_edges_by_face.
std::vector<shader::TopologyEdge> build_edge_records(const MeshTopology &p_topology);
/// Flags per face (TOPOLOGY_FACE_*): which of its edges (edge i connects its corners i and i + 1)
/// it owns, which have no other face, which are wound inconsistently, and whether the face's part
/// of the mesh is not solid (MeshPart::is_solid). An edge is owned by its face0.
std::vector<uint32_t> build_face_flags(const MeshTopology &p_topology);

} // namespace gnomon
