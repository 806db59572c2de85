// The number of solids between a receiver and the light's centre: exact, from the faces that the texel of a
// view's map lists. Which map and which lists there are changes the time it takes, never the number.
#ifndef COUNT_FACES_INC_GLSL
#define COUNT_FACES_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"

/// Read in place: drivers copy all views of constants that are handed on.
CountViewConstants load_count_view(uint p_view);
/// The first node of a texel's list, counted from 1; 0: the list is empty. Texels of all views one after
/// the other, by view, row and column.
uint load_count_head(uint p_index);
/// (face, next node) of a node, counted from 0.
uvec2 load_count_node(uint p_index);
/// Halvings of a view's map: where its nodes had no room.
uint load_count_level(uint p_view);
CountFaceRecord load_count_face(uint p_face);
vec4 load_count_plane(uint p_face);

/// What the segment from a receiver to the light's centre crosses.
struct CountCrossings {
	int away;	// back-facing faces of closed parts
	int toward; // light-facing ones
	int both;	// faces of other parts
};

/// Adds a face where it is between the receiver and the light's centre. p_is_before: the receiver is in
/// front of it and the light's centre is not; false: the other way round.
void count_face(CountReceiver p_receiver, CountFaceRecord p_face, bool p_is_before, inout CountCrossings r_found) {
	const vec2 a = count_offset(p_receiver, uintBitsToFloat(p_face.a_kind.xyz)).xy;
	const vec2 b = count_offset(p_receiver, uintBitsToFloat(p_face.b.xyz)).xy;
	const vec2 c = count_offset(p_receiver, uintBitsToFloat(p_face.c.xyz)).xy;
	const bool is_left = is_count_left(a, b);
	const bool is_crossed = is_left == is_count_left(b, c) && is_left == is_count_left(c, a);
	const bool is_open = p_face.a_kind.w != 0u;
	r_found.both += is_crossed && is_open ? 1 : 0;
	r_found.away += is_crossed && !is_open && p_is_before ? 1 : 0;
	r_found.toward += is_crossed && !is_open && !p_is_before ? 1 : 0;
}

/// Solids between a receiver and the light's centre. Where the receiver is inside closed parts, more faces
/// are light-facing; where the light's centre is inside, more are back-facing: the larger number is that of
/// the parts that hide it.
int sum_crossings(CountCrossings p_found) {
	return p_found.both + max(p_found.away, p_found.toward);
}

/// The texel of a view's map that holds x' and y', or the nearest one.
uvec2 find_count_texel(uint p_view, vec2 p_position) {
	const CountViewConstants view = load_count_view(p_view);
	const vec2 size = vec2(max(view.map_size_px >> load_count_level(p_view), uvec2(1u)));
	const vec2 texel = (p_position / view.half_extent * 0.5 + 0.5) * size;
	return uvec2(clamp(texel, vec2(0.0), size - 1.0));
}

/// The first node of a texel's list, see load_count_head.
uint load_count_first_node(uint p_view, uvec2 p_texel) {
	const uvec2 size = load_count_view(p_view).map_size_px;
	return load_count_head((p_view * size.y + p_texel.y) * size.x + p_texel.x);
}

/// Adds the face of a node, counted from 1, and returns the next node; nothing and 0 of node 0.
uint count_node(CountLightConstants p_light, uint p_view, uint p_node, CountReceiver p_receiver,
		inout CountCrossings r_found) {
	const uvec2 node = load_count_node(p_view * p_light.node_capacity + max(p_node, 1u) - 1u);
	const vec4 plane = load_count_plane(node.x);
	const bool is_before = is_count_before(plane, p_receiver.position);
	if (p_node != 0u && is_before != is_count_light_before(p_light.is_directional != 0u, plane)) {
		count_face(p_receiver, load_count_face(node.x), is_before, r_found);
	}
	return p_node != 0u ? node.y : 0u;
}

/// Crossings of the faces that the receiver's texel lists. p_position: x' and y' of the receiver in its view.
CountCrossings count_crossings(CountLightConstants p_light, uint p_view, vec2 p_position, CountReceiver p_receiver) {
	// Casters beyond the map hide nothing that the light reaches.
	const bool is_inside = all(lessThanEqual(abs(p_position), load_count_view(p_view).half_extent));
	uint next = is_inside ? load_count_first_node(p_view, find_count_texel(p_view, p_position)) : 0u;
	CountCrossings found = CountCrossings(0, 0, 0);
	// Two an iteration, since llvmpipe ends every loop once an invocation has made 65535 iterations.
	while (next != 0u) {
		next = count_node(p_light, p_view, next, p_receiver, found);
		next = count_node(p_light, p_view, next, p_receiver, found);
	}
	return found;
}

int count_solids(CountLightConstants p_light, uint p_view, vec2 p_position, CountReceiver p_receiver) {
	return sum_crossings(count_crossings(p_light, p_view, p_position, p_receiver));
}

#endif
