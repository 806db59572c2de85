#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// OpenEXR 3.1 trusts the sizes that a header states, and allocates memory for them before it
/// reads. This function checks the header first and returns a safe copy of it for OpenEXR:
/// attributes that no mask needs get an unknown type, so that they are skipped by their checked
/// length. A header that exceeds the data, contradicts itself or needs too much memory is an Error
/// whose message begins with "Mask" and p_name.
std::vector<uint8_t> make_safe_exr_header(
		std::span<const uint8_t> p_bytes, const std::string &p_name);

} // namespace gnomon
