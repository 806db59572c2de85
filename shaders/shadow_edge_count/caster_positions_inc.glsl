// The vertices of one caster in light space, for the passes that find its faces and edges. Both use the same
// expression, so that they get equal bits.
#ifndef CASTER_POSITIONS_INC_GLSL
#define CASTER_POSITIONS_INC_GLSL

#include "common/fetch_inc.glsl"
#include "shadow_edge_count/shadow_edge_count_shared.h"

FETCHED_VEC4S(FIND_BINDING_POSITIONS, positions_buffer); // in the node's space
layout(push_constant) uniform Push {
	CountCasterPush push;
};

vec3 load_light_position(uint p_vertex) {
	const vec3 p = FETCH_VEC4(positions_buffer, p_vertex).xyz;
	const mat4 m = push.light_from_node;
	precise const vec3 position = ((m[0].xyz * p.x + m[1].xyz * p.y) + m[2].xyz * p.z) + m[3].xyz;
	return position;
}

#endif
