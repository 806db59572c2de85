#pragma once

#include "shadow_edge_count/shadow_edge_count_shared.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

/// A caster's items of a pass (faces, or words of edges) among those of all casters.
struct CasterItems {
	uint32_t first = 0;
	uint32_t count = 0;
};

/// Adds a caster's items to the work groups of a pass, of FIND_GROUP_SIZE consecutive items each.
/// p_items: those after the items of all casters added before.
void add_work_items(
		uint32_t p_caster, CasterItems p_items, std::vector<shader::CountWorkGroup> &r_groups);

/// Returns the work groups that have some of the items. p_groups: of all casters. p_items: of some
/// casters, ascending.
std::vector<shader::CountWorkGroup> select_work_groups(
		std::span<const shader::CountWorkGroup> p_groups, std::span<const CasterItems> p_items);

} // namespace gnomon
