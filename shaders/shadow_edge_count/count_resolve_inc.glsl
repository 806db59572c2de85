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
	return texelFetch(masks_buffer, int(p_index * uint((COUNT_SAMPLE_SET_COUNT + 1) / 2) + p_pair));
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

/// The results of one pixel.
struct CountPixel {
	ivec2 pixel;
	bool is_receiver; // false: the others are meaningless
	uint edge_count; // edges that its receiver counted
	float visibility;
	int solid_count; // between the receiver and the light's centre
	bool is_unfinished; // some edges were not counted: no iterations were left
};

/// State of collecting the edges that a box's receivers may need.
struct CountChoice {
	uint next; // where to continue: index in the list, or without lists a packed cursor in the tree
	uint count; // of edges in the slice
};
const uint CURSOR_LEVEL_SHIFT = 28u; // of a packed cursor; below are bits of the index
const uint CURSOR_AT_END = 0xffffffffu;
const uint CURSOR_AT_START = 0xfffffffeu;

uint pack_cursor(TreeCursor p_cursor) {
	return p_cursor.is_at_end ? CURSOR_AT_END : p_cursor.level << CURSOR_LEVEL_SHIFT | p_cursor.index;
}

TreeCursor unpack_cursor(CountTree p_tree, uint p_packed) {
	const TreeCursor start = start_cursor(p_tree);
	const uint mask = (1u << CURSOR_LEVEL_SHIFT) - 1u;
	return p_packed == CURSOR_AT_START || p_packed == CURSOR_AT_END
			? TreeCursor(start.level, start.index, start.is_at_end || p_packed == CURSOR_AT_END)
			: TreeCursor(p_packed >> CURSOR_LEVEL_SHIFT, p_packed & mask, false);
}

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

/// Collects edges from the leaf's list, from p_first on. Ends when the slice may be full, or no iterations are left.
/// p_first_word: of the list. p_end: its number of entries.
CountChoice choose_from_list(uint p_first, uint p_first_word, uint p_end, CountBox p_box) {
	CountChoice choice = CountChoice(p_first, 0u);
	do {
		const uint index = choice.next + gl_SubgroupInvocationID;
		const bool is_valid = index < p_end;
		const uint entry = FETCH_UINT(lists_buffer, is_valid ? int(min(p_first_word + index, light.list_capacity - 1u)) : 0);
		const bool is_edge = (entry & COUNT_EDGE_MASK) < light.max_edge_count;
		note_fault(is_valid && !is_edge, EDGE_COUNT_FAULT_LIST);
		choose_edge(p_box, is_valid && is_edge ? entry : 0u, is_valid && is_edge, choice);
		choice.next += SUBGROUP_SIZE;
		++iteration_count;
	} while (choice.next < p_end && has_choice_room(choice, SUBGROUP_SIZE) && has_iterations_left());
	return choice;
}

/// Adds the edges of a cluster.
void choose_from_cluster(CountBox p_box, uint p_cluster, uint p_edge_count, bool p_is_valid, inout CountChoice r_choice) {
	const uint size = uint(EDGE_COUNT_CLUSTER_SIZE);
	uint first = 0u;
	// One iteration if a subgroup has 16 invocations or more.
	do {
		const uint index = first + gl_SubgroupInvocationID;
		const uint edge = p_cluster * size + index;
		const bool is_valid = p_is_valid && index < size && edge < p_edge_count;
		const bool is_seen = is_valid && is_in_distance_range(p_box.distance, load_count_edge(is_valid ? edge : 0u));
		choose_edge(p_box, is_valid ? edge : 0u, is_seen, r_choice);
		first += SUBGROUP_SIZE;
		++iteration_count;
	} while (first < size);
	note_inner_loop(first < size);
}

/// Collects edges from the tree, from a packed cursor on. Ends when the slice may be full, or no iterations are left.
/// Each step moves the cursor forward in a tree whose size is limited, whatever its nodes have, so the loop ends.
CountChoice choose_from_tree(uint p_first, CountBox p_box) {
	const CountTree tree = make_count_tree(/*p_has_faces=*/false);
	const uint width = min(uint(EDGE_COUNT_NODE_WIDTH), SUBGROUP_SIZE); // nodes that are tested together
	TreeCursor cursor = unpack_cursor(tree, p_first);
	CountChoice choice = CountChoice(p_first, 0u);
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
		choose_from_cluster(p_box, cursor.index, tree.item_count, is_cluster, choice);
		if (is_any && !is_cluster) {
			descend_cursor(cursor);
		} else if (!cursor.is_at_end) {
			advance_cursor(tree, is_any ? cursor.index + 1u : first + width, cursor);
		}
		++iteration_count;
	} while (!cursor.is_at_end && has_choice_room(choice, uint(EDGE_COUNT_CLUSTER_SIZE)) && has_iterations_left());
	choice.next = pack_cursor(cursor);
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

#include "shadow_edge_count/count_slice_cpu_inc.glsl"
#include "shadow_edge_count/count_slice_gpu_inc.glsl"

/// Counts the edges of a slice for each receiver. p_count: number of edges. r_edge_count: is increased by the number that
/// the receiver counted.
void count_slice(uint p_count, CountSubject p_subject, inout CountState r_state, inout uint r_edge_count) {
	if (IS_CPU) {
		count_slice_on_cpu(p_count, p_subject, r_state, r_edge_count);
	} else {
		count_slice_on_gpu(p_count, p_subject, r_state, r_edge_count);
	}
}

/// The state before any edge is counted: the solids before the light's centre, and the lines along which faces cut the
/// disc. p_is_counted: false for receivers whose count is not needed.
CountState start_count(CountSubject p_subject, CountSolids p_solids, bool p_is_counted) {
	const CountReceiver receiver = p_subject.receiver;
	CountState state = make_count_state(p_solids.count);
	const uint cut_face_count = p_subject.is_receiver && p_is_counted ? find_cut_face_count() : 0u;
	for (uint i = 0u; i < cut_face_count; ++i) {
		const uint face = load_cut_face(i);
		const CountSectors sectors =
				find_cut_sectors(receiver, load_count_face(face), load_count_plane(face), p_solids.is_light_inside);
		if (IS_CPU) {
			count_sectors(sectors, state);
		} else {
			state.area += find_lane() == 0u ? round_area(sectors) : 0;
			count_lane_sectors(sectors, state);
		}
	}
	return state;
}

/// How far a subgroup has counted its receivers' edges.
struct CountProgress {
	bool waits; // edges of the invocation's receiver remain to be counted
	uint next;	// see CountChoice
};

CountProgress start_progress(CountSubject p_subject) {
	return CountProgress(p_subject.is_receiver, HAS_NO_LIST ? CURSOR_AT_START : 0u);
}

/// Counts edges until all are counted, or no iterations are left. r_edge_count: is increased by the number of edges that
/// the receiver counted.
void count_edges(CountSubject p_subject, inout CountState r_state, inout CountProgress r_progress,
		inout uint r_edge_count) {
	const CountBox box = make_uniform_box(make_count_box(light, light.disc_radius,
			make_count_frame(p_subject.leaf.axis_distance.xyz),
			find_receiver_bounds(p_subject.warped, p_subject.is_receiver), p_subject.leaf.axis_distance.w,
			is_wide_leaf(p_subject.leaf)));
	const bool is_any = subgroup_any(r_progress.waits);
	const CountLeafResult result = p_subject.result;
	const uint first_word = result.first_word + result.silhouette_count + result.face_count;
	// The list has each edge once at most.
	note_fault(!HAS_NO_LIST && is_any && result.edge_count > light.max_edge_count, EDGE_COUNT_FAULT_LIST);
	const uint end = HAS_NO_LIST ? CURSOR_AT_END : (is_any ? min(result.edge_count, light.max_edge_count) : 0u);
	uint next = HAS_NO_LIST && !is_any ? CURSOR_AT_END : r_progress.next;
	do {
		CountChoice choice;
		if (HAS_NO_LIST) {
			choice = choose_from_tree(next, box);
		} else {
			choice = choose_from_list(next, first_word, end, box);
		}
		next = choice.next;
		sync_subgroup_memory();
		count_slice(choice.count, p_subject, r_state, r_edge_count);
		sync_subgroup_memory();
		++iteration_count;
	} while (next < end && has_iterations_left());
	const bool is_done = next >= end;
	note_fault(!is_done && has_iterations_left(), EDGE_COUNT_FAULT_LOOP);
	r_progress.waits = r_progress.waits && !is_done;
	r_progress.next = next;
}

CountPixel make_count_pixel(CountSubject p_subject, CountState p_state, CountProgress p_progress, uint p_edge_count) {
	const float visibility = IS_CPU ? count_resolve(p_state) : resolve_lanes(p_state);
	return CountPixel(p_subject.pixel, p_subject.is_receiver, p_edge_count, visibility, p_state.solid_count,
			p_progress.waits);
}

/// Each invocation counts the edges of one receiver and computes its visibility.
CountPixel count_pixel(CountSubject p_subject, CountSolids p_solids) {
	CountState state = start_count(p_subject, p_solids, true);
	CountProgress progress = start_progress(p_subject);
	uint edge_count = 0u;
	count_edges(p_subject, state, progress, edge_count);
	report_subgroup_status();
	return make_count_pixel(p_subject, state, progress, edge_count);
}

#endif
