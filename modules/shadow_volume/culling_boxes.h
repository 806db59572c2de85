#pragma once

#include "modules/scene/mesh.h"

#include "shadow_volume/culling_shared.h"

#include <span>
#include <vector>

namespace gnomon {

/// The boxes that cull.comp tests: first one per subtree (a workgroup each), then the casters'.
struct CullingBoxes {
	std::vector<shader::CullingBox> boxes;
	uint32_t subtree_count = 0; // number of subtree boxes, the first in `boxes`
};

/// Builds a bounding volume hierarchy of the casters' boxes and splits it into subtrees of at most
/// CULLING_CASTERS_PER_SUBTREE (64) boxes. CullingBox::first of a caster is its index in
/// p_boxes_world. Empty and NaN boxes are skipped, so these casters are never hidden.
/// The result is in float32, metres relative to p_origin_world.
CullingBoxes build_culling_boxes(
		std::span<const Bounds> p_boxes_world, const glm::dvec3 &p_origin_world);

} // namespace gnomon
