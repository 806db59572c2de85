// Counts the edges of a block's pixels: what the resolve and its debug images share.
//
// Software drivers run a branch that nobody takes, and a loop's body once even where nobody enters it. So
// what is rare has a loop of its own behind the common case, and loops test at their ends.
#ifndef COUNT_RESOLVE_INC_GLSL
#define COUNT_RESOLVE_INC_GLSL

#include "shadow_edge_count/count_blocks_inc.glsl"
#include "shadow_edge_count/count_bundles_inc.glsl"
#include "shadow_edge_count/count_edge_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_RECEIVES) uniform utextureBuffer receives_buffer;
layout(set = 0, binding = COUNT_BINDING_CHAINS) uniform utextureBuffer chains_buffer;
layout(set = 0, binding = COUNT_BINDING_LISTS) uniform utextureBuffer lists_buffer;
layout(set = 0, binding = COUNT_BINDING_MASKS) uniform utextureBuffer masks_buffer;

layout(constant_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) const uint SUBGROUP_SIZE = 8u;
/// The blocks have no lists: each group of pixels goes through all bundles of the light.
layout(constant_id = EDGE_COUNT_CONSTANT_HAS_NO_LIST) const bool HAS_NO_LIST = false;

uvec2 load_count_mask(uint p_index) {
	return texelFetch(masks_buffer, int(p_index)).rg;
}

// Edges that some receiver of a subgroup may have to count, and what is known of them, in one word each: a slice
// for each subgroup.
const uint SLICE_SIZE = 64u;
shared uint chosen_edges[SLICE_SIZE * COUNT_GROUP_SIZE / 4];

/// One pixel: what it receives, and what was counted.
struct CountPixel {
	ivec2 pixel;
	uint edge_count; // that it counted
	float visibility; // 0 where it is no receiver
	int solid_count; // between it and the light's centre
};

/// Edges that a box's receivers may need.
struct CountChoice {
	uint next; // index in the list, or edge, from where to go on
	uint count;
};

/// Each invocation tests one edge. p_entry: the edge and what is known of it for the part.
void choose_edge(CountBox p_box, uint p_entry, bool p_is_there, inout CountChoice r_choice) {
	const CountEdgeRecord edge = load_count_edge(p_entry & COUNT_EDGE_MASK);
	const bool is_chosen = p_is_there &&
			is_edge_in_reach(p_box, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz));
	const uvec4 chosen = subgroupBallot(is_chosen);
	if (is_chosen) {
		chosen_edges[gl_SubgroupID * SLICE_SIZE + r_choice.count + subgroupBallotExclusiveBitCount(chosen)] =
				p_entry;
	}
	r_choice.count += subgroupBallotBitCount(chosen);
}

bool has_choice_room(CountChoice p_choice, uint p_more) {
	return p_choice.count + p_more <= SLICE_SIZE;
}

/// From the part's list, which has p_end edges. Ends where the slice may be full.
CountChoice choose_from_list(uint p_first, uint p_end, inout uint r_chunk, CountBox p_box) {
	const uint size = uint(EDGE_COUNT_CHUNK_SIZE);
	CountChoice choice = CountChoice(p_first, 0u);
	do {
		const uint index = choice.next + gl_SubgroupInvocationID;
		const bool is_there = index < p_end;
		const uint entry = texelFetch(lists_buffer, is_there ? int(r_chunk * size + index % size) : 0).r;
		choose_edge(p_box, is_there ? entry : 0u, is_there, choice);
		choice.next += SUBGROUP_SIZE;
		r_chunk = choice.next % size == 0u
				? texelFetch(lists_buffer, int(light.chunk_capacity * size + r_chunk)).r
				: r_chunk;
	} while (choice.next < p_end && has_choice_room(choice, SUBGROUP_SIZE));
	return choice;
}

/// p_index: of the edge in the bundle. p_end: edges of the light.
void choose_edge_of_bundle(CountBox p_box, uint p_bundle, uint p_index, uint p_end, inout CountChoice r_choice) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint edge = p_bundle * size + p_index;
	choose_edge(p_box, min(edge, p_end - 1u), p_index < size && edge < p_end, r_choice);
}

/// From all edges of the light, bundle by bundle. Edges p_first .. p_end, whole bundles.
CountChoice choose_from_bundles(uint p_first, uint p_end, CountBox p_box) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint bundle_count = find_bundle_count(p_end);
	CountChoice choice = CountChoice(p_first, 0u);
	do {
		const uint first_bundle = choice.next / size;
		const uint bundle = first_bundle + gl_SubgroupInvocationID;
		const bool is_wanted = bundle < bundle_count &&
				may_use_bundle(p_box, load_count_bundle(min(bundle, bundle_count - 1u)));
		uvec4 wanted = subgroupBallot(is_wanted);
		choice.next += SUBGROUP_SIZE * size;
		while (subgroupBallotBitCount(wanted) != 0u) {
			const uint lane = subgroupBallotFindLSB(wanted);
			if (has_choice_room(choice, size)) {
				wanted[lane / 32u] &= ~(1u << (lane & 31u));
				for (uint i = gl_SubgroupInvocationID; i - gl_SubgroupInvocationID < size; i += 2u * SUBGROUP_SIZE) {
					choose_edge_of_bundle(p_box, first_bundle + lane, i, p_end, choice);
					choose_edge_of_bundle(p_box, first_bundle + lane, i + SUBGROUP_SIZE, p_end, choice);
				}
			} else {
				choice.next = (first_bundle + lane) * size; // from here on the next time
				wanted = uvec4(0u);
			}
		}
	} while (choice.next < p_end && has_choice_room(choice, size));
	return choice;
}

/// False: the part of the edge that lies between a receiver and its disc hides nothing of it. Wider than
/// what count_add_edge does by more than rounding.
bool may_hide(vec3 p_receiver, vec3 p_to_light, vec3 p_a, vec3 p_b) {
	const float ROUNDING = 4e-6;
	const float radius = 1.001 * light.disc_radius;
	const vec3 a = p_a - p_receiver;
	const vec3 b = p_b - p_receiver;
	const float d_a = dot(p_to_light, a);
	const float d_b = dot(p_to_light, b);
	const float length_a = length(a);
	const float length_b = length(b);
	const float inverse = length(p_to_light);
	// The edge on the disc's plane goes along `way`, at least `aside` from the centre.
	const vec3 way = b * d_a - a * d_b;
	const float length_way = length(way);
	const float aside = abs(dot(p_to_light, cross(a, b)));
	const bool is_aside = aside > inverse * (radius * length_way + ROUNDING * length_a * length_b);
	const bool is_beyond = min(d_a, d_b) > 0.0 &&
			(dot(a, way) > length_way * (radius * d_a + ROUNDING * length_a) ||
					dot(b, way) < -length_way * (radius * d_b + ROUNDING * length_b));
	const bool is_below = max(d_a, d_b) <= 0.0;
	const bool is_above = light.is_directional == 0u && min(d_a, d_b) > 1.001;
	return !is_aside && !is_beyond && !is_below && !is_above;
}

/// Of a slice's edges those that the invocation's receiver has to count, a bit for each.
struct CountShare {
	uvec2 own;
	uvec2 is_negative; // its weight
	uvec2 is_twice;
};

/// The weight of an edge for a receiver, which the edge's list may know.
int find_weight(uint p_entry, CountReceiver p_receiver) {
	const CountEdgeRecord edge = load_count_edge(p_entry & COUNT_EDGE_MASK);
	const uint known = p_entry >> COUNT_KNOWN_SHIFT;
	return (known & COUNT_KNOWS_WEIGHT) != 0u
			? get_known_weight(known)
			: count_weight(p_receiver.position, load_count_plane0(edge), load_count_plane1(edge),
					  make_count_kind(edge.a_face0.w, edge.b_face1.w));
}

ivec4 find_weights(uvec4 p_entries, CountReceiver p_receiver) {
	return ivec4(find_weight(p_entries.x, p_receiver), find_weight(p_entries.y, p_receiver),
			find_weight(p_entries.z, p_receiver), find_weight(p_entries.w, p_receiver));
}

/// Adds one of the chosen edges if the receiver has to count it.
void share_edge(uint p_item, uint p_entry, int p_weight, CountReceiver p_receiver, inout CountShare r_share) {
	const CountEdgeRecord edge = load_count_edge(p_entry & COUNT_EDGE_MASK);
	const bool is_own = p_weight != 0 &&
			may_hide(p_receiver.position, p_receiver.to_light, uintBitsToFloat(edge.a_face0.xyz),
					uintBitsToFloat(edge.b_face1.xyz));
	const uint bit = is_own ? 1u << (p_item & 31u) : 0u;
	const uvec2 bits = p_item < 32u ? uvec2(bit, 0u) : uvec2(0u, bit);
	r_share.own |= bits;
	r_share.is_negative |= p_weight < 0 ? bits : uvec2(0u);
	r_share.is_twice |= abs(p_weight) == 2 ? bits : uvec2(0u);
}

/// One of the slice's edges, or one that adds nothing.
uint load_chosen(uint p_item, uint p_count) {
	return p_item < p_count ? chosen_edges[gl_SubgroupID * SLICE_SIZE + p_item]
							: COUNT_ADDS_NOTHING << COUNT_KNOWN_SHIFT;
}

/// Which of the chosen edges the invocation's receiver has to count. Each invocation reads all of them: to hand
/// on what another one has read takes software drivers longer. Four edges an iteration: llvmpipe ends
/// every loop once an invocation has made 65535 iterations, of all its loops together.
CountShare share_choice(uint p_count, bool p_is_here, CountReceiver p_receiver) {
	CountShare share = CountShare(uvec2(0u), uvec2(0u), uvec2(0u));
	for (uint i = 0u; i < p_count; i += 4u) {
		const uvec4 entries = uvec4(load_chosen(i, p_count), load_chosen(i + 1u, p_count),
				load_chosen(i + 2u, p_count), load_chosen(i + 3u, p_count));
		ivec4 weights = ivec4(get_known_weight(entries.x >> COUNT_KNOWN_SHIFT),
				get_known_weight(entries.y >> COUNT_KNOWN_SHIFT),
				get_known_weight(entries.z >> COUNT_KNOWN_SHIFT),
				get_known_weight(entries.w >> COUNT_KNOWN_SHIFT));
		const uint all_known = entries.x & entries.y & entries.z & entries.w;
		bool is_open = (all_known >> COUNT_KNOWN_SHIFT & COUNT_KNOWS_WEIGHT) == 0u;
		if (HAS_NO_LIST) { // no weight is known
			weights = find_weights(entries, p_receiver);
		} else {
			while (is_open) { // not a branch: software drivers run what a branch skips
				weights = find_weights(entries, p_receiver);
				is_open = false;
			}
		}
		weights = p_is_here ? weights : ivec4(0);
		share_edge(i, entries.x, weights.x, p_receiver, share);
		share_edge(i + 1u, entries.y, weights.y, p_receiver, share);
		share_edge(i + 2u, entries.z, weights.z, p_receiver, share);
		share_edge(i + 3u, entries.w, weights.w, p_receiver, share);
	}
	return share;
}

bool has_bit(uvec2 p_bits, uint p_place) {
	return ((p_place < 32u ? p_bits.x : p_bits.y) >> (p_place & 31u) & 1u) != 0u;
}

/// Counts the next of the edges that the invocation's receiver has, if there is one.
void count_next(CountReceiver p_receiver, CountShare p_share, inout uvec2 r_left, inout CountState r_state) {
	const bool is_there = (r_left.x | r_left.y) != 0u;
	const uint place = (r_left.x != 0u ? findLSB(r_left.x) : 32u + findLSB(r_left.y)) & (SLICE_SIZE - 1u);
	r_left = r_left.x != 0u ? uvec2(r_left.x & (r_left.x - 1u), r_left.y) : uvec2(0u, r_left.y & (r_left.y - 1u));
	const uint entry = is_there ? chosen_edges[gl_SubgroupID * SLICE_SIZE + place] : 0u;
	const CountEdgeRecord edge = load_count_edge(entry & COUNT_EDGE_MASK);
	const int weight = has_bit(p_share.is_twice, place) ? 2 : 1;
	count_add_edge(p_receiver, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz),
			is_there ? (has_bit(p_share.is_negative, place) ? -weight : weight) : 0, r_state);
}

/// Counts the edges that each invocation's receiver has, two an iteration.
void count_share(CountReceiver p_receiver, CountShare p_share, inout CountState r_state) {
	const uint most = subgroupMax(uint(count_points(p_share.own)));
	uvec2 left = p_share.own;
	for (uint i = 0u; i < most; i += 2u) {
		count_next(p_receiver, p_share, left, r_state);
		count_next(p_receiver, p_share, left, r_state);
	}
}

/// The bounds of those receivers of a subgroup that are in it.
CountBounds find_subgroup_bounds(CountPoint p_point, bool p_is_here, vec2 p_slope) {
	const float range = p_point.warped.z - dot(p_slope, p_point.warped.xy);
	return CountBounds(subgroupMin(p_is_here ? p_point.warped.xy : vec2(COUNT_FAR)),
			subgroupMax(p_is_here ? p_point.warped.xy : vec2(-COUNT_FAR)), p_slope,
			vec2(subgroupMin(p_is_here ? range : COUNT_FAR), subgroupMax(p_is_here ? range : -COUNT_FAR)));
}

/// Each invocation counts one of the block's pixels, which has its place there. p_parts: the first of the words of
/// EDGE_COUNT_RECEIVES_*. p_sorted_part: its receiver's, where they are sorted.
CountPixel count_pixel_of_block(uint p_block, uint p_parts, uvec2 p_pixel, uint p_sorted_part) {
	const bool is_sorted = (p_parts & EDGE_COUNT_IS_SORTED) != 0u;
	CountPixel result;
	result.pixel = ivec2(find_block_corner(p_block) + p_pixel);
	result.edge_count = 0u;
	const bool is_receiver = is_in_picture(result.pixel) && is_receiver_pixel(result.pixel);
	CountPoint point = CountPoint(vec3(0.0, 0.0, 1.0), 0u, vec3(0.0, 0.0, 1.0), vec2(0.0));
	if (is_receiver) {
		point = load_count_point(result.pixel);
	}
	const bool is_counted = is_receiver && may_count_at(point);
	const CountReceiver receiver = make_count_receiver(light, point.position);
	CountCrossings crossings = CountCrossings(0, 0, 0);
	if (is_counted) {
		crossings = count_crossings(light, VIEW_COUNT == 1u ? 0u : point.view, point.warped.xy, receiver);
	}
	const uint cut_face_count = is_counted ? find_cut_face_count() : 0u;
	for (uint i = 0u; i < cut_face_count; ++i) {
		const uint face = load_cut_face(i);
		const vec4 plane = load_count_plane(face);
		const bool is_before = is_count_before(plane, receiver.position);
		if (is_before != is_count_light_before(light.is_directional != 0u, plane)) {
			count_face(receiver, load_count_face(face), is_before, crossings);
		}
	}
	CountState state = make_count_state(sum_crossings(crossings));
	for (uint i = 0u; i < cut_face_count; ++i) {
		const uint face = load_cut_face(i);
		count_add_cut(receiver, load_count_face(face), load_count_plane(face), crossings.away >= crossings.toward, state);
	}
	const uint own_part = is_sorted ? p_sorted_part : point.view;
	bool waits = is_counted;
	while (subgroupAny(waits)) {
		// Those of one part: what lies between parts would make them ask for edges that none of them needs.
		const uint leader = subgroupBallotFindLSB(subgroupBallot(waits));
		const uint part = subgroupBroadcast(own_part, leader);
		const uint view = find_part_view(p_parts, part);
		const bool is_here = waits && own_part == part;
		const CountBox box = make_count_box(light, light.views[view],
				find_subgroup_bounds(point, is_here, subgroupBroadcast(point.slope, leader)));
		uint end = find_edge_count();
		uint chunk = 0u;
		if (!HAS_NO_LIST) {
			const uint chain = (p_block * PART_COUNT + part) * uint(EDGE_COUNT_CHAIN_WORDS);
			end = texelFetch(chains_buffer, int(chain + uint(EDGE_COUNT_CHAIN_COUNT))).r;
			chunk = texelFetch(chains_buffer, int(chain + uint(EDGE_COUNT_CHAIN_FIRST))).r;
		}
		uint next = 0u; // in the list
		while (next < end) {
			CountChoice choice;
			if (HAS_NO_LIST) {
				choice = choose_from_bundles(next, end, box);
			} else {
				choice = choose_from_list(next, end, chunk, box);
			}
			next = choice.next;
			subgroupMemoryBarrierShared();
			subgroupBarrier();
			const CountShare share = share_choice(choice.count, is_here, receiver);
			count_share(receiver, share, state);
			result.edge_count += uint(count_points(share.own));
			subgroupMemoryBarrierShared();
			subgroupBarrier();
		}
		waits = waits && !is_here;
	}
	result.solid_count = state.solid_count;
	result.visibility = is_counted ? count_resolve(state) : (is_receiver ? 1.0 : 0.0);
	return result;
}

/// The invocation's place among those of the work group.
uint find_place() {
	return gl_SubgroupID * SUBGROUP_SIZE + gl_SubgroupInvocationID;
}

/// Each invocation counts one pixel of the work group's block.
CountPixel count_pixel() {
	const uint block = find_block();
	const int receives = int(block * uint(EDGE_COUNT_RECEIVES_WORDS));
	const uint parts = texelFetch(receives_buffer, receives + EDGE_COUNT_RECEIVES_PARTS).r;
	const uint place = find_place();
	const uint order = texelFetch(receives_buffer, receives + EDGE_COUNT_RECEIVES_ORDER + int(place / 4u)).r;
	const uint own_order = order >> (8u * (place % 4u)) & 0xffu;
	const uint index = (parts & EDGE_COUNT_IS_SORTED) != 0u ? own_order & EDGE_COUNT_ORDER_PIXEL_MASK : place;
	return count_pixel_of_block(block, parts, find_pixel_in_block(index), own_order >> EDGE_COUNT_ORDER_PART_SHIFT);
}

#endif
