#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_edge_inc.glsl"
#include "shadow_edge_count/count_crossings_inc.glsl"

// Input: receivers' positions in light space. Output: visibility, solids in front of the light's centre, signed area
// of the disc (see CountState). Tests all faces and edges, without lists.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 items[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};
layout(std140, set = 0, binding = 2) restrict readonly buffer Constants {
	CountLightConstants light;
};
layout(set = 0, binding = 3) readonly buffer Edges {
	CountEdgeRecord edges[];
};
layout(set = 0, binding = 4) readonly buffer Faces {
	CountFaceRecord faces[];
};
layout(set = 0, binding = 5) readonly buffer Planes {
	vec4 planes[];
};
layout(set = 0, binding = 6) readonly buffer Masks {
	uvec2 masks[];
};

uvec4 load_count_masks(uint p_index, uint p_pair) {
	return uvec4(masks[p_index], uvec2(0u)); // one set of points
}

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (item >= uint(items.length())) {
		return;
	}
	// 0.0: any distance will do, since all faces have one LOD.
	const CountReceiver receiver = make_count_receiver(light, items[item].xyz, 0.0);
	ivec3 crossings = ivec3(0);
	for (uint i = 0u; i < light.face_count; ++i) {
		const bool is_in_front = is_count_in_front(planes[i], receiver.position);
		if (is_in_front != is_count_light_in_front(planes[i])) {
			crossings += count_face(receiver, faces[i], is_in_front);
		}
	}
	CountState state = make_count_state(sum_crossings(crossings));
	for (uint i = 0u; i < uint(faces.length()) && light.disc_radius > 0.0 && !IS_DIRECTIONAL; ++i) {
		count_sectors(
				find_cut_sectors(receiver, faces[i], planes[i], crossings.x >= crossings.y), state);
	}
	for (uint i = 0u; i < uint(edges.length()) && light.disc_radius > 0.0; ++i) {
		const CountEdgeRecord edge = edges[i];
		const CountEdgeKind kind = make_count_kind(edge.a_face0.w, edge.b_face1.w);
		const uint face0 = edge.a_face0.w & EDGE_COUNT_FACE_MASK;
		const int weight = count_weight(
				receiver.position, planes[face0], kind.has_face1 ? planes[edge.b_face1.w] : vec4(0.0), kind);
		const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
		const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
		count_sectors(find_edge_sectors(receiver, CountedEdge(a, b, weight), CountedEdge(a, b, 0)), state);
	}
	results[item] = vec4(find_visibility(state, has_overlap(state), add_sample_sets(state)), float(state.solid_count), float(state.area) * AREA_UNIT, 0.0);
}
