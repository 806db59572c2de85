#pragma once

#include "modules/shadow_edge_count/tests/count_scene.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

namespace gnomon {

/// An edge and a view as the shaders read them.
inline shader::CountEdgeRecord make_record(const CountEdge &p_edge) {
	const int kind = (p_edge.has_face1 ? EDGE_COUNT_HAS_FACE1 : 0) |
			(p_edge.is_double_sided ? EDGE_COUNT_DOUBLE_SIDED : 0);
	shader::CountEdgeRecord record;
	record.a_bx = glm::vec4(glm::vec3(p_edge.a), float(p_edge.b.x));
	record.by_bw_weight_kind =
			glm::vec4(p_edge.b.y, p_edge.b.z, float(p_edge.center_weight), float(kind));
	record.plane0 = glm::vec4(p_edge.plane0);
	record.plane1 = glm::vec4(p_edge.plane1);
	return record;
}

inline shader::CountViewConstants make_constants(const CountScene &p_scene) {
	const CountSpace &space = p_scene.get_space();
	shader::CountViewConstants constants = {};
	constants.disc_radius = float(space.disc_radius);
	constants.depth_scale_m = float(space.get_depth_scale(0));
	constants.depth_far_m = float(space.depth_far_m);
	constants.scene_size_m = float(space.scene_size_m);
	constants.half_extent = glm::vec2(float(p_scene.half_extent));
	constants.map_size_px = p_scene.get_layers().get_size_px();
	constants.is_directional = space.is_directional ? 1 : 0;
	constants.near_m = float(space.near_m);
	constants.least_slope = float(space.least_slope);
	return constants;
}

} // namespace gnomon
