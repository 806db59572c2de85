#pragma once

#include "modules/shadow_edge_count/count_casters.h"

#include <vector>

namespace gnomon {

/// The items of a light's casters that a pass processes: faces, or words of edges.
enum class CasterItems { FACES, WORDS };

/// The work groups of a pass, of FIND_GROUP_SIZE consecutive items each: all that have items, or
/// only those with items of casters that moved.
std::vector<shader::CountWorkGroup> build_work_groups(
		const CountCasters &p_casters, CasterItems p_items, bool p_is_moved_only);

} // namespace gnomon
