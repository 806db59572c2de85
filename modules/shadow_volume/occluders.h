#pragma once

#include "modules/shadows/shadow_technique.h"

#include <vector>

// Which casters are drawn from the light, to find those that they hide.

namespace gnomon {

/// At most 128 casters of p_instances, with at most 16384 triangles together: those that look
/// largest from the light, the largest first, and no meshes of more than 4096 triangles.
/// p_was_hidden: of each of p_instances, whether it was found to be hidden lately; such a caster is
/// taken after all others. Empty: nothing is known. The choice decides what is found, never what
/// the image shows.
std::vector<uint32_t> choose_occluders(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_instances, const std::vector<bool> &p_was_hidden);

/// What the occluders stop.
struct OccluderMap {
	RGTexture depth; // a layer per view, reversed; where nothing is known 0
	RGBuffer bounds; // for every view the texels of all levels, see culling_shared.h
};

/// Passes that draw the occluders from each of the light's views.
OccluderMap add_occluder_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_occluders);

} // namespace gnomon
