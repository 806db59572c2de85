#pragma once

#include "modules/rendering_device/rendering_device.h"

#include <string>

namespace gnomon {

// Buffers that shaders read as texel buffers if the device has
// DeviceFeatures::storage_and_texel_buffers, else as storage buffers. See fetch_inc.glsl.

/// The usage of such a buffer, which shaders may also write as a storage buffer.
BufferUsage get_fetched_usage(const RenderingDevice &p_device);

/// Describes such a buffer. p_format: its texel format.
BufferDesc make_fetched_buffer_desc(const RenderingDevice &p_device, const std::string &p_name,
		uint64_t p_size_bytes, Format p_format);

/// The shader that reads such buffers on the device: p_shader, for example
/// "shadow_edge_count/resolve.comp", or its variant for storage buffers.
std::string choose_fetching_shader(const RenderingDevice &p_device, const std::string &p_shader);

/// The variant of a shader for storage buffers: "shadow_edge_count/resolve.storage.comp" for
/// "shadow_edge_count/resolve.comp".
std::string get_storage_variant(const std::string &p_shader);

} // namespace gnomon
