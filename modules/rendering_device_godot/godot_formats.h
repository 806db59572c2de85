#pragma once

#include "modules/rendering_device/resource_types.h"

namespace gnomon {

/// Returns a value of godot::RenderingDevice::DataFormat.
int64_t to_godot_format(Format p_format);
/// Returns the data format of a float vertex attribute.
int64_t to_godot_vertex_format(uint32_t p_component_count);
/// Returns bits of godot::RenderingDevice::TextureUsageBits.
int64_t to_godot_usage(const TextureDesc &p_desc);
/// Converts a clear value for the format. For UINT formats, the floats of the result have the bits
/// of the integers, because Godot passes the bits to the driver unchanged.
glm::vec4 to_godot_clear_value(Format p_format, const glm::vec4 &p_value);

} // namespace gnomon
