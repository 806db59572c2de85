#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace gnomon {

/// The device whose driver wrote a pipeline cache.
struct PipelineCacheMaker {
	uint32_t vendor_id = 0;
	uint32_t device_id = 0;
	std::array<uint8_t, 16> cache_uuid = {};
};

/// Whether the bytes begin with the header that this device's driver writes. Drivers must refuse
/// foreign data themselves, but some have crashed on it instead.
bool is_pipeline_cache_of(std::span<const uint8_t> p_bytes, const PipelineCacheMaker &p_maker);

} // namespace gnomon
