#include "modules/renderer/mask_filter.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/renderer/light_properties.h"

#include <map>

namespace gnomon {

namespace {

std::vector<MaskFilterInfo> filters;
std::map<std::string, PropertyList, std::less<>> light_properties;
uint64_t revision = 0;

} // namespace

void MaskFilterRegistry::add(MaskFilterInfo p_info) {
	GNOMON_ASSERT(!find(p_info.id), "mask filter ", p_info.id, " is registered twice");
	PropertyList list;
	p_info.make()->get_light_properties(list);
	check_own_properties(p_info.id, list);
	light_properties[p_info.id] = std::move(list);
	filters.push_back(std::move(p_info));
	++revision;
}

void MaskFilterRegistry::remove(std::string_view p_id) {
	std::erase_if(filters, [&](const MaskFilterInfo &p_info) { return p_info.id == p_id; });
	if (const auto found = light_properties.find(p_id); found != light_properties.end()) {
		light_properties.erase(found);
	}
	++revision;
}

const std::vector<MaskFilterInfo> &MaskFilterRegistry::get_filters() {
	return filters;
}

const MaskFilterInfo *MaskFilterRegistry::find(std::string_view p_id) {
	for (const MaskFilterInfo &info : filters) {
		if (info.id == p_id) {
			return &info;
		}
	}
	return nullptr;
}

const PropertyList &MaskFilterRegistry::get_light_properties(std::string_view p_id) {
	const auto found = light_properties.find(p_id);
	GNOMON_ASSERT(found != light_properties.end(), "mask filter ", p_id, " is not registered");
	return found->second;
}

uint64_t MaskFilterRegistry::get_revision() {
	return revision;
}

std::shared_ptr<const SurfaceSpread> find_surface_spread() {
	for (const MaskFilterInfo &filter : filters) {
		if (filter.spread) {
			return filter.spread;
		}
	}
	return nullptr;
}

uint64_t compute_filter_hash() {
	uint64_t hash = 0;
	for (const MaskFilterInfo &filter : filters) {
		hash = compute_hash(bytes_of(std::span<const char>(filter.id)), hash);
	}
	return hash;
}

} // namespace gnomon
