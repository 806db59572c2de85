#pragma once

#include "modules/mesh_tools/topology.h"
#include "modules/rendering_device/rendering_device.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon {

/// A mesh's edges as the passes that find edges read them; vertices are welded ones.
struct CountMesh {
	/// Those that can be silhouettes: without edges between faces that continue each other. First
	/// those whose faces wind against each other along them, as they should, then the others. In
	/// either part what lies close together stands close together, see CountEdgeBundle.
	std::vector<shader::CountMeshEdge> edges;
	uint32_t inconsistent_from = 0; // the first of the others

	uint32_t get_word_count() const {
		return (uint32_t(edges.size()) + EDGE_COUNT_EDGES_PER_WORD - 1) / EDGE_COUNT_EDGES_PER_WORD;
	}
	uint32_t get_block_count() const {
		return (get_word_count() + EDGE_COUNT_WORDS_PER_BLOCK - 1) / EDGE_COUNT_WORDS_PER_BLOCK;
	}
};

CountMesh build_count_mesh(const MeshTopology &p_topology);

/// A mesh in GPU memory, for the passes that find edges and draw the layer map.
struct CountGpuMesh {
	OwnedBuffer positions; // VERTEX | STORAGE, vec4 per welded vertex, w = 1
	OwnedBuffer faces;	   // INDEX | STORAGE, three welded vertices each
	OwnedBuffer edges;	   // STORAGE, shader::CountMeshEdge
	uint32_t face_count = 0;
	uint32_t edge_count = 0;
	uint32_t word_count = 0;
	uint32_t block_count = 0;
	uint32_t inconsistent_from = 0; // see CountMesh
	bool is_double_sided = false;
};

/// A mesh whose triangles all collapse has no faces and no buffers.
CountGpuMesh upload_count_mesh(
		RenderingDevice &p_device, const std::string &p_name, const MeshTopology &p_topology);

} // namespace gnomon
