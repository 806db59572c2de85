#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/rungs_inc.glsl"

// Finds for each leaf what is between its receivers and the light: the faces that its anchor's way to the light's centre
// crosses, the faces that may pass between its receivers (local faces), the silhouette edges as seen from the light's
// centre that may do so, and the edges that may matter to any of its receivers. Then adds the leaf to the list of its
// kind. One subgroup per leaf; it walks through the trees of faces and of edges, and each invocation tests one node, face
// or edge at a time.
//
// Loops test at their ends, for the reason in count_resolve_inc.glsl: an iteration without anything to do has no effect.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_SUBGROUP_SIZE) in;
layout(std430, set = 0, binding = COUNT_BINDING_RESULTS) writeonly buffer Results {
	CountLeafResult results[];
};
layout(std430, set = 0, binding = COUNT_BINDING_LISTS) writeonly buffer Lists {
	uint lists[];
};
layout(std430, set = 0, binding = COUNT_BINDING_KINDS) writeonly buffer Kinds {
	uint kinds[]; // the leaves of each kind
};
layout(std430, set = 0, binding = COUNT_BINDING_STATUS) buffer Status {
	uint status[]; // EDGE_COUNT_STATUS_*
};

layout(push_constant) uniform Push {
	CountLeafPush push;
};

layout(constant_id = EDGE_COUNT_CONSTANT_IS_CPU) const bool IS_CPU = true;
layout(constant_id = EDGE_COUNT_CONSTANT_HAS_RUNGS) const bool HAS_RUNGS = false;
const uint GROUP_SIZE = gl_WorkGroupSize.x; // each work group is one subgroup
const uint SUBGROUP_SIZE = GROUP_SIZE;
#include "shadow_edge_count/leaf_tests_inc.glsl"
#include "shadow_edge_count/dispatches_inc.glsl"

const uint WIDTH = uint(EDGE_COUNT_NODE_WIDTH);
const uint CLUSTER_SIZE = uint(EDGE_COUNT_CLUSTER_SIZE);
const uint MAX_PARENTS = GROUP_SIZE < WIDTH ? 1u : GROUP_SIZE / WIDTH; // nodes whose children are tested together
// Nodes whose children are to be tested: level << NODE_LEVEL_SHIFT | index. MAX_PARENTS at a time are replaced by at most
// WIDTH as many at the level below, so there are fewer than MAX_PARENTS * WIDTH for each level.
const uint NODE_LEVEL_SHIFT = 28u;
const uint NODE_INDEX_MASK = (1u << NODE_LEVEL_SHIFT) - 1u;
shared uint open_nodes[MAX_PARENTS * WIDTH * uint(EDGE_COUNT_MAX_LEVELS + 1)];
uint open_count;
// Clusters whose faces or edges are to be tested. All are, before more nodes are if there may be no room for them.
const uint MAX_CLUSTERS = (IS_CPU ? 32u : 8u) + MAX_PARENTS * WIDTH;
shared uint clusters[MAX_CLUSTERS];
uint cluster_count;
// Edges within the reach of the leaf, which are to be examined. On a CPU all clusters are tested first.
const uint MAX_REACHED = IS_CPU ? MAX_CLUSTERS * CLUSTER_SIZE : 2u * GROUP_SIZE;
shared uint reached_edges[MAX_REACHED];
uint reached_count;
// The leaf's lists; counts include what does not fit. A list of entries that is longer is written in a second walk. On a
// GPU, all shared memory of a work group of 32 takes 5 KiB, so that AMD's compute units have room for six per SIMD unit.
const uint MAX_SHARED_ENTRIES = IS_CPU ? 1024u : 416u;
const uint MAX_SILHOUETTES = IS_CPU ? uint(EDGE_COUNT_MAX_SILHOUETTES) : 256u;
const uint MAX_LOCAL_FACES = IS_CPU ? uint(EDGE_COUNT_MAX_LOCAL_FACES) : 192u;
shared uint entries[MAX_SHARED_ENTRIES];
shared uint silhouettes[MAX_SILHOUETTES];
shared uint local_faces[MAX_LOCAL_FACES];
uint entry_count;
uint silhouette_count = 0u;
uint local_face_count = 0u;

CountReceiver anchor_receiver;
ivec3 crossings = ivec3(0); // of the anchor; each invocation has those of its faces
float min_fraction = COUNT_FAR; // of the entries, see find_min_fraction
// A leaf that needs more iterations than this gets no lists: its receivers walk through the trees themselves, in rounds
// (EDGE_COUNT_MAX_ITERATIONS). The limit is that of a CPU driver, see there. Two walks through the edges are possible, and
// the margin covers the iterations between two tests of the limit.
const uint MAX_ITERATIONS = 40000u;
uint iteration_count = 0u;
bool is_incomplete = false; // some walk did not reach its end
// Where the second walk writes; the first one keeps what fits.
bool writes_lists = false;
uint first_entry;

/// Appends p_value to a list in shared memory, which has r_count items and room for p_capacity; others are only counted.
#define APPEND(p_list, p_value, p_is_valid, p_capacity, r_count) \
	{ \
		const uvec4 valid = subgroup_ballot(p_is_valid); \
		const uint slot = r_count + subgroupBallotExclusiveBitCount(valid); \
		if (p_is_valid && slot < p_capacity) { \
			p_list[slot] = p_value; \
		} \
		r_count += subgroupBallotBitCount(valid); \
	}

/// Tests the children of the last open nodes: those that pass become open, or are added to `clusters`.
void open_next_nodes(CountTree p_tree, bool p_has_faces) {
	const uint parent_count = min(open_count, MAX_PARENTS);
	const uint first_parent = open_count - parent_count;
	// One iteration, unless a subgroup has fewer invocations than a node has children.
	const uint item = gl_SubgroupInvocationID;
	uint next_count = first_parent;
	// All parents are read before their slots are written.
	uint parents[MAX_PARENTS * WIDTH / GROUP_SIZE];
	for (uint i = 0u; i < MAX_PARENTS * WIDTH / GROUP_SIZE; ++i) {
		const uint parent = first_parent + (item + i * GROUP_SIZE) / WIDTH;
		parents[i] = open_nodes[min(parent, max(open_count, 1u) - 1u)];
	}
	sync_subgroup_memory();
	for (uint i = 0u; i < MAX_PARENTS * WIDTH / GROUP_SIZE; ++i) {
		const uint child_item = item + i * GROUP_SIZE;
		const uint level = (parents[i] >> NODE_LEVEL_SHIFT) - 1u;
		const uint index = (parents[i] & NODE_INDEX_MASK) * WIDTH + child_item % WIDTH;
		const bool exists = child_item / WIDTH < parent_count && index < find_node_count(p_tree.item_count, level);
		const CountNode node = load_count_node(p_tree, exists ? level : 0u, exists ? index : 0u);
		const bool passes = exists && may_matter(node, p_has_faces);
		APPEND(open_nodes, level << NODE_LEVEL_SHIFT | index, passes && level > 0u, open_nodes.length(), next_count)
		APPEND(clusters, index, passes && level == 0u, clusters.length(), cluster_count)
	}
	open_count = next_count;
	sync_subgroup_memory();
}

/// False if the face is outside the bounds of the leaf's receivers.
bool is_face_within_bounds(CountFaceRecord p_face) {
	const vec3 a = uintBitsToFloat(p_face.a_kind.xyz);
	const vec3 b = uintBitsToFloat(p_face.b_first_distance.xyz);
	const vec3 c = uintBitsToFloat(p_face.c_end_distance.xyz);
	return all(lessThanEqual(min(a, min(b, c)), hull_maximum)) && all(greaterThanEqual(max(a, max(b, c)), hull_minimum));
}

/// Tests a face of a cluster.
void test_face(uint p_face, bool p_is_valid) {
	const CountFaceRecord face = load_count_face(p_face);
	const vec4 plane = load_count_plane(p_face);
	const bool is_seen = p_is_valid && is_in_distance_range(hull_box.distance, face);
	const bool is_in_front = is_count_in_front(plane, anchor);
	if (is_seen && is_in_front != is_count_light_in_front(plane)) {
		crossings += count_face(anchor_receiver, face, is_in_front);
	}
	const bool is_local = is_seen && is_local_face(hull_box, face, plane) && is_face_within_bounds(face);
	APPEND(local_faces, p_face, is_local, MAX_LOCAL_FACES, local_face_count)
}

/// Examines an edge within reach: lists it as a silhouette, as an entry, both or not at all.
void examine_edge(uint p_index, bool p_is_valid) {
	const CountEdgeRecord edge = load_count_edge(p_index);
	const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
	const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
	const bool is_seen = p_is_valid && is_in_distance_range(box.distance, edge) &&
			max(find_light_side(box, a), find_light_side(box, b)) >= 0;
	const uint packed_weight = find_packed_weight(box, make_count_kind(edge.a_face0.w, edge.b_face1.w),
			load_count_plane0(edge), load_count_plane1(edge));
	const bool is_used = is_seen && light.disc_radius > 0.0 && packed_weight != COUNT_ADDS_NOTHING;
	min_fraction = is_used ? min(min_fraction, find_min_fraction(box, a, b)) : min_fraction;
	const bool is_silhouette = is_seen && !writes_lists && any(notEqual(find_edge_change(edge), ivec3(0))) &&
			is_edge_in_reach(hull_box, a, b);
	APPEND(silhouettes, p_index, is_silhouette, MAX_SILHOUETTES, silhouette_count)
	const uint entry = p_index | packed_weight << COUNT_PACKED_WEIGHT_SHIFT;
	const uvec4 used = subgroup_ballot(is_used);
	const uint slot = entry_count + subgroupBallotExclusiveBitCount(used);
	if (is_used && writes_lists) {
		lists[min(first_entry + slot, light.list_capacity - 1u)] = entry;
	}
	if (is_used && !writes_lists && slot < MAX_SHARED_ENTRIES) {
		entries[slot] = entry;
	}
	entry_count += subgroupBallotBitCount(used);
}

/// Tests an edge of a cluster.
void test_edge(uint p_index, bool p_is_valid) {
	const CountEdgeRecord edge = load_count_edge(p_index);
	const bool is_reached =
			p_is_valid && is_edge_in_reach(box, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz));
	APPEND(reached_edges, p_index, is_reached, MAX_REACHED, reached_count)
}

/// Examines and removes all reached edges.
void examine_reached_edges() {
	sync_subgroup_memory();
	const uint count = min(reached_count, MAX_REACHED);
	note_fault(reached_count > MAX_REACHED, EDGE_COUNT_FAULT_LIST);
	uint first = 0u;
	do {
		const uint item = first + gl_SubgroupInvocationID;
		const bool is_valid = item < count;
		examine_edge(is_valid ? reached_edges[item] : 0u, is_valid);
		first += GROUP_SIZE;
		++iteration_count;
	} while (first < count);
	note_fault(first < count, EDGE_COUNT_FAULT_LOOP);
	reached_count = 0u;
	sync_subgroup_memory();
}

/// Tests the faces or edges of all clusters.
void test_clusters(CountTree p_tree, bool p_has_faces) {
	const uint item_count = cluster_count * CLUSTER_SIZE;
	uint first = 0u;
	do {
		// Each invocation loads a cluster, and the others get it by shuffles: llvmpipe loads from shared memory one
		// invocation after the other.
		const uint first_cluster = first / CLUSTER_SIZE;
		const uint loaded = clusters[min(first_cluster + gl_SubgroupInvocationID, MAX_CLUSTERS - 1u)];
		const uint end = min((first_cluster + GROUP_SIZE) * CLUSTER_SIZE, item_count);
		do {
			const uint item = first + gl_SubgroupInvocationID;
			const uint cluster = subgroupShuffle(loaded, (item / CLUSTER_SIZE - first_cluster) % GROUP_SIZE);
			const uint index = cluster * CLUSTER_SIZE + item % CLUSTER_SIZE;
			const bool is_valid = item < end && index < p_tree.item_count;
			if (p_has_faces) {
				test_face(is_valid ? index : 0u, is_valid);
			} else {
				test_edge(is_valid ? index : 0u, is_valid);
				if (!IS_CPU && reached_count > GROUP_SIZE) {
					examine_reached_edges();
				}
			}
			first += GROUP_SIZE;
			++iteration_count;
		} while (first < end);
		note_fault(first < end, EDGE_COUNT_FAULT_LOOP);
	} while (first < item_count);
	note_fault(first < item_count, EDGE_COUNT_FAULT_LOOP);
	cluster_count = 0u;
	sync_subgroup_memory();
}

/// Walks through a tree, and tests the faces or edges of the clusters that it finds.
void walk_tree(bool p_has_faces) {
	const CountTree tree = make_count_tree(p_has_faces);
	open_count = tree.item_count > 0u ? 1u : 0u;
	cluster_count = 0u;
	reached_count = 0u;
	if (gl_SubgroupInvocationID == 0u) {
		open_nodes[0] = tree.level_count << NODE_LEVEL_SHIFT; // its children are the highest level
	}
	sync_subgroup_memory();
	do {
		do {
			open_next_nodes(tree, p_has_faces);
			++iteration_count;
		} while (open_count > 0u && cluster_count + MAX_PARENTS * WIDTH <= MAX_CLUSTERS);
		test_clusters(tree, p_has_faces);
		if (!p_has_faces) {
			examine_reached_edges();
		}
		++iteration_count;
	} while (open_count > 0u && iteration_count < MAX_ITERATIONS);
	is_incomplete = is_incomplete || open_count > 0u;
}

/// Copies a list from shared memory.
#define COPY_LIST(p_list, p_count, p_first) \
	for (uint i = gl_SubgroupInvocationID; i < p_count; i += GROUP_SIZE) { \
		lists[p_first + i] = p_list[i]; \
	}

/// Reserves room for the lists, and copies those that are in shared memory. Sets first_entry. r_is_listed: there was room.
/// The result has no crossings.
CountLeafResult write_shared_lists(bool p_is_elected, out bool r_is_listed) {
	// A walk that writes a long list of entries takes as many iterations as the first one.
	is_incomplete = is_incomplete || (entry_count > MAX_SHARED_ENTRIES && 2u * iteration_count > MAX_ITERATIONS);
	const bool are_short = silhouette_count <= MAX_SILHOUETTES && local_face_count <= MAX_LOCAL_FACES;
	const uint word_count =
			is_incomplete ? 0u : entry_count + (are_short ? silhouette_count + local_face_count : 0u);
	uint first_word = 0u;
	if (p_is_elected && word_count > 0u) {
		first_word = atomicAdd(counts[EDGE_COUNT_COUNT_LIST_WORDS], word_count);
	}
	first_word = subgroupBroadcastFirst(first_word);
	// Above the capacity, the sum of all words may wrap around, but that of a leaf does not.
	r_is_listed = !is_incomplete && (word_count == 0u ||
			(first_word < light.list_capacity && word_count <= light.list_capacity - first_word));
	const bool has_all = are_short && r_is_listed;
	const CountLeafResult result = CountLeafResult(first_word, has_all ? silhouette_count : 0u,
			has_all ? local_face_count : 0u, r_is_listed ? entry_count : 0u, 0, 0, 0, has_all ? 0u : 1u);
	first_entry = first_word + result.silhouette_count + result.face_count;
	COPY_LIST(silhouettes, result.silhouette_count, first_word)
	COPY_LIST(local_faces, result.face_count, first_word + result.silhouette_count)
	const uint copied_count = entry_count <= MAX_SHARED_ENTRIES ? result.edge_count : 0u;
	COPY_LIST(entries, copied_count, first_entry)
	return result;
}

/// Adds the leaf's counts and faults to the status buffer.
void write_status(bool p_is_elected) {
	const uint faults = subgroup_or(count_faults);
	const uint iterations = subgroup_max(iteration_count);
	if (p_is_elected && iterations > 0u) {
		atomicAdd(status[EDGE_COUNT_STATUS_LEAVES], 1u);
		atomicMax(status[EDGE_COUNT_STATUS_LONGEST_WALK], iterations);
		atomicAdd(status[EDGE_COUNT_STATUS_LISTED_EDGES], entry_count);
		atomicMax(status[EDGE_COUNT_STATUS_LONGEST_LIST], entry_count);
		atomicOr(status[EDGE_COUNT_STATUS_FAULTS], faults << EDGE_COUNT_PASS_LIST_LEAVES);
	}
}

// Smooth leaves cannot continue in a further pass (EDGE_COUNT_MAX_ITERATIONS): with more edges, a leaf is not smooth.
const uint MAX_SMOOTH_EDGES = uint(EDGE_COUNT_MAX_ITERATIONS) / 2u; // an edge needs less than 1.5 iterations

/// Adds the cost of a leaf with edges to the sum of its class, which is returned.
uint add_leaf_cost(CountLeaf p_leaf, uint p_kind) {
	const bool is_smooth = p_kind == uint(EDGE_COUNT_LEAVES_SMOOTH);
	const bool is_extreme = p_kind == uint(EDGE_COUNT_LEAVES_UNLISTED) || entry_count > MAX_SMOOTH_EDGES;
	const uint receiver_count = is_smooth ? uint(EDGE_COUNT_FEW_PIXELS) : count_leaf_pixels(p_leaf);
	const uint pixels = uint(EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX);
	const uint cost = (receiver_count * (entry_count + uint(EDGE_COUNT_COST_OF_RECEIVER)) + pixels - 1u) / pixels;
	const uint cost_class =
			is_extreme ? uint(EDGE_COUNT_COST_EXTREME) : min(uint(findMSB(cost)), uint(EDGE_COUNT_COST_EXTREME) - 1u);
	atomicAdd(counts[uint(EDGE_COUNT_COUNT_COSTS) + cost_class], cost);
	atomicAdd(counts[uint(EDGE_COUNT_COUNT_COST_LEAVES) + cost_class], 1u);
	return cost_class;
}

void main() {
	load_count_constants();
	const uint leaf_count = find_chunk_size(min(counts[EDGE_COUNT_COUNT_ALL], light.leaf_capacity), push.chunk);
	const uint group = find_work_group();
	if (group >= leaf_count) {
		return;
	}
	const uint leaf_index = interleave_work(group, leaf_count) * light.chunk_count + push.chunk;
	const CountLeaf leaf = leaves[leaf_index];
	prepare_leaf_tests(leaf);
	anchor_receiver = make_count_receiver(light, anchor, leaf.axis_distance.w);
	walk_tree(/*p_has_faces=*/true);
	crossings = ivec3(subgroup_add(uint(crossings.x)), subgroup_add(uint(crossings.y)), subgroup_add(uint(crossings.z)));
	const bool is_elected = subgroupElect();
	CountLeafResult result;
	bool is_listed;
	do { // a loop, so that there is one copy of the code of a walk
		entry_count = 0u;
		walk_tree(/*p_has_faces=*/false);
		if (!writes_lists) {
			result = write_shared_lists(is_elected, is_listed);
		}
		writes_lists = !writes_lists && is_listed && entry_count > MAX_SHARED_ENTRIES;
	} while (writes_lists);
	const bool are_all_far = subgroup_all(min_fraction >= box.smooth_fraction);
	const bool is_smooth = (leaf.pixels_flags.z & EDGE_COUNT_LEAF_IS_SMOOTH) != 0u && local_face_count == 0u &&
			// A line along which a face cuts the disc moves as the disc turns to face other receivers.
			find_cut_face_count() == 0u && are_all_far && entry_count <= MAX_SMOOTH_EDGES && result.needs_rays == 0u;
	write_status(is_elected);
	if (is_elected) {
		const bool is_even = silhouette_count + local_face_count == 0u; // the same number of solids
		const bool has_no_edges = entry_count == 0u && find_cut_face_count() == 0u && !is_incomplete;
		uint kind = uint(is_smooth ? EDGE_COUNT_LEAVES_SMOOTH : EDGE_COUNT_LEAVES_LISTED);
		kind = is_listed ? kind : uint(EDGE_COUNT_LEAVES_UNLISTED);
		kind = entry_count > light.budget ? uint(EDGE_COUNT_LEAVES_FILTERED) : kind;
		kind = has_no_edges ? uint(is_even ? EDGE_COUNT_LEAVES_DARK : EDGE_COUNT_LEAVES_PLAIN) : kind;
		result.back_facing = crossings.x;
		result.light_facing = crossings.y;
		result.double_sided = crossings.z;
		results[leaf_index] = result;
		const bool has_cost = HAS_RUNGS && (kind == uint(EDGE_COUNT_LEAVES_LISTED) ||
				kind == uint(EDGE_COUNT_LEAVES_UNLISTED) || kind == uint(EDGE_COUNT_LEAVES_SMOOTH));
		const uint cost_class = has_cost ? add_leaf_cost(leaf, kind) : 0u;
		if (kind != uint(EDGE_COUNT_LEAVES_DARK) || sum_crossings(crossings) > 0) {
			kinds[kind * light.leaf_capacity + extend_dispatch(kind, kind)] =
					cost_class << EDGE_COUNT_KIND_LEAF_BITS | leaf_index;
		}
	}
}
