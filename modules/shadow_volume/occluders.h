#pragma once

#include "modules/shadows/shadow_technique.h"

#include <vector>

// Chooses occluders among the casters and draws them from the light, to find the casters they hide.

namespace gnomon {

/// Chooses at most 128 casters of p_instances, with at most 16384 triangles together: those that
/// appear largest from the light, the largest first. Skips casters smaller than 8 texels, meshes of
/// more than 4096 triangles, and meshes whose vertices are too far from their origin for float32.
/// p_was_hidden: for each of p_instances, whether it was hidden recently; such casters come last.
/// It is empty when that is not known. The choice affects how many casters are culled, never the
/// image.
std::vector<uint32_t> choose_occluders(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_instances, const std::vector<bool> &p_was_hidden);

/// Depths behind which the occluders block all light.
struct OccluderMap {
	RGTexture depth; // one array layer per view, reversed depth; 0 where nothing is occluded
	RGBuffer bounds; // per view the depth pyramid of `depth`: the texels of all levels
};

/// Adds passes that draw the occluders from each of the light's views.
OccluderMap add_occluder_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_occluders);

} // namespace gnomon
