#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/shadow_edge_count_shared.h"

// Clears the face lists of one view before they are built. In the first attempt it also chooses the size of their
// texels; in further ones retry_faces.comp has chosen it.
layout(local_size_x = FACE_LIST_GROUP_SIZE) in;
layout(std140, set = 0, binding = FACE_LIST_BINDING_LIGHT) restrict readonly buffer Light {
	CountLightConstants light;
};
layout(std430, set = 0, binding = FACE_LIST_BINDING_HEADS) writeonly buffer Heads {
	uint heads[];
};
layout(std430, set = 0, binding = FACE_LIST_BINDING_TOTALS) buffer Totals {
	uint totals[];
};
layout(push_constant) uniform Push {
	CountFaceListPush push;
};

/// How often the map's size is halved: as often as when the lists fitted last, or once less if a quarter of the nodes
/// was enough, since texels of half the width need about four times the nodes. 0 if the lists are known to fit.
uint choose_first_level() {
	const uvec2 size_px = light.views[push.view].map_size_px;
	const uint last_level = uint(findMSB(max(size_px.x, size_px.y))); // one texel
	const uint level = min(totals[EDGE_COUNT_TOTAL_LEVELS + push.view], last_level);
	const bool is_roomy = totals[EDGE_COUNT_TOTAL_NODES + push.view] <= light.node_capacity / 4u;
	return push.may_overflow != 0u && level > 0u ? (is_roomy ? level - 1u : level) : 0u;
}

void main() {
	const uvec2 size_px = light.views[push.view].map_size_px;
	const uint texel_count = size_px.x * size_px.y;
	const uint texel = find_work_item(uint(FACE_LIST_GROUP_SIZE));
	if (texel < texel_count) {
		heads[push.view * texel_count + texel] = 0u;
	}
	if (texel == 0u && push.is_first != 0u) {
		totals[EDGE_COUNT_TOTAL_LEVELS + push.view] = choose_first_level();
		totals[EDGE_COUNT_TOTAL_NODES + push.view] = 0u;
	}
}
