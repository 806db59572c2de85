// Counts the edges of a block's pixels: what the resolve and its debug images share.
//
// Software drivers run a branch that nobody takes, and a loop's body once even where nobody enters it. So
// what is rare has a loop of its own behind the common case, and loops test at their ends.
#ifndef COUNT_RESOLVE_INC_GLSL
#define COUNT_RESOLVE_INC_GLSL

#include "shadow_edge_count/count_blocks_inc.glsl"
#include "shadow_edge_count/count_bundles_inc.glsl"
#include "shadow_edge_count/count_edge_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_ENDS) uniform utextureBuffer ends_buffer;
layout(set = 0, binding = COUNT_BINDING_LISTS) uniform utextureBuffer lists_buffer;
layout(set = 0, binding = COUNT_BINDING_MASKS) uniform utextureBuffer masks_buffer;

/// The blocks have no lists: each group of pixels goes through all bundles of the light.
layout(constant_id = EDGE_COUNT_CONSTANT_HAS_NO_LIST) const bool HAS_NO_LIST = false;

uvec2 load_count_mask(uint p_index) {
	return texelFetch(masks_buffer, int(p_index)).rg;
}

// Edges that a subgroup has to count, and what is known of them, in one word each. Each
// subgroup has a slice; common ones stand at its begin, the others at its end.
const uint CHOSEN_PER_INVOCATION = 32u;
shared uint chosen_edges[CHOSEN_PER_INVOCATION * MAP_RESOLVE_GROUP_SIZE * MAP_RESOLVE_GROUP_SIZE];

/// One pixel: what it receives, and what was counted.
struct CountPixel {
	ivec2 pixel;
	uint edge_count; // that its subgroup looked at
	float visibility; // 0 where it is no receiver
	int solid_count; // between it and the light's centre
};

/// Pixels of a work group so that those of a subgroup lie close together: 4 x 2, 8 x 4 or 8 x 8.
uvec2 find_count_place() {
	const uint index = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
	const uint x = (index & 1u) | ((index >> 1) & 2u) | ((index >> 2) & 4u);
	const uint y = ((index >> 1) & 1u) | ((index >> 2) & 2u) | ((index >> 3) & 4u);
	return uvec2(x, y);
}

/// Edges that any of a box's receivers needs: numbers of common and of other ones.
struct CountChoice {
	uint next; // index in the list, or edge, from where to go on
	uint common_count;
	uint other_count;
};

/// Each invocation tests one edge. p_entry: the edge and what is known of it for the block.
void choose_edge(CountBox p_box, uint p_entry, bool p_is_there, inout CountChoice r_choice) {
	const uint slice_size = CHOSEN_PER_INVOCATION * gl_SubgroupSize;
	const uint slice = gl_SubgroupID * slice_size;
	const CountEdgeRecord edge = load_count_edge(p_entry & COUNT_EDGE_MASK);
	const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
	const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
	uint known = p_entry >> COUNT_KNOWN_SHIFT;
	bool is_used = p_is_there && is_edge_in_reach(p_box, a, b);
	const uint common_known = COUNT_KNOWS_WEIGHT | COUNT_IS_BEFORE_LIGHT;
	bool is_unknown = is_used && (known & common_known) != common_known;
	while (is_unknown) { // not a branch
		const uint weight = find_known_weight(p_box, make_count_kind(edge.a_face0.w, edge.b_face1.w),
				load_count_plane0(edge), load_count_plane1(edge));
		const ivec2 sides = ivec2(find_light_side(p_box, a), find_light_side(p_box, b));
		known = weight | (min(sides.x, sides.y) > 0 ? COUNT_IS_BEFORE_LIGHT : 0u);
		is_used = max(sides.x, sides.y) >= 0;
		is_unknown = false;
	}
	is_used = is_used && (known & ~COUNT_IS_BEFORE_LIGHT) != COUNT_ADDS_NOTHING;
	const bool is_common = (known & common_known) == common_known;
	const uvec4 common_edges = subgroupBallot(is_used && is_common);
	const uvec4 other_edges = subgroupBallot(is_used && !is_common);
	if (is_used) {
		const uint at = is_common ? r_choice.common_count + subgroupBallotExclusiveBitCount(common_edges)
								  : slice_size - 1u - r_choice.other_count -
						subgroupBallotExclusiveBitCount(other_edges);
		chosen_edges[slice + at] = (p_entry & COUNT_EDGE_MASK) | known << COUNT_KNOWN_SHIFT;
	}
	r_choice.common_count += subgroupBallotBitCount(common_edges);
	r_choice.other_count += subgroupBallotBitCount(other_edges);
}

bool has_choice_room(CountChoice p_choice, uint p_more) {
	return p_choice.common_count + p_choice.other_count + p_more <= CHOSEN_PER_INVOCATION * gl_SubgroupSize;
}

/// From the block's list. Ends where the slice may be full.
CountChoice choose_from_list(uint p_first, uint p_end, CountBox p_box) {
	CountChoice choice = CountChoice(p_first, 0u, 0u);
	do {
		const uint place = choice.next + gl_SubgroupInvocationID;
		const uint entry = texelFetch(lists_buffer, int(min(place, p_end - 1u))).r;
		choose_edge(p_box, entry, place < p_end, choice);
		choice.next += gl_SubgroupSize;
	} while (choice.next < p_end && has_choice_room(choice, gl_SubgroupSize));
	return choice;
}

/// From all edges of the light, bundle by bundle. Edges p_first .. p_end, whole bundles.
CountChoice choose_from_bundles(uint p_first, uint p_end, CountBox p_box) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint bundle_count = find_bundle_count(p_end);
	CountChoice choice = CountChoice(p_first, 0u, 0u);
	do {
		const uint first_bundle = choice.next / size;
		const uint bundle = first_bundle + gl_SubgroupInvocationID;
		const bool is_wanted = bundle < bundle_count &&
				may_use_bundle(p_box, load_count_bundle(min(bundle, bundle_count - 1u)));
		uvec4 wanted = subgroupBallot(is_wanted);
		choice.next += gl_SubgroupSize * size;
		while (subgroupBallotBitCount(wanted) != 0u) {
			const uint lane = subgroupBallotFindLSB(wanted);
			if (has_choice_room(choice, size + gl_SubgroupSize)) {
				wanted[lane / 32u] &= ~(1u << (lane & 31u));
				for (uint i = 0u; i < size; i += gl_SubgroupSize) {
					const uint edge = (first_bundle + lane) * size + i + gl_SubgroupInvocationID;
					choose_edge(p_box, min(edge, p_end - 1u),
							i + gl_SubgroupInvocationID < size && edge < p_end, choice);
				}
			} else {
				choice.next = (first_bundle + lane) * size; // from here on the next time
				wanted = uvec4(0u);
			}
		}
	} while (choice.next < p_end && has_choice_room(choice, size + gl_SubgroupSize));
	return choice;
}

/// One common edge. p_is_there: the invocation counts one.
void count_common(CountReceiver p_receiver, uint p_chosen, bool p_is_there, inout CountState r_state) {
	const CountEdgeRecord edge = load_count_edge(p_chosen & COUNT_EDGE_MASK);
	const int weight = p_is_there ? get_known_weight(p_chosen >> COUNT_KNOWN_SHIFT) : 0;
	count_add_edge(p_receiver, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz), weight,
			false, r_state);
}

/// One of which receivers see different weights, or which may lie behind the light.
void count_other(CountReceiver p_receiver, uint p_chosen, bool p_is_there, inout CountState r_state) {
	const CountEdgeRecord edge = load_count_edge(p_chosen & COUNT_EDGE_MASK);
	const int seen = count_weight(p_receiver, load_count_plane0(edge), load_count_plane1(edge),
			make_count_kind(edge.a_face0.w, edge.b_face1.w));
	const int weight = p_is_there ? seen : 0;
	count_add_edge(p_receiver, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz), weight,
			light.is_directional == 0u, r_state);
}

/// The edges p_first .. p_end of a list, or of the light, counted by those invocations of a subgroup whose
/// receivers are in the box.
uint count_edges(uint p_first, uint p_end, CountBox p_box, bool p_is_here, CountReceiver p_receiver,
		inout CountState r_state) {
	const uint slice_size = CHOSEN_PER_INVOCATION * gl_SubgroupSize;
	const uint slice = gl_SubgroupID * slice_size;
	uint edge_count = 0u;
	uint next = p_first;
	do {
		CountChoice choice;
		if (HAS_NO_LIST) {
			choice = choose_from_bundles(next, p_end, p_box);
		} else {
			choice = choose_from_list(next, p_end, p_box);
		}
		subgroupMemoryBarrierShared();
		subgroupBarrier();
		next = choice.next;
		uint i = 0u;
		do {
			const uint chosen = chosen_edges[slice + i];
			count_common(p_receiver, chosen, p_is_here && i < choice.common_count, r_state);
			++i;
		} while (i < choice.common_count);
		i = 0u;
		do {
			const uint chosen = chosen_edges[slice + slice_size - 1u - i];
			count_other(p_receiver, chosen, p_is_here && i < choice.other_count, r_state);
			++i;
		} while (i < choice.other_count);
		edge_count += choice.common_count + choice.other_count;
		subgroupMemoryBarrierShared();
		subgroupBarrier();
	} while (next < p_end);
	return edge_count;
}

/// The bounds of those receivers of a subgroup that are in it.
CountBounds find_subgroup_bounds(CountPoint p_point, bool p_is_here, vec2 p_slope) {
	const float range = p_point.warped.z - dot(p_slope, p_point.warped.xy);
	return CountBounds(subgroupMin(p_is_here ? p_point.warped.xy : vec2(COUNT_FAR)),
			subgroupMax(p_is_here ? p_point.warped.xy : vec2(-COUNT_FAR)), p_slope,
			vec2(subgroupMin(p_is_here ? range : COUNT_FAR), subgroupMax(p_is_here ? range : -COUNT_FAR)));
}

CountPixel count_pixel() {
	const float GROUP_SIZES = 0.05; // of S
	const uint block = find_block();
	CountPixel result;
	result.pixel = ivec2(find_block_group(block) + find_count_place());
	result.edge_count = 0u;
	const bool is_receiver = is_in_picture(result.pixel) && is_receiver_pixel(result.pixel);
	CountPoint point = CountPoint(vec3(0.0, 0.0, 1.0), 0u, vec3(0.0, 0.0, 1.0), vec2(0.0));
	if (is_receiver) {
		point = load_count_point(result.pixel);
	}
	const bool is_counted = is_receiver && may_count_at(point);
	const CountReceiver receiver = make_count_receiver(light, point.position);
	bool waits = is_counted;
	CountState state = make_count_state(
			is_counted ? count_solids(light, VIEW_COUNT == 1u ? 0u : point.view, point.warped.xy, receiver) : 0);
	const uint first_end = block * uint(EDGE_COUNT_ENDS_PER_BLOCK);
	const uint list = HAS_NO_LIST ? 0u : texelFetch(ends_buffer, int(first_end)).r;
	do {
		// Those beside the first one: where pixels lie far apart, as beside an object's outline, what
		// is between them would make a group of them ask for many edges that none of them needs.
		const bool is_any = subgroupAny(waits);
		const uint leader = is_any ? subgroupBallotFindLSB(subgroupBallot(waits)) : 0u;
		const uint view = VIEW_COUNT == 1u ? 0u : subgroupBroadcast(point.view, leader);
		const vec3 away = point.position - subgroupBroadcast(point.position, leader);
		const float widest = GROUP_SIZES * light.scene_size_m;
		const bool is_here = waits && point.view == view && dot(away, away) <= widest * widest;
		const CountBox box = make_count_box(light, light.views[view],
				find_subgroup_bounds(point, is_here, subgroupBroadcast(point.slope, leader)));
		uint begin = 0u;
		uint end = 0u;
		if (HAS_NO_LIST) {
			end = find_edge_count();
		} else {
			end = list + texelFetch(ends_buffer, int(first_end + 1u + view)).r;
			begin = view == 0u ? list : list + texelFetch(ends_buffer, int(first_end + view)).r;
		}
		result.edge_count +=
				count_edges(begin, is_any ? end : begin, box, is_here, receiver, state);
		waits = waits && !is_here;
	} while (subgroupAny(waits));
	result.solid_count = state.solid_count;
	result.visibility = is_counted ? count_resolve(state) : (is_receiver ? 1.0 : 0.0);
	return result;
}

#endif
