#include "modules/shadows/mask_filter.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/shadows/light_properties.h"

#include <map>

namespace gnomon {

std::shared_ptr<const SurfaceSpread> find_surface_spread() {
	for (const MaskFilterInfo &filter : MaskFilterRegistry::get_all()) {
		if (filter.spread) {
			return filter.spread;
		}
	}
	return nullptr;
}

uint64_t compute_filter_hash() {
	uint64_t hash = 0;
	for (const MaskFilterInfo &filter : MaskFilterRegistry::get_all()) {
		hash = compute_hash(bytes_of(std::span<const char>(filter.id)), hash);
	}
	return hash;
}

} // namespace gnomon
