#include "modules/renderer/shadow_registry.h"

#include "modules/core/error.h"
#include "modules/renderer/light_properties.h"

#include <algorithm>
#include <map>

namespace gnomon {

namespace {

std::vector<ShadowTechniqueInfo> techniques;
std::map<std::string, PropertyList, std::less<>> light_properties;
uint64_t revision = 0;

} // namespace

void ShadowRegistry::add(ShadowTechniqueInfo p_info) {
	GNOMON_ASSERT(!find(p_info.id), "technique ", p_info.id, " is registered twice");
	PropertyList list;
	p_info.make()->get_light_properties(list);
	check_own_properties(p_info.id, list);
	light_properties[p_info.id] = std::move(list);
	techniques.push_back(std::move(p_info));
	++revision;
}

void ShadowRegistry::remove(std::string_view p_id) {
	std::erase_if(techniques, [&](const ShadowTechniqueInfo &p_info) { return p_info.id == p_id; });
	if (const auto found = light_properties.find(p_id); found != light_properties.end()) {
		light_properties.erase(found);
	}
	++revision;
}

const ShadowTechniqueInfo *ShadowRegistry::find(std::string_view p_id) {
	for (const ShadowTechniqueInfo &info : techniques) {
		if (info.id == p_id) {
			return &info;
		}
	}
	return nullptr;
}

const ShadowTechniqueInfo &ShadowRegistry::get(std::string_view p_id) {
	if (const ShadowTechniqueInfo *info = find(p_id)) {
		return *info;
	}
	std::string ids;
	for (const ShadowTechniqueInfo &info : techniques) {
		ids += (ids.empty() ? "" : ", ") + info.id;
	}
	fail("Shadow technique \"", p_id,
			"\" does not exist. Choose one of: ", ids.empty() ? "(none in this build)" : ids, ".");
}

const std::vector<ShadowTechniqueInfo> &ShadowRegistry::get_techniques() {
	return techniques;
}

const ShadowTechniqueInfo *ShadowRegistry::find_default() {
	const ShadowTechniqueInfo *best = nullptr;
	for (const ShadowTechniqueInfo &info : techniques) {
		if (info.default_rank > (best ? best->default_rank : 0)) {
			best = &info;
		}
	}
	return best;
}

const ShadowTechniqueInfo *ShadowRegistry::find_fallback() {
	for (const ShadowTechniqueInfo &info : techniques) {
		if (info.is_fallback) {
			return &info;
		}
	}
	return nullptr;
}

const ShadowTechniqueInfo *ShadowRegistry::find_reference() {
	for (const ShadowTechniqueInfo &info : techniques) {
		if (info.is_reference) {
			return &info;
		}
	}
	return nullptr;
}

const PropertyList &ShadowRegistry::get_light_properties(std::string_view p_id) {
	const auto found = light_properties.find(p_id);
	GNOMON_ASSERT(found != light_properties.end(), "technique ", p_id, " is not registered");
	return found->second;
}

uint64_t ShadowRegistry::get_revision() {
	return revision;
}

} // namespace gnomon
