#pragma once

#include "modules/shadows/light_view.h"

#include <vector>

namespace gnomon {

/// Views of a directional light, nested around what the camera sees up to a distance each, the
/// nearest first (Zhang, Sun, Xu, Lun 2006, Parallel-split shadow maps for large-scale virtual
/// environments; their practical split scheme, section 4.1). The last one is p_whole. Each of the
/// others is a square that contains the camera's frustum up to its distance however the camera is
/// turned, for images of up to 16 : 9, and moves by whole texels. A receiver belongs to the finest
/// view that contains it and the texels around it that its filter reads (find_cascade in
/// shadow_pcss/resolve.comp), so nothing depends on the frustum's exact shape.
/// p_count: 1 .. MAX_LIGHT_VIEWS. p_border_px: as for build_light_views.
std::vector<LightView> split_into_cascades(const LightView &p_whole, const LightScene &p_scene,
		uint32_t p_count, uint32_t p_border_px);

/// Whether a map of the view has smaller texels than one of the other view. find_cascade reads only
/// maps that are finer than the last one.
bool is_finer(const LightView &p_view, const LightView &p_other);

} // namespace gnomon
