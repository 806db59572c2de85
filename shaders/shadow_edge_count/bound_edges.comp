#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/fetch_inc.glsl"
#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/shadow_edge_count_shared.h"

// Computes the bounds, in space and of distances, of each bundle of EDGE_COUNT_BUNDLE_SIZE edges in
// a light's list. One invocation per bundle.
layout(local_size_x = 64) in;
FETCHED_UVEC4S(FIND_BINDING_EDGES, edges_buffer); // CountEdgeRecord
FETCHED_UVEC4S(FIND_BINDING_FACES, faces_buffer); // CountFaceRecord
layout(std140, set = 0, binding = FIND_BINDING_LIGHT) restrict readonly buffer Light {
	CountLightConstants light;
};
layout(std430, set = 0, binding = FIND_BINDING_TOTALS) readonly buffer Totals {
	uint totals[];
};
layout(std430, set = 0, binding = FIND_BINDING_BUNDLES) writeonly buffer Bundles {
	CountEdgeBundle bundles[];
};

void main() {
	const float FAR = 3e38;
	// For rounding of the box: fractions of its half size and of the centre's coordinates.
	const float WIDENING = 1.0001;
	const float CENTER_ROUNDING = 1e-6;
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint bundle = find_work_item(uint(64));
	const uint edge_count = min(totals[EDGE_COUNT_TOTAL_EDGES], light.max_edge_count);
	if (bundle * size >= edge_count) {
		return;
	}
	vec3 minimum = vec3(FAR);
	vec3 maximum = vec3(-FAR);
	vec2 distances = vec2(FAR, -FAR);
	for (uint i = bundle * size; i < min((bundle + 1u) * size, edge_count); ++i) {
		const CountEdgeRecord edge =
				CountEdgeRecord(FETCH_UVEC4(edges_buffer, 2u * i), FETCH_UVEC4(edges_buffer, 2u * i + 1u));
		const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
		const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
		minimum = min(minimum, min(a, b));
		maximum = max(maximum, max(a, b));
		const uint face = 3u * (edge.a_face0.w & EDGE_COUNT_FACE_MASK);
		distances.x = min(distances.x, uintBitsToFloat(FETCH_UVEC4(faces_buffer, face + 1u).w));
		distances.y = max(distances.y, uintBitsToFloat(FETCH_UVEC4(faces_buffer, face + 2u).w));
	}
	const vec3 center = 0.5 * minimum + 0.5 * maximum;
	bundles[bundle] = CountEdgeBundle(vec4(center, distances.x),
			vec4(WIDENING * max(maximum - center, center - minimum) + CENTER_ROUNDING * abs(center), distances.y));
}
