#pragma once

#include "modules/rendering_device/rendering_device.h"

#include <string>

namespace gnomon {

// What passes write and others fetch from, see count_fetch_inc.glsl: storage buffers, and texel
// buffers too where the device has DeviceFeatures::storage_texel_buffers.

/// Of a buffer that is fetched from as texels of p_format.
BufferDesc make_fetched_buffer_desc(const RenderingDevice &p_device, const std::string &p_name,
		uint64_t p_size_bytes, Format p_format);

/// The entry point that fetches on such a device: p_shader, "shadow_edge_count/resolve.comp", or
/// its variant for storage buffers.
std::string choose_fetching_shader(const RenderingDevice &p_device, const std::string &p_shader);

/// "shadow_edge_count/resolve.storage.comp".
std::string get_storage_variant(const std::string &p_shader);

} // namespace gnomon
