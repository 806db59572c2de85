// Counts the edges of a block's pixels: what the resolve and its debug images share.
//
// llvmpipe runs a branch that no invocation takes, and a loop's body once even where no invocation enters it. So loops
// test at their ends; their first iteration does no harm where there is nothing to do.
#ifndef COUNT_RESOLVE_INC_GLSL
#define COUNT_RESOLVE_INC_GLSL

#include "shadow_edge_count/count_blocks_inc.glsl"
#include "shadow_edge_count/count_bundles_inc.glsl"
#include "shadow_edge_count/count_edge_inc.glsl"

layout(std430, set = 0, binding = COUNT_BINDING_RECEIVES) readonly buffer Receives {
	uint receives[]; // of each block, EDGE_COUNT_RECEIVES_*
};
layout(std430, set = 0, binding = COUNT_BINDING_CHAINS) readonly buffer Chains {
	uint chains[]; // of each block and part, EDGE_COUNT_CHAIN_*
};
FETCHED_UINTS(COUNT_BINDING_LISTS, lists_buffer);
layout(set = 0, binding = COUNT_BINDING_MASKS) uniform utextureBuffer masks_buffer;

layout(constant_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) const uint FULL_SUBGROUP_SIZE = 8u;
/// Invocations that there are: a work group may be smaller than a subgroup of the device.
const uint SUBGROUP_SIZE =
		FULL_SUBGROUP_SIZE < uint(COUNT_GROUP_SIZE) ? FULL_SUBGROUP_SIZE : uint(COUNT_GROUP_SIZE);
#include "common/subgroup_inc.glsl"
/// The blocks have no lists: each group of pixels goes through all bundles of the light.
layout(constant_id = EDGE_COUNT_CONSTANT_HAS_NO_LIST) const bool HAS_NO_LIST = false;

uvec4 load_count_masks(uint p_index, uint p_pair) {
	return texelFetch(masks_buffer, int(p_index * uint((COUNT_TURN_COUNT + 1) / 2) + p_pair));
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
	const uvec4 chosen = subgroup_ballot(is_chosen);
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
		const uint entry = FETCH_UINT(lists_buffer, is_there ? int(r_chunk * size + index % size) : 0);
		choose_edge(p_box, is_there ? entry : 0u, is_there, choice);
		choice.next += SUBGROUP_SIZE;
		r_chunk = choice.next % size == 0u
				? FETCH_UINT(lists_buffer, light.chunk_capacity * size + r_chunk)
				: r_chunk;
	} while (choice.next < p_end && has_choice_room(choice, SUBGROUP_SIZE));
	return choice;
}

/// p_index: of the edge in the bundle. p_end: edges of the light.
void choose_edge_of_bundle(CountBox p_box, uint p_bundle, uint p_index, uint p_end, inout CountChoice r_choice) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint edge = p_bundle * size + p_index;
	const bool is_there = p_index < size && edge < p_end;
	choose_edge(p_box, is_there ? edge : 0u, is_there, r_choice);
}

/// From all edges of the light, bundle by bundle. Edges p_first .. p_end, whole bundles.
CountChoice choose_from_bundles(uint p_first, uint p_end, CountBox p_box) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint bundle_count = find_bundle_count(p_end);
	CountChoice choice = CountChoice(p_first, 0u);
	do {
		const uint first_bundle = choice.next / size;
		const uint bundle = first_bundle + gl_SubgroupInvocationID;
		const bool is_needed = bundle < bundle_count &&
				may_use_bundle(p_box, load_count_bundle(bundle < bundle_count ? bundle : 0u));
		uvec4 needed = subgroup_ballot(is_needed);
		choice.next += SUBGROUP_SIZE * size;
		do {
			const bool is_there = subgroupBallotBitCount(needed) != 0u;
			const uint lane = is_there ? subgroupBallotFindLSB(needed) : 0u;
			const bool has_room = has_choice_room(choice, size);
			if (is_there && !has_room) {
				choice.next = (first_bundle + lane) * size; // from here on the next time
			}
			needed[lane / 32u] &= ~(1u << (lane & 31u));
			needed = has_room ? needed : uvec4(0u);
			const uint end = is_there && has_room ? p_end : 0u;
			uint i = gl_SubgroupInvocationID;
			do {
				choose_edge_of_bundle(p_box, first_bundle + lane, i, end, choice);
				choose_edge_of_bundle(p_box, first_bundle + lane, i + SUBGROUP_SIZE, end, choice);
				choose_edge_of_bundle(p_box, first_bundle + lane, i + 2u * SUBGROUP_SIZE, end, choice);
				choose_edge_of_bundle(p_box, first_bundle + lane, i + 3u * SUBGROUP_SIZE, end, choice);
				i += 4u * SUBGROUP_SIZE;
			} while (4u * SUBGROUP_SIZE < size && i - gl_SubgroupInvocationID < size);
		} while (subgroupBallotBitCount(needed) != 0u);
	} while (choice.next < p_end && has_choice_room(choice, size));
	return choice;
}

/// False: the part of the edge that is between a receiver and its disc hides nothing of it. Wider than
/// what find_edge_sector does by more than rounding.
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

// A slice is counted in rounds of so many edges. Each invocation holds at most four of them, and hands them on to those
// that test or count them: software drivers take longer to read what all invocations need.
const uint ROUND_SIZE = SUBGROUP_SIZE < 8u ? 4u * SUBGROUP_SIZE : 32u;
const uint HELD_AT_ONCE = SUBGROUP_SIZE < 32u ? SUBGROUP_SIZE : 32u; // edges that one variable of all invocations holds

/// What the list of an edge knows of it, and its ends.
struct HeldEdge {
	uint entry;
	vec3 a;
	vec3 b;
};

/// Edges i x HELD_AT_ONCE .. (i + 1) x HELD_AT_ONCE of a round in part i.
struct HeldRound {
	HeldEdge part0;
	HeldEdge part1;
	HeldEdge part2;
	HeldEdge part3;
};

/// Of a round's edges those that the invocation's receiver has to count, a bit for each.
struct CountShare {
	uint own;
	uint is_negative; // its weight
	uint is_twice;
};

/// One of the slice's edges from p_first on, or one that adds nothing.
HeldEdge hold_edge(uint p_first, uint p_end) {
	const uint item = p_first + gl_SubgroupInvocationID;
	const uint entry = item < p_end ? chosen_edges[gl_SubgroupID * SLICE_SIZE + item]
									: COUNT_ADDS_NOTHING << COUNT_KNOWN_SHIFT;
	const CountEdgeRecord edge = load_count_edge(entry & COUNT_EDGE_MASK);
	return HeldEdge(entry, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz));
}

HeldEdge hand_on(HeldEdge p_held, uint p_lane) {
	return HeldEdge(subgroupShuffle(p_held.entry, p_lane), subgroupShuffle(p_held.a, p_lane),
			subgroupShuffle(p_held.b, p_lane));
}

/// Adds one of the held edges if the receiver may have to count it; its weight, if the list knows that.
void share_edge(HeldEdge p_held, uint p_lane, uint p_first_slot, CountReceiver p_receiver, inout CountShare r_share) {
	const HeldEdge edge = hand_on(p_held, p_lane);
	const uint known = edge.entry >> COUNT_KNOWN_SHIFT;
	const int weight = (known & COUNT_KNOWS_WEIGHT) != 0u ? get_known_weight(known) : 0;
	const bool is_own = known != COUNT_ADDS_NOTHING && may_hide(p_receiver.position, p_receiver.to_light, edge.a, edge.b);
	const uint bit = is_own ? 1u << (p_first_slot + p_lane) : 0u;
	r_share.own |= bit;
	r_share.is_negative |= weight < 0 ? bit : 0u;
	r_share.is_twice |= abs(weight) == 2 ? bit : 0u;
}

/// What decides the weight of an edge; see count_weight.
struct HeldFaces {
	uvec2 words;
	vec4 plane0;
	vec4 plane1;
};

/// The weight of a held edge as the receiver sees it, where the list does not know it.
void share_weight(HeldEdge p_held, HeldFaces p_faces, uint p_lane, uint p_first_slot, CountReceiver p_receiver,
		inout CountShare r_share) {
	const uvec2 words = subgroupShuffle(p_faces.words, p_lane);
	const int weight = count_weight(p_receiver.position, subgroupShuffle(p_faces.plane0, p_lane),
			subgroupShuffle(p_faces.plane1, p_lane), make_count_kind(words.x, words.y));
	const uint known = subgroupShuffle(p_held.entry, p_lane) >> COUNT_KNOWN_SHIFT;
	const uint bit = (known & COUNT_KNOWS_WEIGHT) == 0u ? 1u << (p_first_slot + p_lane) : 0u;
	r_share.own &= ~(weight == 0 ? bit : 0u);
	r_share.is_negative |= weight < 0 ? bit : 0u;
	r_share.is_twice |= abs(weight) == 2 ? bit : 0u;
}

HeldEdge choose_held(bool p_is_second, HeldEdge p_first, HeldEdge p_second) {
	return HeldEdge(p_is_second ? p_second.entry : p_first.entry, p_is_second ? p_second.a : p_first.a,
			p_is_second ? p_second.b : p_first.b);
}

HeldEdge get_part(HeldRound p_held, uint p_part) {
	const HeldEdge low = choose_held(p_part == 1u, p_held.part0, p_held.part1);
	const HeldEdge high = choose_held(p_part == 3u, p_held.part2, p_held.part3);
	return choose_held(p_part >= 2u, low, high);
}

/// Tests edges p_lane .. p_lane + 3 of a part of a round, which have the slots from p_first_slot + p_lane on.
void share_four(HeldEdge p_held, uint p_lane, uint p_first_slot, CountReceiver p_receiver, inout CountShare r_share) {
	share_edge(p_held, p_lane, p_first_slot, p_receiver, r_share);
	share_edge(p_held, p_lane + 1u, p_first_slot, p_receiver, r_share);
	share_edge(p_held, p_lane + 2u, p_first_slot, p_receiver, r_share);
	share_edge(p_held, p_lane + 3u, p_first_slot, p_receiver, r_share);
}

void share_four_weights(HeldEdge p_held, HeldFaces p_faces, uint p_lane, uint p_first_slot, CountReceiver p_receiver,
		inout CountShare r_share) {
	share_weight(p_held, p_faces, p_lane, p_first_slot, p_receiver, r_share);
	share_weight(p_held, p_faces, p_lane + 1u, p_first_slot, p_receiver, r_share);
	share_weight(p_held, p_faces, p_lane + 2u, p_first_slot, p_receiver, r_share);
	share_weight(p_held, p_faces, p_lane + 3u, p_first_slot, p_receiver, r_share);
}

/// Edges of a part of a round that has p_count.
uint find_held_count(uint p_part, uint p_count) {
	return min(p_count - min(p_count, p_part * HELD_AT_ONCE), HELD_AT_ONCE);
}

// The edges that one iteration tests: llvmpipe ends every loop once an invocation has made 65535 iterations, of all its
// loops together.
const uint SHARED_AT_ONCE = HELD_AT_ONCE < 8u ? 4u : 8u;

/// Takes a round of the slice's edges, p_first and p_count - 1 more, and finds those that the receiver has to count.
/// r_held: parts that the round does not have stay as they were; no bit of the share is theirs.
CountShare share_round(uint p_first, uint p_count, CountReceiver p_receiver, inout HeldRound r_held) {
	CountShare share = CountShare(0u, 0u, 0u);
	uint open_parts = 0u; // that have an edge whose weight the list does not know
	uint part = 0u;
	do {
		const HeldEdge held = hold_edge(p_first + part * HELD_AT_ONCE, p_first + p_count);
		r_held.part0 = choose_held(part == 0u, r_held.part0, held);
		r_held.part1 = choose_held(part == 1u, r_held.part1, held);
		r_held.part2 = choose_held(part == 2u, r_held.part2, held);
		r_held.part3 = choose_held(part == 3u, r_held.part3, held);
		uint i = 0u;
		do {
			share_four(held, i, part * HELD_AT_ONCE, p_receiver, share);
			if (SHARED_AT_ONCE == 8u) {
				share_four(held, i + 4u, part * HELD_AT_ONCE, p_receiver, share);
			}
			i += SHARED_AT_ONCE;
		} while (HELD_AT_ONCE > SHARED_AT_ONCE && i < find_held_count(part, p_count));
		open_parts |= subgroup_any((held.entry >> COUNT_KNOWN_SHIFT & COUNT_KNOWS_WEIGHT) == 0u) ? 1u << part : 0u;
		++part;
	} while (part * HELD_AT_ONCE < p_count);
	do {
		part = open_parts != 0u ? uint(findLSB(open_parts)) : 0u; // without any the weights are all known
		open_parts &= open_parts - 1u;
		const HeldEdge held = get_part(r_held, part);
		const CountEdgeRecord edge = load_count_edge(held.entry & COUNT_EDGE_MASK);
		const HeldFaces faces = HeldFaces(
				uvec2(edge.a_face0.w, edge.b_face1.w), load_count_plane0(edge), load_count_plane1(edge));
		uint i = 0u;
		do {
			share_four_weights(held, faces, i, part * HELD_AT_ONCE, p_receiver, share);
			if (SHARED_AT_ONCE == 8u) {
				share_four_weights(held, faces, i + 4u, part * HELD_AT_ONCE, p_receiver, share);
			}
			i += SHARED_AT_ONCE;
		} while (HELD_AT_ONCE > SHARED_AT_ONCE && i < find_held_count(part, p_count));
	} while (open_parts != 0u);
	return share;
}

/// What the next of the edges that the invocation's receiver has adds, if there is one.
CountSector find_next_sector(HeldRound p_held, CountReceiver p_receiver, CountShare p_share, inout uint r_left) {
	const bool is_there = r_left != 0u;
	const uint slot = uint(findLSB(r_left)) & 31u;
	r_left &= r_left - 1u;
	const uint lane = slot % HELD_AT_ONCE;
	HeldEdge edge = hand_on(p_held.part0, lane);
	if (ROUND_SIZE > HELD_AT_ONCE) {
		edge = choose_held((slot & HELD_AT_ONCE) != 0u, edge, hand_on(p_held.part1, lane));
	}
	if (ROUND_SIZE > 2u * HELD_AT_ONCE) {
		const HeldEdge other = choose_held(
				(slot & HELD_AT_ONCE) != 0u, hand_on(p_held.part2, lane), hand_on(p_held.part3, lane));
		edge = choose_held((slot & 2u * HELD_AT_ONCE) != 0u, edge, other);
	}
	const int weight = (p_share.is_twice >> slot & 1u) != 0u ? 2 : 1;
	return find_edge_sector(p_receiver, edge.a, edge.b,
			is_there ? ((p_share.is_negative >> slot & 1u) != 0u ? -weight : weight) : 0);
}

/// Counts the next two edges of each invocation's receiver, one behind the other, so that processors deal with both at
/// once.
void count_two(HeldRound p_held, CountReceiver p_receiver, CountShare p_share, inout uint r_left,
		inout CountState r_state) {
	const CountSector first = find_next_sector(p_held, p_receiver, p_share, r_left);
	const CountSector second = find_next_sector(p_held, p_receiver, p_share, r_left);
	count_sectors(first, second, r_state);
}

/// Counts the edges that each invocation's receiver has.
void count_share(HeldRound p_held, CountReceiver p_receiver, CountShare p_share, inout CountState r_state) {
	const uint most = subgroup_max(uint(bitCount(p_share.own)));
	uint left = p_share.own;
	uint i = 0u;
	do {
		count_two(p_held, p_receiver, p_share, left, r_state);
		if (HAS_NO_LIST) { // fewer iterations: see SHARED_AT_ONCE
			count_two(p_held, p_receiver, p_share, left, r_state);
		}
		i += HAS_NO_LIST ? 4u : 2u;
	} while (i < most);
}

/// The bounds of those receivers of a subgroup that are in it.
CountBounds find_subgroup_bounds(CountPoint p_point, bool p_is_here, vec2 p_slope) {
	const float range = p_point.warped.z - dot(p_slope, p_point.warped.xy);
	return CountBounds(subgroup_min(p_is_here ? p_point.warped.xy : vec2(COUNT_FAR)),
			subgroup_max(p_is_here ? p_point.warped.xy : vec2(-COUNT_FAR)), p_slope,
			vec2(subgroup_min(p_is_here ? range : COUNT_FAR), subgroup_max(p_is_here ? range : -COUNT_FAR)));
}

/// Each invocation counts one of the block's pixels, p_pixel in the block. p_parts: the first of the words of
/// EDGE_COUNT_RECEIVES_*. p_sorted_part: its receiver's, where they are sorted.
CountPixel count_pixel_of_block(uint p_block, uint p_parts, uvec2 p_pixel, uint p_sorted_part) {
	const bool is_sorted = (p_parts & EDGE_COUNT_IS_SORTED) != 0u;
	CountPixel result;
	result.pixel = ivec2(find_block_corner(p_block) + p_pixel);
	result.edge_count = 0u;
	const bool is_receiver = is_in_image(result.pixel) && is_receiver_pixel(result.pixel);
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
	do {
		// Those of one part: what is between parts would make them read edges that none of them needs.
		const uvec4 waiting = subgroup_ballot(waits);
		const bool is_any = subgroupBallotBitCount(waiting) > 0u;
		const uint leader = is_any ? subgroupBallotFindLSB(waiting) : 0u;
		const uint part = subgroupShuffle(own_part, leader);
		const uint view = find_part_view(p_parts, part);
		const bool is_here = waits && own_part == part;
		const CountBox box = make_count_box(light, load_count_view(view),
				find_subgroup_bounds(point, is_here, subgroupShuffle(point.slope, leader)));
		uint end = is_any ? find_edge_count() : 0u;
		uint chunk = 0u;
		if (!HAS_NO_LIST) {
			const uint chain = (p_block * PART_COUNT + part) * uint(EDGE_COUNT_CHAIN_WORDS);
			// Of a part that is not there nothing is written.
			end = is_any ? chains[chain + uint(EDGE_COUNT_CHAIN_COUNT)] : 0u;
			chunk = is_any ? chains[chain + uint(EDGE_COUNT_CHAIN_FIRST)] : 0u;
		}
		uint next = 0u; // in the list
		const HeldEdge none = HeldEdge(COUNT_ADDS_NOTHING << COUNT_KNOWN_SHIFT, vec3(0.0), vec3(0.0));
		HeldRound held = HeldRound(none, none, none, none);
		do {
			CountChoice choice;
			if (HAS_NO_LIST) {
				choice = choose_from_bundles(next, end, box);
			} else {
				choice = choose_from_list(next, end, chunk, box);
			}
			next = choice.next;
			sync_subgroup_memory();
			uint first = 0u;
			do {
				const uint count = min(choice.count - first, ROUND_SIZE);
				CountShare share = share_round(first, count, receiver, held);
				share.own = is_here ? share.own : 0u;
				count_share(held, receiver, share, state);
				result.edge_count += uint(bitCount(share.own));
				first += ROUND_SIZE;
			} while (first < choice.count);
			sync_subgroup_memory();
		} while (next < end);
		waits = waits && !is_here;
	} while (subgroup_any(waits));
	result.solid_count = state.solid_count;
	result.visibility = is_counted ? count_resolve(state) : (is_receiver ? 1.0 : 0.0);
	return result;
}

/// The invocation's index among those of the work group.
uint find_invocation_index() {
	return gl_SubgroupID * SUBGROUP_SIZE + gl_SubgroupInvocationID;
}

/// Each invocation counts one pixel of the work group's block.
CountPixel count_pixel() {
	const uint block = find_block();
	const uint first = block * uint(EDGE_COUNT_RECEIVES_WORDS);
	const uint parts = receives[first + uint(EDGE_COUNT_RECEIVES_PARTS)];
	const uint invocation = find_invocation_index();
	const uint order = receives[first + uint(EDGE_COUNT_RECEIVES_ORDER) + invocation / 4u];
	const uint own_order = order >> (8u * (invocation % 4u)) & 0xffu;
	const uint index = (parts & EDGE_COUNT_IS_SORTED) != 0u ? own_order & EDGE_COUNT_ORDER_PIXEL_MASK : invocation;
	return count_pixel_of_block(block, parts, find_pixel_in_block(index), own_order >> EDGE_COUNT_ORDER_PART_SHIFT);
}

#endif
