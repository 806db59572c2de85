#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_sweep_inc.glsl"

// Input: items 2 i and 2 i + 1 are the positions of an anchor and of a receiver in light space; w is the number of faces,
// beyond which are only planes of edges. Output per pair: x is the
// number of differences between the faces on the receiver's way and those by the sweep from the anchor, over the three
// kinds of faces; y is 1 if the sweep is undecided; z the number of faces on the way; w the differences between these and
// those that count_along_ray finds.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 items[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};

ivec3 count_all_faces(CountReceiver p_receiver, uint p_face_count) {
	ivec3 found = ivec3(0);
	for (uint i = 0u; i < p_face_count; ++i) {
		const vec4 plane = load_count_plane(i);
		const bool is_in_front = is_count_in_front(plane, p_receiver.position);
		if (is_in_front != is_count_light_in_front(plane)) {
			found += count_face(p_receiver, load_count_face(i), is_in_front);
		}
	}
	return found;
}

float count_differences(ivec3 p_one, ivec3 p_other) {
	const ivec3 difference = abs(p_one - p_other);
	return float(difference.x + difference.y + difference.z);
}

void main() {
	load_light();
	const uint item = gl_GlobalInvocationID.x;
	if (2u * item >= uint(items.length())) {
		return;
	}
	// 0.0: any distance will do, since all faces have one LOD.
	const CountReceiver anchor = make_count_receiver(light, items[2u * item].xyz, 0.0);
	const CountReceiver receiver = make_count_receiver(light, items[2u * item + 1u].xyz, 0.0);
	const uint face_count = uint(items[2u * item].w);
	const Sweep sweep = make_sweep(anchor.position, receiver.position);
	ivec3 swept = count_all_faces(anchor, face_count);
	bool is_undecided = false;
	for (uint i = 0u; i < find_edge_count(); ++i) {
		const CountEdgeRecord edge = load_count_edge(i);
		const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
		const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
		const ivec3 change = find_edge_change(edge);
		if (any(notEqual(change, ivec3(0)))) {
			swept += change * find_edge_crossing(sweep, make_swept_edge(anchor.position, a, b), find_left_sign(anchor, a, b),
									  find_left_sign(receiver, a, b), is_undecided);
		}
	}
	for (uint i = 0u; i < face_count; ++i) {
		swept += find_face_change(
				anchor.position, receiver.position, sweep, load_count_face(i), load_count_plane(i), is_undecided);
	}
	const ivec3 expected = count_all_faces(receiver, face_count);
	results[item] = vec4(count_differences(swept, expected), is_undecided ? 1.0 : 0.0,
			float(expected.x + expected.y + expected.z),
			count_differences(count_along_ray(receiver, true), expected));
}
