#include "modules/shadow_edge_count/work_groups.h"

#include <algorithm>

namespace gnomon {

void add_work_items(
		uint32_t p_caster, CasterItems p_items, std::vector<shader::CountWorkGroup> &r_groups) {
	const uint32_t end = p_items.first + p_items.count;
	for (uint32_t index = p_items.first / FIND_GROUP_SIZE;
			p_items.count > 0 && index * FIND_GROUP_SIZE < end; ++index) {
		if (index == r_groups.size()) {
			r_groups.push_back({ index, p_caster, p_caster, /*padding=*/0 });
		}
		r_groups[index].last_caster = p_caster;
	}
}

std::vector<shader::CountWorkGroup> select_work_groups(
		std::span<const shader::CountWorkGroup> p_groups, std::span<const CasterItems> p_items) {
	std::vector<shader::CountWorkGroup> selected;
	uint32_t next = 0; // groups before it are selected, or have none of the items
	for (const CasterItems &items : p_items) {
		if (items.count == 0) {
			continue;
		}
		const uint32_t end = (items.first + items.count - 1) / FIND_GROUP_SIZE + 1;
		for (next = std::max(next, items.first / FIND_GROUP_SIZE); next < end; ++next) {
			selected.push_back(p_groups[next]);
		}
	}
	return selected;
}

} // namespace gnomon
