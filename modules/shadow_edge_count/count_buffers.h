#pragma once

#include "modules/shadow_edge_count/count_casters.h"
#include "modules/shadow_edge_count/count_settings.h"

#include <array>
#include <string>

namespace gnomon {

/// Capacities of one light's buffers, in items.
struct CountCapacities {
	uint32_t face_count = 0;
	uint32_t cut_face_count = 0; // faces that may cut the light's disc
	uint32_t edge_count = 0;
	uint32_t word_count = 0; // words of EDGE_COUNT_EDGES_PER_WORD edges
	bool operator==(const CountCapacities &) const = default;
	uint32_t get_run_count() const; // runs of EDGE_COUNT_WORDS_PER_RUN words
};

/// Capacities for all faces and edges of the casters.
CountCapacities choose_capacities(const CountCasters &p_casters);

/// The trees over a light's faces and edges (CountNode), which share a buffer.
struct CountTrees {
	/// Index of the first node of each level.
	std::array<uint32_t, EDGE_COUNT_MAX_LEVELS> face_levels = {};
	std::array<uint32_t, EDGE_COUNT_MAX_LEVELS> edge_levels = {};
	uint32_t node_count = 0; // of both trees
};
CountTrees lay_out_trees(const CountCapacities &p_capacities);
/// Number of nodes of a level of a tree over so many faces or edges.
uint32_t count_nodes(uint32_t p_item_count, uint32_t p_level);

/// This frame's handles of one light's buffers.
struct CountFrameBuffers {
	RGBuffer planes;	// vec4 per face
	RGBuffer faces;		// CountFaceRecord
	RGBuffer words;		// one bit per edge of the casters: it may be a silhouette
	RGBuffer runs;		// number of set bits per run of words
	RGBuffer edges;		// CountEdgeRecord
	RGBuffer nodes;		// CountNode, see CountTrees
	RGBuffer cut_faces; // faces that may cut the light's disc
	RGBuffer totals;	// EDGE_COUNT_TOTAL_*
};

/// The GPU memory of one light, reused from frame to frame.
class CountBuffers {
public:
	/// Creates all buffers unless they exist with these capacities. Returns true if they still
	/// contain the results of an earlier frame. Throws an Error that names p_light if a buffer
	/// exceeds the device's maximum size.
	bool prepare(RenderingDevice &p_device, const std::string &p_light,
			const CountCapacities &p_capacities);
	/// Frees all buffers.
	void reset();

	/// This frame's handles, imported when first needed.
	const CountFrameBuffers &import(RenderGraph &r_graph);
	const CountCapacities &get_capacities() const { return capacities; }

private:
	CountCapacities capacities;
	OwnedBuffer planes;
	OwnedBuffer faces;
	OwnedBuffer words;
	OwnedBuffer runs;
	OwnedBuffer edges;
	OwnedBuffer nodes;
	OwnedBuffer cut_faces;
	OwnedBuffer totals;
	CountFrameBuffers frame;
	bool is_imported = false;
};

} // namespace gnomon
