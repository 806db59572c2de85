// The casters of a light, for the passes over all their faces or edges. Each work group processes FIND_GROUP_SIZE
// consecutive ones, which may belong to several casters: each invocation searches its own.
#ifndef CASTERS_INC_GLSL
#define CASTERS_INC_GLSL

#include "common/fetch_inc.glsl"
#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/shadow_edge_count_shared.h"

FETCHED_UVEC4S(FIND_BINDING_CASTERS, casters_buffer); // CountCasterRecord
FETCHED_VEC4S(FIND_BINDING_POINTS, points_buffer); // of all meshes: vertices and source parts, in the node's space
layout(std430, set = 0, binding = FIND_BINDING_GROUPS) readonly buffer Groups {
	CountWorkGroup groups[];
};
layout(push_constant) uniform Push {
	CountFindPush push;
};

const uint NO_GROUP = 0xffffffffu;
// Enough for all casters of a light, of which each has a face: a face index has 24 bits.
const uint MAX_SEARCH_STEPS = 24u;

/// This work group. Its index is NO_GROUP if the dispatch has more work groups than there are.
CountWorkGroup load_work_group() {
	const uint group = find_work_group();
	const CountWorkGroup loaded = groups[push.first_group + min(group, push.group_count - 1u)];
	return CountWorkGroup(group < push.group_count ? loaded.index : NO_GROUP, loaded.first_caster, loaded.last_caster, 0u);
}

/// The words first_face .. flags of a caster.
uvec4 load_first_items(uint p_caster) {
	return FETCH_UVEC4(casters_buffer, p_caster * uint(EDGE_COUNT_CASTER_ITEMS) + 4u);
}

/// The last caster of the work group whose first item is at most p_item. p_is_word: items are words, else faces.
uint find_caster(CountWorkGroup p_group, bool p_is_word, uint p_item) {
	uint first = p_group.first_caster;
	uint last = p_group.last_caster;
	for (uint step = 0u; step < MAX_SEARCH_STEPS && first < last; ++step) {
		const uint middle = (first + last + 1u) / 2u;
		const uvec4 items = load_first_items(middle);
		const bool is_reached = (p_is_word ? items.y : items.x) <= p_item;
		first = is_reached ? middle : first;
		last = is_reached ? last : middle - 1u;
	}
	return first;
}

CountCasterRecord load_caster(uint p_index) {
	const uint first = p_index * uint(EDGE_COUNT_CASTER_ITEMS);
	const mat4 light_from_node = mat4(uintBitsToFloat(FETCH_UVEC4(casters_buffer, first)),
			uintBitsToFloat(FETCH_UVEC4(casters_buffer, first + 1u)), uintBitsToFloat(FETCH_UVEC4(casters_buffer, first + 2u)),
			uintBitsToFloat(FETCH_UVEC4(casters_buffer, first + 3u)));
	const uvec4 items = load_first_items(p_index);
	const uvec4 mesh = FETCH_UVEC4(casters_buffer, first + 5u);
	const vec4 level = uintBitsToFloat(FETCH_UVEC4(casters_buffer, first + 6u));
	return CountCasterRecord(light_from_node, items.x, items.y, items.z, items.w, mesh.x, mesh.y, mesh.z, mesh.w, level.x, level.y,
			level.z, 0u);
}

/// A vertex of a caster in light space. All passes use the same expression, so that they get equal bits.
vec3 load_light_position(CountCasterRecord p_caster, uint p_vertex) {
	const vec3 p = FETCH_VEC4(points_buffer, p_caster.first_vertex + p_vertex).xyz;
	const mat4 m = p_caster.light_from_node;
	precise const vec3 position = ((m[0].xyz * p.x + m[1].xyz * p.y) + m[2].xyz * p.z) + m[3].xyz;
	return position;
}

#endif
