#pragma once

#include "modules/rendering_device/rendering_device.h"

#include <string>

namespace gnomon {

// Buffers that passes write and later passes fetch from, see count_fetch_inc.glsl: storage buffers,
// also usable as texel buffers when the device has DeviceFeatures::storage_texel_buffers.

/// Describes a buffer that is fetched from as texels of p_format.
BufferDesc make_fetched_buffer_desc(const RenderingDevice &p_device, const std::string &p_name,
		uint64_t p_size_bytes, Format p_format);

/// The entry point for the device: p_shader, for example "shadow_edge_count/resolve.comp", or its
/// variant for storage buffers.
std::string choose_fetching_shader(const RenderingDevice &p_device, const std::string &p_shader);

/// "shadow_edge_count/resolve.storage.comp".
std::string get_storage_variant(const std::string &p_shader);

} // namespace gnomon
