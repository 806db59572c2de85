#include "modules/renderer/mask_filter.h"

#include "modules/core/error.h"

namespace gnomon {

namespace {

std::vector<MaskFilterInfo> filters;
uint64_t revision = 0;

} // namespace

void MaskFilterRegistry::add(MaskFilterInfo p_info) {
	for (const MaskFilterInfo &info : filters) {
		GNOMON_ASSERT(info.id != p_info.id, "mask filter ", p_info.id, " is registered twice");
	}
	filters.push_back(std::move(p_info));
	++revision;
}

void MaskFilterRegistry::remove(std::string_view p_id) {
	std::erase_if(filters, [&](const MaskFilterInfo &p_info) { return p_info.id == p_id; });
	++revision;
}

const std::vector<MaskFilterInfo> &MaskFilterRegistry::get_filters() {
	return filters;
}

uint64_t MaskFilterRegistry::get_revision() {
	return revision;
}

} // namespace gnomon
