#pragma once

#include "modules/scene/mesh.h"

#include "shadow_volume/culling_shared.h"

#include <span>
#include <vector>

namespace gnomon {

/// What one workgroup each of cull.comp looks at: first all subtrees, then the casters' boxes.
struct CullingBoxes {
	std::vector<shader::CullingBox> boxes;
	uint32_t subtree_count = 0;
};

/// Cuts a tree over the boxes into subtrees of at most 64. CullingBox::first of a caster is its
/// index in p_boxes_world. Boxes that no tree takes (empty, NaN) are skipped: never hidden.
/// float32, metres from p_origin_world.
CullingBoxes build_culling_boxes(
		std::span<const Bounds> p_boxes_world, const glm::dvec3 &p_origin_world);

} // namespace gnomon
