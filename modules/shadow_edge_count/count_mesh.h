#pragma once

#include "modules/mesh_tools/topology.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

#include <cstdint>
#include <vector>

namespace gnomon {

/// A mesh's faces and edges as the passes that find edges read them; vertices are welded ones.
struct CountMesh {
	std::vector<glm::uvec4> faces; // three vertices each
	/// Those that can be silhouettes: without edges between faces that continue each other. First
	/// those whose faces wind against each other along them, as they should, then the others.
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

} // namespace gnomon
