#pragma once

#include "modules/shadows/shadow_technique.h"

#include <vector>

// The casters that are drawn from the light as occluders, to find the casters that they hide.

namespace gnomon {

/// Chooses at most 128 casters of p_instances, with at most 16384 triangles together: those that
/// appear largest from the light, the largest first, without meshes of more than 4096 triangles.
/// p_was_hidden: per instance, whether it was hidden recently; such casters come last. Empty:
/// unknown. The choice affects how many casters are culled, never the image.
std::vector<uint32_t> choose_occluders(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_instances, const std::vector<bool> &p_was_hidden);

/// Depths behind which the occluders block all light.
struct OccluderMap {
	RGTexture depth; // one array layer per view, reversed depth; 0 where nothing is occluded
	RGBuffer bounds; // per view the texels of all levels, see culling_shared.h
};

/// Adds passes that draw the occluders from each of the light's views.
OccluderMap add_occluder_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_occluders);

} // namespace gnomon
