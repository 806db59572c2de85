#pragma once

#include "modules/renderer/renderer.h"
#include "modules/scene/scene_snapshot.h"

#include <string>

namespace gnomon {

/// What one light's mask costs, as `visibility --time` writes it (doc/command_line.md): medians
/// and 90th percentiles over the frames, per pass and in total. The passes are those of the light;
/// the G-buffer is not counted. Nothing is kept between the frames, as if the light moved.
/// p_request: a mask request; its mode and outputs are replaced.
std::string measure_mask_time(
		Renderer &r_renderer, RenderRequest p_request, uint32_t p_warm_up_count, uint32_t p_count);

} // namespace gnomon
