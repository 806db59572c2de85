#include "modules/shadow_reference/truth_cache.h"

#include "modules/core/files.h"

namespace gnomon {

namespace {

std::string get_entry_name(uint64_t p_key) {
	return "truth_" + format_hash(p_key);
}

} // namespace

void save_truth(uint64_t p_key, const Truth &p_truth) {
	save_cache_entry(get_entry_name(p_key), build_truth_entry(p_key, p_truth));
}

std::optional<Truth> load_truth(uint64_t p_key, size_t p_pixel_count, bool p_is_colored) {
	return parse_truth_entry(
			load_cache_entry(get_entry_name(p_key)), p_key, p_pixel_count, p_is_colored);
}

} // namespace gnomon
