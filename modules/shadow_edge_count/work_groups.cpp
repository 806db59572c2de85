#include "modules/shadow_edge_count/work_groups.h"

namespace gnomon {

std::vector<shader::CountWorkGroup> build_work_groups(
		const CountCasters &p_casters, CasterItems p_items, bool p_is_moved_only) {
	std::vector<shader::CountWorkGroup> groups;
	bool is_needed = true; // the last group
	for (uint32_t caster_index = 0; caster_index < p_casters.casters.size(); ++caster_index) {
		const CountCaster &caster = p_casters.casters[caster_index];
		const bool is_faces = p_items == CasterItems::FACES;
		const uint32_t first = is_faces ? caster.record.first_face : caster.record.first_word;
		const uint32_t count = is_faces ? caster.face_count : caster.word_count;
		const bool is_caster_needed = !p_is_moved_only || caster.is_moved;
		const uint32_t end = first + count;
		for (uint32_t index = first / FIND_GROUP_SIZE; index * FIND_GROUP_SIZE < end && count > 0;
				++index) {
			if (groups.empty() || groups.back().index != index) {
				if (!is_needed) {
					groups.pop_back();
				}
				groups.push_back({ index, caster_index, caster_index, /*padding=*/0 });
				is_needed = false;
			}
			groups.back().last_caster = caster_index;
			is_needed = is_needed || is_caster_needed;
		}
	}
	if (!is_needed) {
		groups.pop_back();
	}
	return groups;
}

} // namespace gnomon
