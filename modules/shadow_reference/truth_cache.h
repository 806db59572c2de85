#pragma once

#include "modules/shadow_reference/truth_entry.h"

#include <cstdint>
#include <optional>

namespace gnomon {

/// Stores a truth in the cache folder under its key. A failure to write only warns.
void save_truth(uint64_t p_key, const Truth &p_truth);
/// The stored truth of p_pixel_count pixels; nothing when absent, damaged or of another size.
/// p_is_colored: whether it must have colours.
std::optional<Truth> load_truth(uint64_t p_key, size_t p_pixel_count, bool p_is_colored);

} // namespace gnomon
