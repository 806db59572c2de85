// Whether solids are between the receivers of one part of a block and the light's centre, without a test of each
// receiver.
#ifndef BOX_SOLIDS_INC_GLSL
#define BOX_SOLIDS_INC_GLSL

#include "shadow_edge_count/count_box_inc.glsl"
#include "shadow_edge_count/count_lists_inc.glsl"

// Flags of a part without edges. MAY_VARY: a face may separate its receivers.
const uint SOME_ARE_LIT = 1u;
const uint SOME_ARE_DARK = 2u;
const uint MAY_VARY = 4u;

// Limit of steps through lists of faces. High enough that usual scenes do not reach it with any size of the map, so
// that the kind of a block does not depend on the map. Low enough that the views of an omni light stay below llvmpipe's
// limit of iterations.
const uint MAX_STEPS = 2048u;
uint step_count = 0u; // since the includer last set it to 0

/// True if the whole face is in front of all receivers of the box, towards the light, or behind all of them, or if
/// they see another level of detail. Then it does not pass between them, so only its edges can make their numbers of
/// solids differ.
bool is_face_irrelevant(CountBox p_box, uint p_face) {
	const CountFaceRecord face = load_count_face(p_face);
	const vec3 a = uintBitsToFloat(face.a_kind.xyz);
	const vec3 b = uintBitsToFloat(face.b_first_distance.xyz);
	const vec3 c = uintBitsToFloat(face.c_end_distance.xyz);
	const float min_in_front =
			min(find_linear(p_box.below, a), min(find_linear(p_box.below, b), find_linear(p_box.below, c)));
	const float max_behind =
			max(find_linear(p_box.above, a), max(find_linear(p_box.above, b), find_linear(p_box.above, c)));
	return min_in_front > p_box.margin || max_behind < -p_box.margin ||
			!is_in_distance_range(p_box.distances.x, face);
}

/// True if no face that the texels p_first..p_last list can separate receivers of the box: all are on the same side of
/// its plane, or the face is entirely in front of them or behind them. False if the test takes too many steps, or if the
/// driver ends the loop.
bool has_no_separating_face(CountBox p_box, uint p_view, uvec2 p_first, uvec2 p_last) {
	uvec2 texel = p_first;
	uint next = load_count_first_node(p_view, texel);
	const uint end = step_count + MAX_STEPS;
	bool is_one_sided = true;
	// A single loop over all lists, since each loop takes as many iterations as its slowest invocation.
	while (texel.y <= p_last.y && is_one_sided) {
		const bool is_listed = next <= light.node_capacity;
		note_fault(!is_listed, EDGE_COUNT_FAULT_FACE_LIST);
		const uvec2 node = load_count_node(p_view * light.node_capacity + (is_listed ? max(next, 1u) - 1u : 0u));
		const uint face = node.x & EDGE_COUNT_FACE_MASK;
		const vec4 plane = load_count_plane(face);
		const bool is_known =
				next == 0u || find_count_side(p_box, plane) != 0 || is_face_irrelevant(p_box, face);
		is_one_sided = is_known && is_listed && step_count < end;
		const bool is_end = next == 0u || node.y == 0u;
		const bool is_row_end = is_end && texel.x == p_last.x;
		texel.x = is_row_end ? p_first.x : (is_end ? texel.x + 1u : texel.x);
		texel.y += is_row_end ? 1u : 0u;
		next = is_end ? load_count_first_node(p_view, min(texel, p_last)) : node.y;
		++step_count;
	}
	return is_one_sided && texel.y > p_last.y;
}

/// A flag, SOME_ARE_LIT or the following, for the receivers of one part if they need no edge: then the number of solids
/// in front of the light's centre changes only across a face. p_distance: of the part.
uint find_box_solids(uint p_view, float p_distance, CountBounds p_bounds) {
	const CountViewConstants view = load_count_view(p_view);
	CountBox box = make_count_box(light, view, p_bounds);
	box.distances = vec2(p_distance);
	const vec2 minimum = box.center - box.half_size;
	const vec2 maximum = box.center + box.half_size;
	const bool is_inside = all(greaterThanEqual(minimum, -view.half_extent)) &&
			all(lessThanEqual(maximum, view.half_extent));
	const bool is_even = is_inside &&
			has_no_separating_face(box, p_view, find_count_texel(p_view, minimum), find_count_texel(p_view, maximum));
	// A receiver in the middle of the box.
	const float w = dot(box.slope, box.center) + box.range.x;
	const vec3 in_view = IS_DIRECTIONAL ? vec3(box.center, light.depth_far_m - w) : vec3(box.center, 1.0) / w;
	const vec3 position = in_view.x * view.axis_x.xyz + in_view.y * view.axis_y.xyz + in_view.z * view.axis_z.xyz;
	if (!is_even) {
		return MAY_VARY;
	}
	const int solids = count_solids(light, p_view, box.center, make_count_receiver(light, position, p_distance));
	return solids == 0 ? SOME_ARE_LIT : SOME_ARE_DARK;
}

#endif
