// Counts the edges of a block's pixels, for the mask and for the debug image.
//
// llvmpipe executes a branch that no invocation takes, and a loop's body once even if no invocation enters it. So loops
// test at their ends, and their first iteration has no effect if there is nothing to do.
#ifndef COUNT_RESOLVE_INC_GLSL
#define COUNT_RESOLVE_INC_GLSL

#include "shadow_edge_count/count_block_parts_inc.glsl"
#include "shadow_edge_count/count_bundles_inc.glsl"
#include "shadow_edge_count/count_edge_inc.glsl"

FETCHED_UINTS(COUNT_BINDING_LISTS, lists_buffer);
layout(set = 0, binding = COUNT_BINDING_MASKS) uniform utextureBuffer masks_buffer;

layout(constant_id = EDGE_COUNT_CONSTANT_SUBGROUP_SIZE) const uint FULL_SUBGROUP_SIZE = 8u;
/// Active invocations of a subgroup: a work group may be smaller than the device's subgroups.
const uint SUBGROUP_SIZE =
		FULL_SUBGROUP_SIZE < uint(COUNT_GROUP_SIZE) ? FULL_SUBGROUP_SIZE : uint(COUNT_GROUP_SIZE);
#include "shadow_edge_count/plane_fit_inc.glsl"
/// The blocks have no edge lists: each subgroup tests all bundles of the light.
layout(constant_id = EDGE_COUNT_CONSTANT_HAS_NO_LIST) const bool HAS_NO_LIST = false;

// A texel has the masks of one sample set, or of two.
uvec4 load_count_masks(uint p_index, uint p_pair) {
	return texelFetch(masks_buffer, int(p_index * uint((COUNT_SAMPLE_SET_COUNT + 1) / 2) + p_pair));
}

// The work of a subgroup is bounded, see EDGE_COUNT_MAX_ITERATIONS: it stops after the slice of edges at which
// iteration_count reaches iteration_limit. What it has not counted then, a pass of resolve_unfinished.comp counts.
const uint NO_ITERATION_LIMIT = 0xffffffffu;
uint iteration_limit = NO_ITERATION_LIMIT;
uint iteration_count = 0u; // of loops over edges; an upper bound

bool has_iterations_left() {
	return iteration_count < iteration_limit;
}

/// Notes a fault if p_is_unfinished, after a loop inside the loop over slices. Only work without lists does so, which the
/// last round does without a limit: with lists, the loop over slices ends long before a driver ends loops.
void note_inner_loop(bool p_is_unfinished) {
	note_fault(HAS_NO_LIST && p_is_unfinished, EDGE_COUNT_FAULT_LOOP);
}

// List entries (see COUNT_EDGE_MASK) of the edges that some receiver of a subgroup may have to count. Each subgroup has
// its own slice. There is a slice for every four invocations, the smallest size of a subgroup.
const uint SLICE_SIZE = 64u;
shared uint chosen_edges[SLICE_SIZE * COUNT_GROUP_SIZE / 4];

/// The results of one pixel.
struct CountPixel {
	ivec2 pixel;
	uint edge_count; // edges that its receiver counted
	float visibility; // 0 without a receiver
	int solid_count; // between the receiver and the light's centre
	bool is_unfinished; // some edges were not counted: no iterations were left
};

/// State of collecting the edges that a box's receivers may need.
struct CountChoice {
	uint next; // where to continue: index in the list, or without lists index of the edge
	uint count; // of edges in the slice
};

/// Each invocation tests one edge, and appends it to the slice if the box's receivers may need it. p_entry: the edge's
/// list entry.
void choose_edge(CountBox p_box, uint p_entry, bool p_is_valid, inout CountChoice r_choice) {
	const CountEdgeRecord edge = load_count_edge(p_entry & COUNT_EDGE_MASK);
	const bool is_chosen = p_is_valid &&
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

/// Collects edges from the part's list, which has p_end entries, from p_first on. Ends when the slice may be full,
/// or no iterations are left. r_chunk: the chunk of the next entry.
CountChoice choose_from_list(uint p_first, uint p_end, inout uint r_chunk, CountBox p_box) {
	const uint size = uint(EDGE_COUNT_CHUNK_SIZE);
	CountChoice choice = CountChoice(p_first, 0u);
	do {
		const uint index = choice.next + gl_SubgroupInvocationID;
		const bool is_chunk = r_chunk < light.chunk_capacity;
		note_fault(choice.next < p_end && !is_chunk, EDGE_COUNT_FAULT_EDGE_LIST);
		const bool is_valid = index < p_end && is_chunk;
		const uint entry = FETCH_UINT(lists_buffer, is_valid ? int(r_chunk * size + index % size) : 0);
		const bool is_edge = (entry & COUNT_EDGE_MASK) < light.max_edge_count;
		note_fault(is_valid && !is_edge, EDGE_COUNT_FAULT_EDGE_LIST);
		choose_edge(p_box, is_valid && is_edge ? entry : 0u, is_valid && is_edge, choice);
		choice.next += SUBGROUP_SIZE;
		r_chunk = choice.next % size == 0u
				? FETCH_UINT(lists_buffer, light.chunk_capacity * size + min(r_chunk, light.chunk_capacity - 1u))
				: r_chunk;
		++iteration_count;
	} while (choice.next < p_end && has_choice_room(choice, SUBGROUP_SIZE) && has_iterations_left());
	return choice;
}

/// p_index: the edge's index in the bundle. p_end: number of edges of the light.
void choose_edge_of_bundle(CountBox p_box, uint p_bundle, uint p_index, uint p_end, inout CountChoice r_choice) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint edge = p_bundle * size + p_index;
	const bool is_valid = p_index < size && edge < p_end;
	const bool is_seen = is_valid && is_in_distance_range(p_box.distances.x, load_count_edge(is_valid ? edge : 0u));
	choose_edge(p_box, is_valid ? edge : 0u, is_seen, r_choice);
}

/// Collects edges from all bundles of the light, from edge p_first on, which starts a bundle. Ends when the slice may
/// be full, or no iterations are left. p_end: number of edges of the light.
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
			const bool is_valid = subgroupBallotBitCount(needed) != 0u;
			const uint lane = is_valid ? subgroupBallotFindLSB(needed) : 0u;
			const bool has_room = has_choice_room(choice, size);
			if (is_valid && !has_room) {
				choice.next = (first_bundle + lane) * size; // continue here next time
			}
			needed[lane / 32u] &= ~(1u << (lane & 31u));
			needed = has_room ? needed : uvec4(0u);
			const uint end = is_valid && has_room ? p_end : 0u;
			uint i = gl_SubgroupInvocationID;
			// Each call tests SUBGROUP_SIZE edges of the bundle: one call is enough for 16 invocations or more.
			do {
				choose_edge_of_bundle(p_box, first_bundle + lane, i, end, choice);
				if (SUBGROUP_SIZE < size) {
					choose_edge_of_bundle(p_box, first_bundle + lane, i + SUBGROUP_SIZE, end, choice);
				}
				i += 2u * SUBGROUP_SIZE;
				++iteration_count;
			} while (2u * SUBGROUP_SIZE < size && i - gl_SubgroupInvocationID < size);
			note_inner_loop(i - gl_SubgroupInvocationID < size);
			++iteration_count;
		} while (subgroupBallotBitCount(needed) != 0u);
		note_inner_loop(subgroupBallotBitCount(needed) != 0u);
		++iteration_count;
	} while (choice.next < p_end && has_choice_room(choice, size) && has_iterations_left());
	return choice;
}

/// False if the part of the edge between the receiver and the disc cannot change which part of the
/// disc is hidden. The tolerances exceed the rounding errors of find_edge_sectors, so that no edge
/// with an effect is rejected. p_to_light: see CountReceiver.
bool may_hide(vec3 p_receiver, vec3 p_to_light, vec3 p_a, vec3 p_b) {
	const float ROUNDING = 4e-6;
	const float radius = 1.001 * light.disc_radius;
	const vec3 a = p_a - p_receiver;
	const vec3 b = p_b - p_receiver;
	const float d_a = dot(p_to_light, a);
	const float d_b = dot(p_to_light, b);
	const float length_a = length(a);
	const float length_b = length(b);
	const float inverse_distance = length(p_to_light); // 1 / distance of the light; directional: 1
	// Projected to the disc's plane, the edge runs along edge_direction. The distance of its line from the centre is
	// scaled_distance / (inverse_distance * direction_length).
	const vec3 edge_direction = b * d_a - a * d_b;
	const float direction_length = length(edge_direction);
	const float scaled_distance = abs(dot(p_to_light, cross(a, b)));
	// Upper bound of the rounding errors of edge_direction, whose terms cancel for a short edge, and of scaled_distance.
	const float rounding = ROUNDING * inverse_distance * length_a * length_b;
	const bool is_outside_disc = scaled_distance > inverse_distance * radius * direction_length + rounding;
	// Along its line, the edge starts past the disc, or ends before it.
	const bool is_beyond = min(d_a, d_b) > 0.0 &&
			(dot(a, edge_direction) > direction_length * (radius * d_a + ROUNDING * length_a) + rounding * length_a ||
					dot(b, edge_direction) <
							-direction_length * (radius * d_b + ROUNDING * length_b) - rounding * length_b);
	const bool is_below = max(d_a, d_b) <= 0.0;
	const bool is_above = !IS_DIRECTIONAL && min(d_a, d_b) > 1.001;
	return !is_outside_disc && !is_beyond && !is_below && !is_above;
}

// A slice is counted in rounds of ROUND_SIZE edges. Each invocation loads up to four of them and passes them to the
// others by shuffles: on software drivers this is faster than if each invocation loads all edges.
const uint ROUND_SIZE = SUBGROUP_SIZE < 8u ? 4u * SUBGROUP_SIZE : 32u;
const uint BATCH_SIZE = SUBGROUP_SIZE < 32u ? SUBGROUP_SIZE : 32u; // edges of a round that are loaded at a time

/// The list entry of an edge, and its ends.
struct LoadedEdge {
	uint entry;
	vec3 a;
	vec3 b;
};

/// The edges of a round. Batch i has edges i * BATCH_SIZE .. (i + 1) * BATCH_SIZE - 1, one per invocation.
struct LoadedRound {
	LoadedEdge batch0;
	LoadedEdge batch1;
	LoadedEdge batch2;
	LoadedEdge batch3;
};

/// Bit masks of the edges of a round, for the invocation's receiver. An edge's bit is its slot, 0..31.
struct CountEdgeMasks {
	uint own; // edges that it has to count
	uint is_negative; // their weight is negative
	uint is_twice; // their weight is 2 or -2
};

/// Loads one edge per invocation: those of the slice from p_first to p_end - 1, and beyond that edges that add nothing.
LoadedEdge load_edge(uint p_first, uint p_end) {
	const uint item = p_first + gl_SubgroupInvocationID;
	const uint entry = item < p_end ? chosen_edges[gl_SubgroupID * SLICE_SIZE + item]
									: COUNT_ADDS_NOTHING << COUNT_PACKED_WEIGHT_SHIFT;
	const CountEdgeRecord edge = load_count_edge(entry & COUNT_EDGE_MASK);
	return LoadedEdge(entry, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz));
}

/// Passes the edge of invocation p_lane to all others.
LoadedEdge shuffle_edge(LoadedEdge p_loaded, uint p_lane) {
	return LoadedEdge(subgroupShuffle(p_loaded.entry, p_lane), subgroupShuffle(p_loaded.a, p_lane),
			subgroupShuffle(p_loaded.b, p_lane));
}

/// Marks the edge of invocation p_lane if the receiver may have to count it, and its weight if the list entry has one.
void test_round_edge(LoadedEdge p_loaded, uint p_lane, uint p_first_slot, CountReceiver p_receiver,
		inout CountEdgeMasks r_edge_masks) {
	const LoadedEdge edge = shuffle_edge(p_loaded, p_lane);
	const uint packed_weight = edge.entry >> COUNT_PACKED_WEIGHT_SHIFT;
	const int weight = (packed_weight & COUNT_HAS_WEIGHT) != 0u ? unpack_weight(packed_weight) : 0;
	const bool is_own = packed_weight != COUNT_ADDS_NOTHING &&
			may_hide(p_receiver.position, p_receiver.to_light, edge.a, edge.b);
	const uint bit = is_own ? 1u << (p_first_slot + p_lane) : 0u;
	r_edge_masks.own |= bit;
	r_edge_masks.is_negative |= weight < 0 ? bit : 0u;
	r_edge_masks.is_twice |= abs(weight) == 2 ? bit : 0u;
}

/// The faces of an edge, which determine its weight, see count_weight.
struct LoadedFaces {
	uvec2 words; // face words of CountEdgeRecord
	vec4 plane0;
	vec4 plane1;
};

/// Marks the weight of the edge of invocation p_lane as seen by the receiver, if its list entry has none. An edge of
/// weight 0 need not be counted.
void compute_round_weight(LoadedEdge p_loaded, LoadedFaces p_faces, uint p_lane, uint p_first_slot,
		CountReceiver p_receiver, inout CountEdgeMasks r_edge_masks) {
	const uvec2 words = subgroupShuffle(p_faces.words, p_lane);
	const int weight = count_weight(p_receiver.position, subgroupShuffle(p_faces.plane0, p_lane),
			subgroupShuffle(p_faces.plane1, p_lane), make_count_kind(words.x, words.y));
	const uint packed_weight = subgroupShuffle(p_loaded.entry, p_lane) >> COUNT_PACKED_WEIGHT_SHIFT;
	const uint bit = (packed_weight & COUNT_HAS_WEIGHT) == 0u ? 1u << (p_first_slot + p_lane) : 0u;
	r_edge_masks.own &= ~(weight == 0 ? bit : 0u);
	r_edge_masks.is_negative |= weight < 0 ? bit : 0u;
	r_edge_masks.is_twice |= abs(weight) == 2 ? bit : 0u;
}

LoadedEdge select_edge(bool p_is_second, LoadedEdge p_first, LoadedEdge p_second) {
	return LoadedEdge(p_is_second ? p_second.entry : p_first.entry, p_is_second ? p_second.a : p_first.a,
			p_is_second ? p_second.b : p_first.b);
}

LoadedEdge get_batch(LoadedRound p_loaded, uint p_batch) {
	const LoadedEdge low = select_edge(p_batch == 1u, p_loaded.batch0, p_loaded.batch1);
	const LoadedEdge high = select_edge(p_batch == 3u, p_loaded.batch2, p_loaded.batch3);
	return select_edge(p_batch >= 2u, low, high);
}

/// Tests edges p_lane .. p_lane + 3 of a batch of a round. Their bits start at p_first_slot + p_lane.
void test_four_edges(LoadedEdge p_loaded, uint p_lane, uint p_first_slot, CountReceiver p_receiver,
		inout CountEdgeMasks r_edge_masks) {
	test_round_edge(p_loaded, p_lane, p_first_slot, p_receiver, r_edge_masks);
	test_round_edge(p_loaded, p_lane + 1u, p_first_slot, p_receiver, r_edge_masks);
	test_round_edge(p_loaded, p_lane + 2u, p_first_slot, p_receiver, r_edge_masks);
	test_round_edge(p_loaded, p_lane + 3u, p_first_slot, p_receiver, r_edge_masks);
}

void compute_four_weights(LoadedEdge p_loaded, LoadedFaces p_faces, uint p_lane, uint p_first_slot,
		CountReceiver p_receiver, inout CountEdgeMasks r_edge_masks) {
	compute_round_weight(p_loaded, p_faces, p_lane, p_first_slot, p_receiver, r_edge_masks);
	compute_round_weight(p_loaded, p_faces, p_lane + 1u, p_first_slot, p_receiver, r_edge_masks);
	compute_round_weight(p_loaded, p_faces, p_lane + 2u, p_first_slot, p_receiver, r_edge_masks);
	compute_round_weight(p_loaded, p_faces, p_lane + 3u, p_first_slot, p_receiver, r_edge_masks);
}

/// Number of edges in a batch of a round that has p_count edges.
uint find_loaded_count(uint p_batch, uint p_count) {
	return min(p_count - min(p_count, p_batch * BATCH_SIZE), BATCH_SIZE);
}

// Edges that one iteration tests. Larger numbers need fewer iterations, see EDGE_COUNT_MAX_ITERATIONS.
const uint EDGES_PER_ITERATION = BATCH_SIZE < 8u ? 4u : 8u;
/// Maximum number of iterations of test_round: two loops over the batches, with a loop over each batch's edges.
const uint TEST_ITERATIONS = 2u * (ROUND_SIZE / BATCH_SIZE) * (1u + BATCH_SIZE / EDGES_PER_ITERATION);

/// Loads a round of p_count edges of the slice, from p_first on, and finds those that the receiver
/// has to count. Batches of r_loaded without edges of this round are unchanged, and have no bits in
/// the result.
CountEdgeMasks test_round(uint p_first, uint p_count, CountReceiver p_receiver, inout LoadedRound r_loaded) {
	CountEdgeMasks edge_masks = CountEdgeMasks(0u, 0u, 0u);
	uint batches_without_weight = 0u; // bit per batch of the round: it has an edge whose list entry has no weight
	uint batch = 0u;
	do {
		const LoadedEdge loaded = load_edge(p_first + batch * BATCH_SIZE, p_first + p_count);
		r_loaded.batch0 = select_edge(batch == 0u, r_loaded.batch0, loaded);
		r_loaded.batch1 = select_edge(batch == 1u, r_loaded.batch1, loaded);
		r_loaded.batch2 = select_edge(batch == 2u, r_loaded.batch2, loaded);
		r_loaded.batch3 = select_edge(batch == 3u, r_loaded.batch3, loaded);
		uint i = 0u;
		do {
			test_four_edges(loaded, i, batch * BATCH_SIZE, p_receiver, edge_masks);
			if (EDGES_PER_ITERATION == 8u) {
				test_four_edges(loaded, i + 4u, batch * BATCH_SIZE, p_receiver, edge_masks);
			}
			i += EDGES_PER_ITERATION;
		} while (BATCH_SIZE > EDGES_PER_ITERATION && i < find_loaded_count(batch, p_count));
		const bool lacks_weight = (loaded.entry >> COUNT_PACKED_WEIGHT_SHIFT & COUNT_HAS_WEIGHT) == 0u;
		batches_without_weight |= subgroup_any(lacks_weight) ? 1u << batch : 0u;
		++batch;
	} while (batch * BATCH_SIZE < p_count);
	note_inner_loop(batch * BATCH_SIZE < p_count);
	do {
		// If none is left, this iteration has no effect.
		batch = batches_without_weight != 0u ? uint(findLSB(batches_without_weight)) : 0u;
		batches_without_weight &= batches_without_weight - 1u;
		const LoadedEdge loaded = get_batch(r_loaded, batch);
		const CountEdgeRecord edge = load_count_edge(loaded.entry & COUNT_EDGE_MASK);
		const LoadedFaces faces = LoadedFaces(
				uvec2(edge.a_face0.w, edge.b_face1.w), load_count_plane0(edge), load_count_plane1(edge));
		uint i = 0u;
		do {
			compute_four_weights(loaded, faces, i, batch * BATCH_SIZE, p_receiver, edge_masks);
			if (EDGES_PER_ITERATION == 8u) {
				compute_four_weights(loaded, faces, i + 4u, batch * BATCH_SIZE, p_receiver, edge_masks);
			}
			i += EDGES_PER_ITERATION;
		} while (BATCH_SIZE > EDGES_PER_ITERATION && i < find_loaded_count(batch, p_count));
	} while (batches_without_weight != 0u);
	note_inner_loop(batches_without_weight != 0u);
	return edge_masks;
}

/// An edge to be counted, and its weight as seen by the receiver; 0: none.
struct NextEdge {
	vec3 a;
	vec3 b;
	int weight;
};

/// Removes the next edge from r_left, the edges that remain to be counted, and returns it. Its weight is 0 if none is
/// left.
NextEdge find_next_edge(LoadedRound p_loaded, CountEdgeMasks p_edge_masks, inout uint r_left) {
	const bool is_valid = r_left != 0u;
	const uint slot = uint(findLSB(r_left)) & 31u;
	r_left &= r_left - 1u;
	const uint lane = slot % BATCH_SIZE;
	LoadedEdge edge = shuffle_edge(p_loaded.batch0, lane);
	if (ROUND_SIZE > BATCH_SIZE) {
		edge = select_edge((slot & BATCH_SIZE) != 0u, edge, shuffle_edge(p_loaded.batch1, lane));
	}
	if (ROUND_SIZE > 2u * BATCH_SIZE) {
		const LoadedEdge other = select_edge(
				(slot & BATCH_SIZE) != 0u, shuffle_edge(p_loaded.batch2, lane), shuffle_edge(p_loaded.batch3, lane));
		edge = select_edge((slot & 2u * BATCH_SIZE) != 0u, edge, other);
	}
	const int weight = (p_edge_masks.is_twice >> slot & 1u) != 0u ? 2 : 1;
	return NextEdge(edge.a, edge.b,
			is_valid ? ((p_edge_masks.is_negative >> slot & 1u) != 0u ? -weight : weight) : 0);
}

/// Counts the next two edges of each invocation's receiver.
void count_two(LoadedRound p_loaded, CountReceiver p_receiver, CountEdgeMasks p_edge_masks, inout uint r_left,
		inout CountState r_state) {
	const NextEdge first = find_next_edge(p_loaded, p_edge_masks, r_left);
	const NextEdge second = find_next_edge(p_loaded, p_edge_masks, r_left);
	count_sectors(find_edge_sectors(
						  p_receiver, first.a, first.b, second.a, second.b, ivec2(first.weight, second.weight)),
			r_state);
}

/// Counts the edges of a round that each invocation's receiver has to count.
void count_round(LoadedRound p_loaded, CountReceiver p_receiver, CountEdgeMasks p_edge_masks,
		inout CountState r_state) {
	const uint max_count = subgroup_max(uint(bitCount(p_edge_masks.own)));
	uint left = p_edge_masks.own;
	uint i = 0u;
	do {
		count_two(p_loaded, p_receiver, p_edge_masks, left, r_state);
		if (HAS_NO_LIST) { // fewer iterations: see EDGES_PER_ITERATION
			count_two(p_loaded, p_receiver, p_edge_masks, left, r_state);
		}
		i += HAS_NO_LIST ? 4u : 2u;
		++iteration_count;
	} while (i < max_count);
	note_inner_loop(i < max_count);
}

/// The bounds of the receivers of a subgroup for which p_is_selected is true.
CountBounds find_receiver_bounds(vec3 p_warped, bool p_is_selected) {
	const vec3 mean = find_mean_receiver(p_is_selected ? vec4(p_warped, 1.0) : vec4(0.0));
	PlaneMoments moments = PlaneMoments(vec3(0.0), vec2(0.0));
	add_to_moments(p_warped - mean, p_is_selected, moments);
	CountBounds bounds = make_count_bounds();
	bounds.slope = find_fitted_slope(moments);
	add_to_bounds(p_warped, p_is_selected, bounds);
	return find_subgroup_bounds(bounds);
}

/// A pixel, its receiver, and the part of the block to which that belongs.
struct CountSubject {
	ivec2 pixel;
	bool is_receiver;
	bool is_counted; // some caster may hide the receiver
	uint part;
	CountPoint point; // meaningless if there is no receiver
	CountReceiver receiver;
};

/// The pixel is at position p_pixel in the block. p_parts: the block's word EDGE_COUNT_RECEIVERS_PARTS. p_sorted_part:
/// the receiver's part, if the block is sorted.
CountSubject load_subject(uint p_block, uint p_parts, uvec2 p_pixel, uint p_sorted_part) {
	const bool is_sorted = (p_parts & EDGE_COUNT_IS_SORTED) != 0u;
	CountSubject subject;
	subject.pixel = ivec2(find_block_corner(p_block) + p_pixel);
	subject.is_receiver = is_in_image(subject.pixel) && is_receiver_pixel(subject.pixel);
	subject.point = CountPoint(vec3(0.0, 0.0, 1.0), 0u, vec3(0.0, 0.0, 1.0), 0.0);
	if (subject.is_receiver) {
		subject.point = load_count_point(subject.pixel);
	}
	subject.is_counted = subject.is_receiver && may_count_at(subject.point);
	subject.part = is_sorted ? p_sorted_part : subject.point.view;
	const float distance = subject.is_counted ? load_part_distance(p_block, p_parts, subject.part) : 0.0;
	subject.receiver = make_count_receiver(light, subject.point.position, distance);
	// Edges of the receiver's own surface are about as far below it as it was moved.
	subject.receiver.min_d *= subject.point.offset_fraction;
	return subject;
}

/// Counts the solids before the light's centre, and the lines along which faces cut the disc.
CountState count_at_center(CountSubject p_subject) {
	const CountReceiver receiver = p_subject.receiver;
	CountCrossings crossings = CountCrossings(0, 0, 0);
	if (p_subject.is_counted) {
		crossings = count_crossings(
				light, VIEW_COUNT == 1u ? 0u : p_subject.point.view, p_subject.point.warped.xy, receiver);
	}
	const uint cut_face_count = p_subject.is_counted ? find_cut_face_count() : 0u;
	for (uint i = 0u; i < cut_face_count; ++i) {
		const uint face = load_cut_face(i);
		const vec4 plane = load_count_plane(face);
		const bool is_in_front = is_count_in_front(plane, receiver.position);
		if (is_in_front != is_count_light_in_front(plane)) {
			count_face(receiver, load_count_face(face), is_in_front, crossings);
		}
	}
	CountState state = make_count_state(sum_crossings(crossings));
	for (uint i = 0u; i < cut_face_count; ++i) {
		const uint face = load_cut_face(i);
		count_add_cut(receiver, load_count_face(face), load_count_plane(face),
				crossings.back_facing >= crossings.light_facing, state);
	}
	return state;
}

/// How far a subgroup has counted its receivers' edges.
struct CountProgress {
	bool waits; // edges of the invocation's receiver remain to be counted
	uint next;	// of the part that is being counted: index in the list, or without lists index of the edge
};

/// Counts edges until all are counted, or no iterations are left. r_edge_count: is increased by the number of edges that
/// the receiver counted.
void count_edges(uint p_block, uint p_parts, CountSubject p_subject, inout CountState r_state,
		inout CountProgress r_progress, inout uint r_edge_count) {
	do {
		// Process the receivers of one part at a time: a box around several parts needs many more edges.
		const uvec4 waiting = subgroup_ballot(r_progress.waits);
		const bool is_any = subgroupBallotBitCount(waiting) > 0u;
		const uint leader = is_any ? subgroupBallotFindLSB(waiting) : 0u;
		const uint part = subgroupShuffle(p_subject.part, leader);
		const uint view = find_part_view(p_parts, part);
		const bool is_selected = r_progress.waits && p_subject.part == part;
		CountBox box = make_count_box(light, load_count_view(view),
				find_receiver_bounds(p_subject.point.warped, is_selected));
		box.distances = vec2(subgroupShuffle(p_subject.receiver.part_distance, leader));
		uint end = is_any ? find_edge_count() : 0u;
		uint chunk = 0u;
		if (!HAS_NO_LIST) {
			const uint chain = find_chain(p_block, part);
			// A part without receivers has no chain. Rounding can put a receiver into one, see load_part_distance.
			const bool has_chain = is_any && (p_parts >> part & 1u) != 0u;
			// The list has each edge once at most.
			const uint edge_count = end;
			end = has_chain ? chains[chain + uint(EDGE_COUNT_CHAIN_COUNT)] : 0u;
			note_fault(end > edge_count, EDGE_COUNT_FAULT_EDGE_LIST);
			end = min(end, edge_count);
			chunk = has_chain ? chains[chain + uint(EDGE_COUNT_CHAIN_FIRST)] : 0u;
		}
		uint next = r_progress.next;
		const LoadedEdge none = LoadedEdge(COUNT_ADDS_NOTHING << COUNT_PACKED_WEIGHT_SHIFT, vec3(0.0), vec3(0.0));
		LoadedRound loaded = LoadedRound(none, none, none, none);
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
				CountEdgeMasks edge_masks = test_round(first, count, p_subject.receiver, loaded);
				edge_masks.own = is_selected ? edge_masks.own : 0u;
				count_round(loaded, p_subject.receiver, edge_masks, r_state);
				r_edge_count += uint(bitCount(edge_masks.own));
				first += ROUND_SIZE;
				iteration_count += TEST_ITERATIONS + 1u;
			} while (first < choice.count);
			note_inner_loop(first < choice.count);
			sync_subgroup_memory();
			++iteration_count;
		} while (next < end && has_iterations_left());
		const bool is_done = next >= end;
		note_fault(!is_done && has_iterations_left(), EDGE_COUNT_FAULT_LOOP);
		r_progress.waits = r_progress.waits && !(is_selected && is_done);
		r_progress.next = is_done ? 0u : next;
		++iteration_count;
	} while (subgroup_any(r_progress.waits) && has_iterations_left());
	note_fault(r_progress.waits && has_iterations_left(), EDGE_COUNT_FAULT_LOOP);
}

CountPixel make_count_pixel(CountSubject p_subject, CountState p_state, CountProgress p_progress, uint p_edge_count) {
	return CountPixel(p_subject.pixel, p_edge_count,
			p_subject.is_counted ? count_resolve(p_state) : (p_subject.is_receiver ? 1.0 : 0.0), p_state.solid_count,
			p_progress.waits);
}

/// Writes the faults of the subgroup. One invocation does: drivers insert subgroup operations around other atomics, and
/// would do so in divergent flow.
void report_subgroup_faults() {
	const uint faults = subgroup_or(count_faults);
	const bool is_elected = subgroupElect();
	report_faults(faults, faults != 0u && is_elected);
}

/// Each invocation counts the edges of one pixel and computes its visibility. For the parameters see load_subject.
CountPixel count_pixel_of_block(uint p_block, uint p_parts, uvec2 p_pixel, uint p_sorted_part) {
	const CountSubject subject = load_subject(p_block, p_parts, p_pixel, p_sorted_part);
	CountState state = count_at_center(subject);
	CountProgress progress = CountProgress(subject.is_counted, 0u);
	uint edge_count = 0u;
	count_edges(p_block, p_parts, subject, state, progress, edge_count);
	report_subgroup_faults();
	return make_count_pixel(subject, state, progress, edge_count);
}

/// Each invocation computes one pixel of the work group's block.
CountPixel count_pixel() {
	const uint block = find_block();
	const uint parts = load_parts(block);
	const BlockPixel pixel = load_block_pixel(block, parts, gl_LocalInvocationIndex);
	return count_pixel_of_block(block, parts, find_pixel_in_block(pixel.index), pixel.sorted_part);
}

#endif
