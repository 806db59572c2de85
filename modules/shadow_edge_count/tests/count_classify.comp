#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_classify_inc.glsl"

// Input 4 i ..: the corners of two triangles 0 1 2 and 1 0 3; w of the first: the second is there, of
// the second: the edge is stored from 1 to 0, with the faces changed. Output: the record, is kept.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 items[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};
layout(set = 0, binding = 2) uniform Constants {
	CountViewConstants view;
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (4u * item >= uint(items.length())) {
		return;
	}
	const vec3 a = items[4u * item].xyz;
	const vec3 b = items[4u * item + 1u].xyz;
	const bool has_second = items[4u * item].w > 0.5;
	const bool is_reversed = items[4u * item + 1u].w > 0.5;
	const vec4 first = make_count_plane(a, b, items[4u * item + 2u].xyz);
	const vec4 second =
			has_second ? make_count_plane(b, a, items[4u * item + 3u].xyz) : vec4(0.0);
	// Two triangles are an open mesh.
	const int kind = EDGE_COUNT_DOUBLE_SIDED | (has_second ? EDGE_COUNT_HAS_FACE1 : 0);
	CountEdgeRecord record;
	const bool is_kept = make_count_record(view, is_reversed ? b : a, is_reversed ? a : b,
			is_reversed ? second : first, is_reversed ? first : second, kind, record);
	results[5u * item] = record.a_bx;
	results[5u * item + 1u] = record.by_bw_weight_kind;
	results[5u * item + 2u] = record.plane0;
	results[5u * item + 3u] = record.plane1;
	results[5u * item + 4u] = vec4(is_kept ? 1.0 : 0.0);
}
