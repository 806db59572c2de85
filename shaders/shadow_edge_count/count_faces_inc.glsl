// The exact number of solids between a receiver and the light's centre, from the faces that the receiver's texel in a
// view's map lists. The size of the map affects the run time, never the number.
#ifndef COUNT_FACES_INC_GLSL
#define COUNT_FACES_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"
#include "shadow_edge_count/count_status_inc.glsl"

// Accessors, which the includer defines for its buffers.

/// A function, not a parameter: drivers copy the constants of all views to pass them.
CountViewConstants load_count_view(uint p_view);
/// The first node of a texel's list, counted from 1; 0 if the list is empty. p_index: of the texel, by view, row and
/// column.
uint load_count_head(uint p_index);
/// (face and cells, next node) of a node, see EDGE_COUNT_NODE_CELLS_SHIFT. p_index counts from 0, the next node from 1;
/// it is 0 at the end of the list.
uvec2 load_count_node(uint p_index);
/// How often the size of a view's map was halved because its face lists did not fit.
uint load_count_level(uint p_view);
/// p_face: what a list has; the accessors limit it to the light's faces.
CountFaceRecord load_count_face(uint p_face);
vec4 load_count_plane(uint p_face);

/// Numbers of faces that the segment from a receiver to the light's centre crosses.
struct CountCrossings {
	int back_facing;	// faces of closed mesh parts that face the receiver, not the light
	int light_facing; // faces of closed mesh parts that face the light
	int double_sided;	// faces of double-sided mesh parts
};

/// Counts a face if the segment from the receiver to the light's centre crosses it. Its ends must be on different sides
/// of the face's plane. p_is_in_front: the receiver is in front of it, otherwise the light's centre is.
void count_face(CountReceiver p_receiver, CountFaceRecord p_face, bool p_is_in_front, inout CountCrossings r_found) {
	const vec2 a = count_offset(p_receiver, uintBitsToFloat(p_face.a_kind.xyz)).xy;
	const vec2 b = count_offset(p_receiver, uintBitsToFloat(p_face.b_first_distance.xyz)).xy;
	const vec2 c = count_offset(p_receiver, uintBitsToFloat(p_face.c_end_distance.xyz)).xy;
	const bool is_left = is_count_left(a, b);
	const bool is_crossed = is_left == is_count_left(b, c) && is_left == is_count_left(c, a) &&
			is_in_distance_range(p_receiver.part_distance, p_face);
	const bool is_open = p_face.a_kind.w != 0u;
	r_found.double_sided += is_crossed && is_open ? 1 : 0;
	r_found.back_facing += is_crossed && !is_open && p_is_in_front ? 1 : 0;
	r_found.light_facing += is_crossed && !is_open && !p_is_in_front ? 1 : 0;
}

/// The number of solids between a receiver and the light's centre. If the receiver is inside closed mesh parts, the
/// segment crosses more faces that face the light; if the light's centre is inside, it crosses more that face the
/// receiver. The larger number is that of the mesh parts that hide the light.
int sum_crossings(CountCrossings p_found) {
	return p_found.double_sided + max(p_found.back_facing, p_found.light_facing);
}

/// A position (x', y') in a view's map, in texels: 0 .. p_size, if it is inside. p_size: see find_map_size.
vec2 find_map_position(CountViewConstants p_view, vec2 p_size, vec2 p_position) {
	return (p_position / p_view.half_extent * 0.5 + 0.5) * p_size;
}

/// The size of a view's map in texels.
vec2 find_map_size(CountViewConstants p_view, uint p_view_index) {
	return vec2(max(p_view.map_size_px >> load_count_level(p_view_index), uvec2(1u)));
}

/// The texel of a view's map that contains p_position (x', y'), or the nearest one.
uvec2 find_count_texel(uint p_view, vec2 p_position) {
	const CountViewConstants view = load_count_view(p_view);
	const vec2 size = find_map_size(view, p_view);
	return uvec2(clamp(find_map_position(view, size, p_position), vec2(0.0), size - 1.0));
}

/// The first node of a texel's list, see load_count_head.
uint load_count_first_node(uint p_view, uvec2 p_texel) {
	const uvec2 size = load_count_view(p_view).map_size_px;
	return load_count_head((p_view * size.y + p_texel.y) * size.x + p_texel.x);
}

/// A walk through the list of a receiver's texel.
struct FaceWalk {
	uint first_node; // of the view
	uint next;		 // counted from 1; 0 at the end
	uint cell;		 // bits of the receiver's column and row of cells, as in a node
	uint capacity;	 // of the view's nodes
	uint max_next;	 // of all nodes so far
	uint steps_left; // a list has each face once at most
};

/// Sets the next node, or ends the walk if there is no such node.
void set_next_node(inout FaceWalk r_walk, uint p_next) {
	r_walk.max_next = max(r_walk.max_next, p_next);
	r_walk.next = p_next <= r_walk.capacity ? p_next : 0u;
}

/// p_position: x' and y' of the receiver in its view.
FaceWalk start_face_walk(CountLightConstants p_light, uint p_view, vec2 p_position) {
	const CountViewConstants view = load_count_view(p_view);
	const vec2 size = find_map_size(view, p_view);
	const vec2 position = find_map_position(view, size, p_position);
	const vec2 texel = floor(clamp(position, vec2(0.0), size - 1.0));
	const float side = float(EDGE_COUNT_NODE_CELLS_PER_SIDE);
	const uvec2 cell = uvec2(clamp(side * (position - texel), 0.0, side - 1.0));
	// Outside the map there is no receiver that the light reaches.
	const bool is_inside = all(lessThanEqual(abs(p_position), view.half_extent));
	FaceWalk walk = FaceWalk(p_view * p_light.node_capacity, 0u,
			(1u << cell.x | 1u << (EDGE_COUNT_NODE_CELLS_PER_SIDE + cell.y)) << EDGE_COUNT_NODE_CELLS_SHIFT,
			p_light.node_capacity, 0u, min(p_light.node_capacity, p_light.face_count));
	set_next_node(walk, is_inside ? load_count_first_node(p_view, uvec2(texel)) : 0u);
	return walk;
}

/// Goes to the next node unless r_faces is full. Adds the node's face to r_faces if its bounds overlap the receiver's
/// cell. r_faces: unused items, which follow the others, are EDGE_COUNT_NO_FACE. An index out of range ends the walk, and
/// end_face_walk() notes it.
void step_face_walk(inout FaceWalk r_walk, inout uvec4 r_faces) {
	const bool is_valid = r_walk.next != 0u && r_faces.w == EDGE_COUNT_NO_FACE;
	const uvec2 node = load_count_node(r_walk.first_node + max(r_walk.next, 1u) - 1u);
	const bool overlaps = is_valid && (node.x & r_walk.cell) == r_walk.cell;
	r_faces = overlaps ? uvec4(node.x & EDGE_COUNT_FACE_MASK, r_faces.xyz) : r_faces;
	set_next_node(r_walk, is_valid ? node.y : r_walk.next);
}

bool is_in_face_walk(FaceWalk p_walk) {
	return p_walk.next != 0u && p_walk.steps_left > 0u;
}

void end_face_walk(FaceWalk p_walk) {
	const bool is_endless = p_walk.next != 0u && p_walk.steps_left == 0u;
	note_fault(is_endless || p_walk.max_next > p_walk.capacity, EDGE_COUNT_FAULT_FACE_LIST);
	note_fault(is_in_face_walk(p_walk), EDGE_COUNT_FAULT_LOOP);
}

/// Counts crossings of the faces that the receiver's texel lists. p_position: x' and y' of the receiver in its view.
/// Most faces of a list are in other cells. So first each invocation looks for up to four faces in its own cell, and
/// then all invocations test theirs together (Aila and Laine 2009, Understanding the Efficiency of Ray Traversal on
/// GPUs, section 3.1).
CountCrossings count_crossings(CountLightConstants p_light, uint p_view, vec2 p_position, CountReceiver p_receiver) {
	FaceWalk walk = start_face_walk(p_light, p_view, p_position);
	CountCrossings found = CountCrossings(0, 0, 0);
	while (is_in_face_walk(walk)) {
		uvec4 faces = uvec4(EDGE_COUNT_NO_FACE);
		do {
			// Two nodes per iteration, since llvmpipe ends every loop after an invocation has made 65535 iterations.
			step_face_walk(walk, faces);
			step_face_walk(walk, faces);
			--walk.steps_left;
		} while (is_in_face_walk(walk) && faces.w == EDGE_COUNT_NO_FACE);
		do {
			const bool is_valid = faces.x != EDGE_COUNT_NO_FACE;
			const uint face = is_valid ? faces.x : 0u; // load_count_face() and load_count_plane() limit it
			const vec4 plane = load_count_plane(face);
			const bool is_in_front = is_count_in_front(plane, p_receiver.position);
			if (is_valid && is_in_front != is_count_light_in_front(plane)) {
				count_face(p_receiver, load_count_face(face), is_in_front, found);
			}
			faces = uvec4(faces.yzw, EDGE_COUNT_NO_FACE);
		} while (faces.x != EDGE_COUNT_NO_FACE);
		note_fault(faces.x != EDGE_COUNT_NO_FACE, EDGE_COUNT_FAULT_LOOP);
	}
	end_face_walk(walk);
	return found;
}

int count_solids(CountLightConstants p_light, uint p_view, vec2 p_position, CountReceiver p_receiver) {
	return sum_crossings(count_crossings(p_light, p_view, p_position, p_receiver));
}

#endif
