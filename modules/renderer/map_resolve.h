#pragma once

#include "modules/render_graph/compute_pass.h"
#include "modules/renderer/shadow_technique.h"

#include "shared/map_resolve_shared.h"

#include <vector>

namespace gnomon {

/// What common/map_resolve_inc.glsl reads, for a compute pass over the pixels; the technique adds
/// its own bindings from MAP_RESOLVE_OWN_BINDING on.
std::vector<PassBinding> make_map_resolve_bindings(
		RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs);

/// As above with other views than those of the inputs, of a light in another place.
std::vector<PassBinding> make_map_resolve_bindings(RenderGraph &r_graph,
		const ShadowTechnique::Inputs &p_inputs, const LightSnapshot &p_light,
		const std::vector<LightView> &p_views);

/// A mask to be written by a compute pass; see ShadowTechnique::resolve for the formats.
RGTexture create_mask(
		RenderGraph &r_graph, glm::uvec2 p_size_px, Format p_format = Format::R16_SFLOAT);

} // namespace gnomon
