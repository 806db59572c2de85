// Counts the edges of a slice in the shape that suits llvmpipe: one invocation per receiver, edges passed by shuffles.
#ifndef COUNT_SLICE_CPU_INC_GLSL
#define COUNT_SLICE_CPU_INC_GLSL

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

/// Removes the next edge from r_left, the edges that remain to be counted, and returns it. Its weight is 0 if none is
/// left.
CountedEdge find_next_edge(LoadedRound p_loaded, CountEdgeMasks p_edge_masks, inout uint r_left) {
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
	return CountedEdge(edge.a, edge.b,
			is_valid ? ((p_edge_masks.is_negative >> slot & 1u) != 0u ? -weight : weight) : 0);
}

/// Counts the next two edges of each invocation's receiver.
void count_two(LoadedRound p_loaded, CountReceiver p_receiver, CountEdgeMasks p_edge_masks, inout uint r_left,
		inout CountState r_state) {
	const CountedEdge first = find_next_edge(p_loaded, p_edge_masks, r_left);
	const CountedEdge second = find_next_edge(p_loaded, p_edge_masks, r_left);
	count_sectors(find_edge_sectors(p_receiver, first, second), r_state);
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

void count_slice_on_cpu(uint p_count, CountSubject p_subject, inout CountState r_state) {
	const LoadedEdge none = LoadedEdge(COUNT_ADDS_NOTHING << COUNT_PACKED_WEIGHT_SHIFT, vec3(0.0), vec3(0.0));
	LoadedRound loaded = LoadedRound(none, none, none, none);
	uint first = 0u;
	do {
		const uint count = min(p_count - first, ROUND_SIZE);
		CountEdgeMasks edge_masks = test_round(first, count, p_subject.receiver, loaded);
		edge_masks.own = p_subject.is_receiver ? edge_masks.own : 0u;
		count_round(loaded, p_subject.receiver, edge_masks, r_state);
		r_state.edge_count += uint(bitCount(edge_masks.own));
		first += ROUND_SIZE;
		iteration_count += TEST_ITERATIONS + 1u;
	} while (first < p_count);
	note_inner_loop(first < p_count);
}

#endif
