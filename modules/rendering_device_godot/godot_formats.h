#pragma once

#include "modules/rendering_device/resource_types.h"

namespace gnomon {

/// A value of godot::RenderingDevice::DataFormat.
int64_t to_godot_format(Format p_format);
/// Of a vertex attribute: floats.
int64_t to_godot_vertex_format(uint32_t p_component_count);
int64_t to_godot_usage(const TextureDesc &p_desc);
/// The bits that Godot hands on to the driver as they are.
glm::vec4 to_godot_clear_value(Format p_format, const glm::vec4 &p_value);

} // namespace gnomon
