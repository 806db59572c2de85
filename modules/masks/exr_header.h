#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// OpenEXR 3.1 believes what a header states about sizes, and takes memory for it before it reads.
/// This walks the header first, and returns it as OpenEXR may see it: attributes that no mask needs
/// have an unknown type, so that they are skipped by their length, which was checked. A header that
/// goes beyond the bytes, contradicts itself or wants too much memory is an Error that begins with
/// p_name's mask.
std::vector<uint8_t> make_safe_exr_header(
		std::span<const uint8_t> p_bytes, const std::string &p_name);

} // namespace gnomon
