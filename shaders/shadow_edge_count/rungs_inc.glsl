// The rungs of leaves of a light with a time budget, see EDGE_COUNT_RUNG_FULL.
#ifndef RUNGS_INC_GLSL
#define RUNGS_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

const uint COST_CLASSES = uint(EDGE_COUNT_COST_CLASSES);
const uint LOWERED_CLASSES = COST_CLASSES - uint(EDGE_COUNT_FIRST_LOWERED_CLASS);
const uint LADDER_END = uint(EDGE_COUNT_RUNG_FILTERED) * LOWERED_CLASSES; // the highest position

/// The rung of leaves of a class. p_ladder: its position. At 0 all leaves are on EDGE_COUNT_RUNG_FULL; each step lowers one
/// class by one rung, the most expensive class first, and when all are lower begins again with that. p_first_rung: see
/// CountRungsPush.
uint find_rung(uint p_class, uint p_ladder, uint p_first_rung) {
	const bool is_lowered = p_class >= uint(EDGE_COUNT_FIRST_LOWERED_CLASS);
	const uint lowered_class = is_lowered ? p_class - uint(EDGE_COUNT_FIRST_LOWERED_CLASS) : 0u;
	const uint rung =
			is_lowered ? min((p_ladder + lowered_class) / LOWERED_CLASSES, uint(EDGE_COUNT_RUNG_FILTERED)) : 0u;
	return p_class == uint(EDGE_COUNT_COST_EXTREME) && rung > p_first_rung ? uint(EDGE_COUNT_RUNG_FILTERED) : rung;
}

#endif
