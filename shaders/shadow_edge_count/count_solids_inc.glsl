// The numbers of faces on the way from a leaf's receivers to the light's centre, found from those of its anchor.
#ifndef COUNT_SOLIDS_INC_GLSL
#define COUNT_SOLIDS_INC_GLSL

#include "shadow_edge_count/count_subject_inc.glsl"
#include "shadow_edge_count/count_sweep_inc.glsl"

/// A word of the leaf's lists. p_index: from the leaf's first word on.
uint load_list_word(CountSubject p_subject, uint p_index) {
	return FETCH_UINT(lists_buffer, min(p_subject.result.first_word + p_index, light.list_capacity - 1u));
}

/// Adds the changes from the anchor across the leaf's silhouettes. Each invocation examines one of them for the whole
/// subgroup, and those that may be between its receivers and the anchor are passed to all by shuffles.
void add_silhouette_changes(CountSubject p_subject, CountReceiver p_anchor, CountBox p_hull, Sweep p_sweep,
		inout ivec3 r_changes, inout bool r_is_undecided) {
	const uint count = min(p_subject.result.silhouette_count, uint(EDGE_COUNT_MAX_SILHOUETTES));
	note_fault(p_subject.result.silhouette_count > count, EDGE_COUNT_FAULT_LIST);
	uint first = 0u;
	do {
		const uint item = first + gl_SubgroupInvocationID;
		const uint index = load_list_word(p_subject, item);
		note_fault(item < count && index >= light.max_edge_count, EDGE_COUNT_FAULT_LIST);
		const CountEdgeRecord edge = load_count_edge(index);
		const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
		const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
		const ivec3 change = find_edge_change(edge);
		const SweptEdge swept = make_swept_edge(p_anchor.position, a, b);
		const int left_of_anchor = find_left_sign(p_anchor, a, b);
		uvec4 left = subgroup_ballot(item < count && is_edge_in_reach(p_hull, a, b));
		do {
			const bool is_valid = subgroupBallotBitCount(left) != 0u;
			const uint lane = is_valid ? subgroupBallotFindLSB(left) : 0u;
			left[lane / 32u] &= ~(1u << (lane & 31u));
			const SweptEdge shared_edge = SweptEdge(subgroupShuffle(swept.a, lane), subgroupShuffle(swept.b, lane),
					subgroupShuffle(swept.normal, lane), subgroupShuffle(swept.lengths, lane));
			const int left_sign = find_left_sign(p_subject.receiver, subgroupShuffle(a, lane), subgroupShuffle(b, lane));
			bool is_undecided = false;
			const int crossing = find_edge_crossing(
					p_sweep, shared_edge, subgroupShuffle(left_of_anchor, lane), left_sign, is_undecided);
			r_changes += is_valid ? crossing * subgroupShuffle(change, lane) : ivec3(0);
			r_is_undecided = r_is_undecided || (is_valid && is_undecided);
		} while (subgroupBallotBitCount(left) != 0u);
		first += SUBGROUP_SIZE;
	} while (first < count);
	note_fault(first < count, EDGE_COUNT_FAULT_LOOP);
}

/// Adds the changes from the anchor across the leaf's local faces. As in add_silhouette_changes, each invocation examines
/// one of them for the whole subgroup.
void add_face_changes(
		CountSubject p_subject, CountBox p_hull, Sweep p_sweep, inout ivec3 r_changes, inout bool r_is_undecided) {
	const uint count = min(p_subject.result.face_count, uint(EDGE_COUNT_MAX_LOCAL_FACES));
	note_fault(p_subject.result.face_count > count, EDGE_COUNT_FAULT_LIST);
	const vec3 anchor = p_subject.leaf.anchor_block.xyz;
	uint first = 0u;
	do {
		const uint item = first + gl_SubgroupInvocationID;
		const uint index = load_list_word(p_subject, p_subject.result.silhouette_count + item);
		note_fault(item < count && index >= light.face_count, EDGE_COUNT_FAULT_LIST);
		uvec4 left = subgroup_ballot(
				item < count && is_local_face(p_hull, load_count_face(index), load_count_plane(index)));
		do {
			const bool is_valid = subgroupBallotBitCount(left) != 0u;
			const uint lane = is_valid ? subgroupBallotFindLSB(left) : 0u;
			left[lane / 32u] &= ~(1u << (lane & 31u));
			const uint face = subgroupShuffle(index, lane);
			bool is_undecided = false;
			const ivec3 change = find_face_change(anchor, p_subject.receiver.position, p_sweep, load_count_face(face),
					load_count_plane(face), is_undecided);
			r_changes += is_valid ? change : ivec3(0);
			r_is_undecided = r_is_undecided || (is_valid && is_undecided);
		} while (subgroupBallotBitCount(left) != 0u);
		first += SUBGROUP_SIZE;
	} while (first < count);
	note_fault(first < count, EDGE_COUNT_FAULT_LOOP);
}

/// The faces on a receiver's way to the light's centre. All invocations must be active.
ivec3 count_subject_crossings(CountSubject p_subject) {
	const vec3 anchor = p_subject.leaf.anchor_block.xyz;
	const vec3 position = p_subject.receiver.position;
	const CountReceiver anchor_receiver = make_count_receiver(light, anchor, p_subject.leaf.axis_distance.w);
	CountBounds bounds = find_receiver_bounds(p_subject.warped, p_subject.is_receiver);
	add_to_bounds(
			warp_to_frame(make_count_frame(p_subject.leaf.axis_distance.xyz), light.depth_far_m, anchor), true, bounds);
	const CountBox hull = make_leaf_box(p_subject.leaf, bounds, 0.0);
	const Sweep sweep = make_sweep(anchor, position);
	ivec3 changes = ivec3(0);
	bool is_undecided = false;
	add_silhouette_changes(p_subject, anchor_receiver, hull, sweep, changes, is_undecided);
	add_face_changes(p_subject, hull, sweep, changes, is_undecided);
	const bool is_anchor = position == anchor;
	const bool needs_ray = p_subject.is_receiver && (p_subject.result.needs_rays != 0u || (is_undecided && !is_anchor));
	const ivec3 along_ray = count_along_ray(p_subject.receiver, needs_ray);
	ray_count += needs_ray && gl_SubgroupInvocationID % LANES_PER_RECEIVER == 0u ? 1u : 0u;
	const CountLeafResult result = p_subject.result;
	const ivec3 of_anchor = ivec3(result.back_facing, result.light_facing, result.double_sided);
	return needs_ray ? along_ray : of_anchor + (is_anchor ? ivec3(0) : changes);
}

#endif
