#include "modules/shadows/draw_predicates.h"

#include <algorithm>

namespace gnomon {

std::optional<uint64_t> DrawPredicates::find_offset_bytes(uint32_t p_instance_index) const {
	if (!instances) {
		return std::nullopt;
	}
	const auto found = std::lower_bound(instances->begin(), instances->end(), p_instance_index);
	if (found == instances->end() || *found != p_instance_index) {
		return std::nullopt;
	}
	return first_offset_bytes + uint64_t(found - instances->begin()) * sizeof(uint32_t);
}

void DrawPredicates::add_to(PassBuilder &r_pass) const {
	if (instances) {
		r_pass.reads(words, Access::CONDITIONAL_READ);
	}
}

} // namespace gnomon
