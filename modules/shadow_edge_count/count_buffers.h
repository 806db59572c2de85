#pragma once

#include "modules/shadow_edge_count/count_casters.h"
#include "modules/shadow_edge_count/count_settings.h"

#include <string>

namespace gnomon {

/// Capacities of one light's buffers, in items.
struct CountCapacities {
	uint32_t view_count = 1;
	uint32_t texels_per_view = 0;
	uint32_t nodes_per_view = 0; // of the texels' face lists
	uint32_t face_count = 0;
	uint32_t cut_face_count = 0; // faces that may cut the light's disc
	uint32_t edge_count = 0;
	uint32_t word_count = 0; // words of EDGE_COUNT_EDGES_PER_WORD edges
	bool operator==(const CountCapacities &) const = default;
	uint32_t get_block_count() const; // blocks of EDGE_COUNT_WORDS_PER_BLOCK words
	uint32_t get_bundle_count() const;
	uint32_t get_bundle_group_count() const;
};

/// Chooses capacities for all faces and edges of the casters. The node capacity of the face lists
/// is CountCasters::max_nodes_per_view if that is small, else an estimate that suffices for
/// nearly all scenes.
CountCapacities choose_capacities(
		uint32_t p_view_count, glm::uvec2 p_map_size_px, const CountCasters &p_casters);

/// This frame's handles of one light's buffers.
struct CountFrameBuffers {
	RGBuffer planes;	// vec4 per face
	RGBuffer faces;		// CountFaceRecord
	RGBuffer words;		// one bit per edge of the casters: it may be a silhouette
	RGBuffer blocks;	// number of set bits per block of words
	RGBuffer edges;		// CountEdgeRecord
	RGBuffer bundles;	// CountEdgeBundle, then one per group of bundles
	RGBuffer heads;		// first nodes of the texels' face lists, by view
	RGBuffer nodes;		// nodes of these lists, by view
	RGBuffer cut_faces; // faces that may cut the light's disc
	RGBuffer totals;	// EDGE_COUNT_TOTAL_*
};

/// The GPU memory of one light, reused from frame to frame.
class CountBuffers {
public:
	/// Creates all buffers unless they exist with these capacities or with more nodes. Returns true
	/// if they still contain the results of an earlier frame. Throws an Error that names p_light if
	/// a buffer exceeds the device's maximum size.
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
	OwnedBuffer blocks;
	OwnedBuffer edges;
	OwnedBuffer bundles;
	OwnedBuffer heads;
	OwnedBuffer nodes;
	OwnedBuffer cut_faces;
	OwnedBuffer totals;
	CountFrameBuffers frame;
	bool is_imported = false;
};

} // namespace gnomon
