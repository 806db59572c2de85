// The sizes of the levels of a tree over the light's faces or edges, see CountNode.
#ifndef NODE_LEVELS_INC_GLSL
#define NODE_LEVELS_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

/// The number of nodes of a level of a tree over so many faces or edges.
uint find_node_count(uint p_item_count, uint p_level) {
	const uint shift = uint(findMSB(EDGE_COUNT_CLUSTER_SIZE)) + p_level * uint(findMSB(EDGE_COUNT_NODE_WIDTH));
	return (p_item_count + (1u << shift) - 1u) >> shift;
}

#endif
