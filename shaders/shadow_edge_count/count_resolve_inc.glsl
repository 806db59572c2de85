// Counts the edges of a leaf's receivers, for the mask and for the debug image.
//
// The passes have two shapes, count_slice_cpu_inc.glsl and count_slice_gpu_inc.glsl. What is here serves both: loops test
// at their ends, and their first iteration has no effect if there is nothing to do, since llvmpipe executes a branch that
// no invocation takes, and a loop's body once even if no invocation enters it.
#ifndef COUNT_RESOLVE_INC_GLSL
#define COUNT_RESOLVE_INC_GLSL

#define COUNTS_EDGES
#include "shadow_edge_count/count_edge_inc.glsl"
#include "shadow_edge_count/count_solids_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_MASKS) uniform utextureBuffer masks_buffer;
/// The leaves have no edge lists: each subgroup walks through the tree of edges.
layout(constant_id = EDGE_COUNT_CONSTANT_HAS_NO_LIST) const bool HAS_NO_LIST = false;

// A texel has the masks of one sample set, or of two.
uvec4 load_count_masks(uint p_index, uint p_pair) {
	return texelFetch(masks_buffer, int(p_index * ((SAMPLE_SET_COUNT + 1u) / 2u) + p_pair));
}

// The work of a subgroup is bounded, see EDGE_COUNT_MAX_ITERATIONS: it stops after the slice of edges at which
// iteration_count reaches iteration_limit. What it has not counted then, a pass of resolve_unfinished.comp counts.
const uint NO_ITERATION_LIMIT = 0xffffffffu;
uint iteration_limit = NO_ITERATION_LIMIT;

bool has_iterations_left() {
	return iteration_count < iteration_limit;
}

/// Notes a fault if p_is_unfinished, after a loop inside the loop over slices. Only work without lists does so, which the
/// last round does without a limit: with lists, the loop over slices ends long before a driver ends loops.
void note_inner_loop(bool p_is_unfinished) {
	note_fault(HAS_NO_LIST && p_is_unfinished, EDGE_COUNT_FAULT_LOOP);
}

// List entries (see COUNT_EDGE_MASK) of the edges that some receiver of a subgroup may have to count. Each subgroup has
// its own slice. There is a slice for every four invocations, the smallest size of a subgroup; on GPUs for every eight.
const uint SLICE_SIZE = 64u;
shared uint chosen_edges[SLICE_SIZE * gl_WorkGroupSize.x / (IS_CPU ? 4u : 8u)];
uint chosen_count; // in the slice

const uint CURSOR_LEVEL_SHIFT = 28u; // of a packed cursor; below are bits of the index
const uint CURSOR_AT_END = 0x80000000u; // flag, above all levels

uint pack_cursor(TreeCursor p_cursor) {
	return (p_cursor.is_at_end ? CURSOR_AT_END : 0u) | p_cursor.level << CURSOR_LEVEL_SHIFT | p_cursor.index;
}

TreeCursor unpack_cursor(uint p_packed) {
	return TreeCursor((p_packed & ~CURSOR_AT_END) >> CURSOR_LEVEL_SHIFT, p_packed & (1u << CURSOR_LEVEL_SHIFT) - 1u,
			p_packed >= CURSOR_AT_END);
}

/// Each invocation tests one edge, and appends it to the slice if the box's receivers may need it. p_entry: the edge's
/// list entry.
void choose_edge(CountBox p_box, uint p_entry, bool p_is_valid) {
	const CountEdgeRecord edge = load_count_edge(p_entry & COUNT_EDGE_MASK);
	const bool is_chosen = p_is_valid &&
			is_edge_in_reach(p_box, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz));
	const uvec4 chosen = subgroup_ballot(is_chosen);
	if (is_chosen) {
		chosen_edges[gl_SubgroupID * SLICE_SIZE + chosen_count + subgroupBallotExclusiveBitCount(chosen)] = p_entry;
	}
	chosen_count += subgroupBallotBitCount(chosen);
}

bool has_slice_room(uint p_more) {
	return chosen_count + p_more <= SLICE_SIZE;
}

/// Collects edges from the leaf's list. Ends when the slice may be full, or no iterations are left. p_first_word: of the list.
/// p_end: its number of entries. r_next: the next one.
void choose_from_list(uint p_first_word, uint p_end, CountBox p_box, inout uint r_next) {
	do {
		const uint index = r_next + gl_SubgroupInvocationID;
		const bool is_valid = index < p_end;
		const uint entry = FETCH_UINT(lists_buffer, is_valid ? int(min(p_first_word + index, light.list_capacity - 1u)) : 0);
		const bool is_edge = (entry & COUNT_EDGE_MASK) < light.max_edge_count;
		note_fault(is_valid && !is_edge, EDGE_COUNT_FAULT_LIST);
		choose_edge(p_box, is_valid && is_edge ? entry : 0u, is_valid && is_edge);
		r_next += SUBGROUP_SIZE;
		++iteration_count;
	} while (r_next < p_end && has_slice_room(SUBGROUP_SIZE) && has_iterations_left());
}

/// Adds the edges of a cluster.
void choose_from_cluster(CountBox p_box, uint p_cluster, uint p_edge_count, bool p_is_valid) {
	const uint size = uint(EDGE_COUNT_CLUSTER_SIZE);
	uint first = 0u;
	// One iteration if a subgroup has 16 invocations or more.
	do {
		const uint index = first + gl_SubgroupInvocationID;
		const uint edge = p_cluster * size + index;
		const bool is_valid = p_is_valid && index < size && edge < p_edge_count;
		const bool is_seen = is_valid && is_in_distance_range(p_box.distance, load_count_edge(is_valid ? edge : 0u));
		choose_edge(p_box, is_valid ? edge : 0u, is_seen);
		first += SUBGROUP_SIZE;
		++iteration_count;
	} while (first < size);
	note_inner_loop(first < size);
}

/// Collects edges from the tree. r_next: a packed cursor. Ends when the slice may be full, or no iterations are left.
/// Each step moves the cursor forward in a tree whose size is limited, whatever its nodes have, so the loop ends.
void choose_from_tree(CountBox p_box, inout uint r_next) {
	const CountTree tree = make_count_tree(/*p_has_faces=*/false);
	const uint width = min(uint(EDGE_COUNT_NODE_WIDTH), SUBGROUP_SIZE); // nodes that are tested together
	TreeCursor cursor = unpack_cursor(r_next);
	do {
		// The rest of the cursor's siblings.
		const uint first = cursor.index - cursor.index % width;
		const uint index = first + gl_SubgroupInvocationID;
		const bool exists = !cursor.is_at_end && gl_SubgroupInvocationID < width && index >= cursor.index &&
				index < find_node_count(tree.item_count, cursor.level);
		const uvec4 needed = subgroup_ballot(exists &&
				is_node_in_reach(p_box, load_count_node(tree, cursor.level, exists ? index : 0u)));
		const bool is_any = subgroupBallotBitCount(needed) != 0u;
		cursor.index = is_any ? first + subgroupBallotFindLSB(needed) : cursor.index;
		const bool is_cluster = is_any && cursor.level == 0u;
		choose_from_cluster(p_box, cursor.index, tree.item_count, is_cluster);
		if (is_any && !is_cluster) {
			descend_cursor(cursor);
		} else if (!cursor.is_at_end) {
			advance_cursor(tree, is_any ? cursor.index + 1u : first + width, cursor);
		}
		++iteration_count;
	} while (!cursor.is_at_end && has_slice_room(uint(EDGE_COUNT_CLUSTER_SIZE)) && has_iterations_left());
	r_next = pack_cursor(cursor);
}

/// False if what the edge has between the receiver and the disc cannot change what is hidden of the disc. The tolerances
/// exceed the rounding errors of find_edge_sectors, so that no edge with an effect is rejected. p_to_light: see
/// CountReceiver.
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

/// The sums over the lanes of a receiver.
ivec4 add_lanes(ivec4 p_values) {
	ivec4 sums = p_values;
	for (uint i = 1u; i < LANES_PER_RECEIVER; i <<= 1u) {
		sums += subgroupShuffleXor(sums, i);
	}
	return sums;
}

#include "shadow_edge_count/count_slice_cpu_inc.glsl"
#include "shadow_edge_count/count_slice_gpu_inc.glsl"

/// The state before any edge is counted: the solids before the light's centre, and the lines along which faces cut the
/// disc. p_is_counted: false for receivers whose count is not needed.
CountState start_count(CountSubject p_subject, int p_solids, bool p_is_counted) {
	const CountReceiver receiver = p_subject.receiver;
	CountState state = make_count_state(unpack_solid_count(p_solids));
	const uint cut_face_count = p_subject.is_receiver && p_is_counted ? find_cut_face_count() : 0u;
	for (uint i = 0u; i < cut_face_count; ++i) {
		const uint face = FETCH_UINT(cut_faces_buffer, i);
		const CountSectors sectors =
				find_cut_sectors(receiver, load_count_face(face), load_count_plane(face), (p_solids & 1) != 0);
		if (IS_CPU) {
			count_sectors(sectors, state);
		} else {
			state.area += find_lane() == 0u ? round_area(sectors) : 0;
			count_lane_sectors(sectors, state);
		}
	}
	return state;
}

/// Where counting starts: an index in the list, or without lists a packed cursor in the tree.
uint find_first_choice() {
	return HAS_NO_LIST ? pack_cursor(start_cursor(make_count_tree(/*p_has_faces=*/false))) : 0u;
}

/// Counts edges until all are counted, or no iterations are left. r_next: where to continue, see find_first_choice. Returns
/// true if edges remain, which is the same for all invocations of the subgroup.
bool count_edges(CountSubject p_subject, inout uint r_next, inout CountState r_state) {
	const CountBox box = make_leaf_box(
			p_subject.leaf, find_receiver_bounds(p_subject.warped, p_subject.is_receiver), light.disc_radius);
	const bool is_any = subgroup_any(p_subject.is_receiver);
	const CountLeafResult result = p_subject.result;
	const uint first_word = result.first_word + result.silhouette_count + result.face_count;
	// The list has each edge once at most.
	note_fault(!HAS_NO_LIST && is_any && result.edge_count > light.max_edge_count, EDGE_COUNT_FAULT_LIST);
	const uint end = HAS_NO_LIST ? CURSOR_AT_END : (is_any ? min(result.edge_count, light.max_edge_count) : 0u);
	r_next = HAS_NO_LIST && !is_any ? CURSOR_AT_END : r_next;
	do {
		chosen_count = 0u;
		if (HAS_NO_LIST) {
			choose_from_tree(box, r_next);
		} else {
			choose_from_list(first_word, end, box, r_next);
		}
		sync_subgroup_memory();
		if (IS_CPU) {
			count_slice_on_cpu(chosen_count, p_subject, r_state);
		} else {
			count_slice_on_gpu(chosen_count, p_subject, r_state);
		}
		sync_subgroup_memory();
		++iteration_count;
	} while (r_next < end && has_iterations_left());
	const bool is_unfinished = r_next < end;
	note_fault(is_unfinished && has_iterations_left(), EDGE_COUNT_FAULT_LOOP);
	return is_unfinished;
}

/// The visibility of a receiver whose edges are all counted.
float find_visibility(CountState p_state) {
	const ivec4 totals = add_lanes(ivec4(p_state.area, has_overlap(p_state) ? 1 : 0, 0, 0));
	CountSums sums = CountSums(0, 0, 0, 0);
	if (totals.y > 0 || !IS_CPU) { // llvmpipe alone saves time by the branch
		sums = add_sample_sets(p_state);
	}
	const ivec4 counts = add_lanes(ivec4(sums.hidden, sums.count, sums.square, sums.product));
	CountState state = p_state;
	state.area = totals.x;
	return find_visibility(state, totals.y > 0, CountSums(counts.x, counts.y, counts.z, counts.w));
}

/// Each invocation counts the edges of one receiver. r_is_unfinished: some were not counted, as no iterations were left.
CountState count_receiver(CountSubject p_subject, int p_solids, out bool r_is_unfinished) {
	CountState state = start_count(p_subject, p_solids, true);
	uint next = find_first_choice();
	r_is_unfinished = count_edges(p_subject, next, state);
	report_subgroup_status();
	return state;
}

#endif
