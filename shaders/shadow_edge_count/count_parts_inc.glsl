// Parts of a block: groups of its receivers, see EDGE_COUNT_PARTS. They are not the parts of a mesh.
#ifndef COUNT_PARTS_INC_GLSL
#define COUNT_PARTS_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

layout(constant_id = EDGE_COUNT_CONSTANT_VIEW_COUNT) const uint VIEW_COUNT = 1u;

/// Maximum number of parts of a block.
const uint PART_COUNT = uint(EDGE_COUNT_PARTS(VIEW_COUNT));

/// The view of a part. p_parts: the block's word EDGE_COUNT_RECEIVERS_PARTS.
uint find_part_view(uint p_parts, uint p_part) {
	const uint view = (p_parts & EDGE_COUNT_IS_SORTED) != 0u
			? p_parts >> EDGE_COUNT_VIEW_SHIFT & EDGE_COUNT_VIEW_MASK
			: p_part;
	return VIEW_COUNT == 1u ? 0u : view;
}

#endif
