#pragma once

#include "modules/shadow_edge_count/count_casters.h"
#include "modules/shadow_edge_count/count_settings.h"

#include <string>
#include <vector>

namespace gnomon {

/// How the buffers of one light are divided.
struct CountCapacities {
	uint32_t view_count = 1;
	uint32_t texels_per_view = 0;
	uint32_t records_per_view = 0;
	uint32_t fragments_per_view = 0;
	bool operator==(const CountCapacities &) const = default;
	uint32_t get_bundles_per_view() const;
};

/// Enough for nearly all scenes; see CountBuffers::prepare for the rest. p_edge_count: of the view
/// that has the most; p_fragment_bound: likewise, see CountCasters; p_layer_count: see
/// CountSettings.
CountCapacities choose_capacities(uint32_t p_view_count, glm::uvec2 p_map_size_px,
		uint32_t p_edge_count, uint64_t p_fragment_bound, uint32_t p_layer_count);

/// Buffers of one light that all its views share, as handles of this frame.
struct CountFrameBuffers {
	RGBuffer records;	// CountEdgeRecord
	RGBuffer bundles;	// CountEdgeBundle
	RGBuffer texels;	// of the layer map
	RGBuffer fragments; // likewise
	RGBuffer totals;	// EDGE_COUNT_TOTAL_*
};

/// Of one view, from which its records are made.
struct CountViewBuffers {
	RGBuffer planes;
	RGBuffer words;
	RGBuffer blocks;
};

/// The GPU memory of one light, kept from frame to frame.
class CountBuffers {
public:
	/// Makes what is missing. What a GPU pass found too small in an earlier frame is made larger.
	/// Returns false when nothing of earlier frames is in the shared buffers.
	bool prepare(
			RenderingDevice &p_device, const std::string &p_light, CountCapacities p_capacities);
	/// Makes a view's own buffers where there are none, or others are needed. Returns false when
	/// nothing of earlier frames is in them.
	bool prepare_view(
			RenderingDevice &p_device, uint32_t p_view_index, const CountCasters &p_casters);
	void reset();

	/// This frame's handles, imported when first asked for.
	const CountFrameBuffers &import(RenderGraph &r_graph);
	CountViewBuffers import_view(RenderGraph &r_graph, uint32_t p_view_index) const;
	void forget_frame() { is_imported = false; }
	const CountCapacities &get_capacities() const { return capacities; }
	/// Copies the totals to where prepare reads them.
	void add_readback(RenderGraph &r_graph);

private:
	struct ViewBuffers {
		OwnedBuffer planes;
		OwnedBuffer words;
		OwnedBuffer blocks;
		glm::uvec3 counts = glm::uvec3(0);
	};

	/// Raises capacities to what the totals of an earlier frame need.
	void grow(RenderingDevice &p_device, CountCapacities &r_capacities) const;

	CountCapacities capacities;
	std::string light;
	OwnedBuffer records;
	OwnedBuffer bundles;
	OwnedBuffer texels;
	OwnedBuffer fragments;
	OwnedBuffer totals;
	OwnedBuffer totals_readback;
	std::vector<ViewBuffers> views;
	CountFrameBuffers frame;
	bool is_imported = false;
};

} // namespace gnomon
