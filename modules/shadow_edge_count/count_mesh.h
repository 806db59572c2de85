#pragma once

#include "modules/mesh_tools/topology.h"
#include "modules/rendering_device/rendering_device.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon {

/// A mesh in the format that the passes that find faces and edges read. Vertices are welded.
struct CountMesh {
	/// The edges that can be silhouettes: all but those between coplanar faces. Sorted for spatial
	/// locality, so that bundles of consecutive edges are small, see CountEdgeBundle.
	std::vector<shader::CountMeshEdge> edges;
	std::vector<shader::CountMeshFace> faces;
	/// For each connected part of the mesh that this one was cut out of: centre and radius of a
	/// sphere around the part before the alpha test (connected by edges, whatever their winding).
	/// All levels of detail have the same source parts, so they switch at the same distance. One
	/// sphere of radius 0 if the mesh was not cut out.
	std::vector<glm::vec4> source_parts;

	/// Words with one bit per edge.
	uint32_t get_word_count() const {
		return (uint32_t(edges.size()) + EDGE_COUNT_EDGES_PER_WORD - 1) / EDGE_COUNT_EDGES_PER_WORD;
	}
	/// Blocks of EDGE_COUNT_WORDS_PER_BLOCK such words (not the blocks of pixels).
	uint32_t get_block_count() const {
		return (get_word_count() + EDGE_COUNT_WORDS_PER_BLOCK - 1) / EDGE_COUNT_WORDS_PER_BLOCK;
	}
};

/// Converts a mesh. Faces retain their order, edges are sorted. p_source: what the mesh was cut out
/// of, see Mesh::source.
CountMesh build_count_mesh(const MeshTopology &p_topology, const MeshSource &p_source = {});

/// A mesh in GPU memory, in addition to its welded positions (GpuTopology).
struct CountGpuMesh {
	OwnedBuffer faces;		  // shader::CountMeshFace
	OwnedBuffer edges;		  // shader::CountMeshEdge
	OwnedBuffer source_parts; // glm::vec4, see CountMesh::source_parts
	uint32_t face_count = 0;
	uint32_t edge_count = 0;
	uint32_t word_count = 0;
	uint32_t block_count = 0;
};

/// Uploads a mesh. If all its triangles are degenerate, the result has no faces and no buffers.
CountGpuMesh upload_count_mesh(
		RenderingDevice &p_device, const std::shared_ptr<const Mesh> &p_mesh);

} // namespace gnomon
