#pragma once

#include "modules/mesh_tools/topology.h"
#include "modules/shadow_edge_count/item_pool.h"
#include "modules/shadows/mesh_store.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace gnomon {

/// A mesh in the format that the passes that find faces and edges read. Vertices are welded.
struct CountMesh {
	/// The edges that can be silhouettes: all but those inside a flat region. Sorted for spatial
	/// locality, so that clusters of consecutive edges are small, see CountNode.
	std::vector<shader::CountMeshEdge> edges;
	std::vector<shader::CountMeshFace> faces; // all, also sorted
	/// For each connected part of the mesh that this one was cut out of: centre and radius of a
	/// sphere around the part before the alpha test (connected by edges, whatever their winding).
	/// All LODs have the same source parts, so they switch at the same distance. One
	/// sphere of radius 0 if the mesh was not cut out.
	std::vector<glm::vec4> source_parts;
};

/// Converts a mesh. p_source: what the mesh was cut out
/// of, see Mesh::source.
CountMesh build_count_mesh(const MeshTopology &p_topology, const MeshSource &p_source = {});

/// A mesh in the pools of CountMeshPools.
struct CountGpuMesh {
	ItemPool::Range faces;	// shader::CountMeshFace
	ItemPool::Range edges;	// shader::CountMeshEdge
	ItemPool::Range points; // welded positions at rest, then CountMesh::source_parts
	uint32_t vertex_count = 0;
	uint32_t get_first_source_part() const { return points.get_first() + vertex_count; }
};

/// The welded vertices of a mesh in its current pose.
struct CountPosedMesh {
	ItemPool::Range points;
	std::weak_ptr<const Mesh> mesh;
	/// Hash of the pose that the points have, and the pool's buffer in which they have it: a light
	/// may make the pool grow while the copies of another one are not yet recorded.
	uint64_t pose_hash = 0;
	BufferRID buffer;
	uint64_t forget_count = 0; // of the MeshStore when the hash was recorded
};

/// The meshes of all casters in GPU memory, shared by all lights: a buffer each for faces, edges
/// and points, so that one dispatch reads the meshes of all casters.
class CountMeshPools {
public:
	explicit CountMeshPools(RenderingDevice &p_device);

	/// Returns the mesh's ranges, and adds it on the first call; a deformed mesh has those of its
	/// mesh at rest. If all its triangles are degenerate, its ranges are empty.
	const CountGpuMesh &get(MeshStore &r_store, const std::shared_ptr<const Mesh> &p_mesh);
	/// Returns the vertices of a deformed mesh, without content on the first call.
	std::shared_ptr<CountPosedMesh> get_posed(
			MeshStore &r_store, const std::shared_ptr<const Mesh> &p_mesh);
	/// Copies what was added to the buffers; see ItemPool::upload. Drops deformed meshes that no
	/// longer exist.
	void upload();

	const SharedBuffer &get_faces() const { return faces->get_buffer(); }
	const SharedBuffer &get_edges() const { return edges->get_buffer(); }
	const SharedBuffer &get_points() const { return points->get_buffer(); }

private:
	std::shared_ptr<ItemPool> faces;
	std::shared_ptr<ItemPool> edges;
	std::shared_ptr<ItemPool> points;
	std::map<uint64_t, std::shared_ptr<CountPosedMesh>> posed; // by Mesh::id
};

} // namespace gnomon
