#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// Checks the header of an OpenEXR file and returns a safe copy of it for OpenEXR. OpenEXR 3.1 does
/// not check the sizes in a header before it allocates memory for them. Attributes that no mask
/// needs get an unknown type in the copy, so that OpenEXR skips them by their length, which is
/// checked here. A header that exceeds the data, contradicts itself or needs too much memory is an
/// Error whose message begins with "Mask" and p_name.
std::vector<uint8_t> make_safe_exr_header(
		std::span<const uint8_t> p_bytes, const std::string &p_name);

} // namespace gnomon
