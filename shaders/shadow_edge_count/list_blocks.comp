#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

#include "shadow_edge_count/count_constants_inc.glsl"
#include "shadow_edge_count/box_solids_inc.glsl"
#include "shadow_edge_count/count_bundles_inc.glsl"
#include "shadow_edge_count/count_parts_inc.glsl"

#define LIT_TILES_BINDING MAP_RESOLVE_BINDING_TILES
#include "common/lit_tiles_inc.glsl"

// Lists, for each part of a block's receivers, the edges that may matter to any of them, in the order of the light's
// list. Then adds the block to the list of its kind. One subgroup processes one tile of blocks. First it finds the
// bundles of edges that may matter to the tile. If the tile has no more parts than blocks, it tests the edges of these
// bundles against the tile, and the remaining ones against the box of each part. Otherwise it tests the bundles against
// each part's box, and then the edges of the remaining ones. It does this for each light view.
//
// Loops test at their ends, for the reason in count_resolve_inc.glsl: an iteration without anything
// to do has no effect.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_SUBGROUP_SIZE) in;
layout(std430, set = 0, binding = COUNT_BINDING_BOXES) readonly buffer Boxes {
	CountBlockBox boxes[];
};
layout(std430, set = 0, binding = COUNT_BINDING_BLOCK_RECEIVERS) readonly buffer BlockReceivers {
	uint block_receivers[]; // per block, EDGE_COUNT_RECEIVERS_*
};
layout(std430, set = 0, binding = COUNT_BINDING_CHAINS) buffer Chains {
	uint chains[];
};
layout(std430, set = 0, binding = COUNT_BINDING_LISTS) writeonly buffer Lists {
	uint lists[];
};
layout(std430, set = 0, binding = COUNT_BINDING_BLOCKS) writeonly buffer Blocks {
	uint blocks[];
};
layout(std430, set = 0, binding = COUNT_BINDING_DISPATCHES) buffer Dispatches {
	uint dispatches[];
};
layout(std430, set = 0, binding = COUNT_BINDING_STATUS) buffer Status {
	uint status[]; // EDGE_COUNT_STATUS_*
};

const uint GROUP_SIZE = gl_WorkGroupSize.x; // each work group is one subgroup
const uint SUBGROUP_SIZE = GROUP_SIZE;
#include "shadow_edge_count/plane_fit_inc.glsl"

const uint BLOCKS_PER_TILE = uint(EDGE_COUNT_BLOCKS_PER_TILE_SIDE * EDGE_COUNT_BLOCKS_PER_TILE_SIDE);
const uint PARTS_PER_TILE = BLOCKS_PER_TILE * PART_COUNT;
const uint NO_BLOCK = 0xffffffffu;

// llvmpipe ends every loop after an invocation has made 65535 iterations in all its loops together. A tile that would
// need more than this limit gets no lists. The margin covers the iterations between two checks.
const uint MAX_ITERATIONS = 40000u;
uint iteration_count = 0u;

/// Counts an iteration of a loop. Call it in every loop.
void count_iteration() {
	++iteration_count;
}

bool has_iterations_left() {
	return iteration_count < MAX_ITERATIONS;
}

bool is_incomplete = false; // some loop did not reach its end

/// Call it after a loop: p_is_left is true if the loop's own condition would have continued it. Either no iterations were
/// left, or the driver ended it. The tile then gets no lists.
void check_end(bool p_is_left) {
	is_incomplete = is_incomplete || p_is_left;
}

// Of the parts that the invocation wrote, for the status buffer.
uint listed_edge_count = 0u;
uint longest_list = 0u;
// Smooth blocks cannot continue in a further pass (EDGE_COUNT_MAX_ITERATIONS): with more edges, a block is not smooth.
const uint MAX_SMOOTH_EDGES = uint(EDGE_COUNT_MAX_ITERATIONS) / 2u; // an edge needs less than 1.5 iterations

/// The tile's receivers in one view, divided into two boxes by w. If count is 1, both boxes are the same.
struct BoxPair {
	CountBox near;
	CountBox far;
	uint count;
};

/// The block with index p_index in a tile, or NO_BLOCK if it is outside the image.
uint find_block(uvec2 p_tile, uint p_index) {
	const uint side = uint(EDGE_COUNT_BLOCKS_PER_TILE_SIDE);
	const uvec2 block = p_tile * side + uvec2(p_index % side, p_index / side);
	return all(lessThan(block, light.block_count)) ? block.y * light.block_count.x + block.x : NO_BLOCK;
}

/// The block's word EDGE_COUNT_RECEIVERS_PARTS; 0 for NO_BLOCK.
uint load_parts(uint p_block) {
	return p_block != NO_BLOCK
			? block_receivers[p_block * uint(EDGE_COUNT_RECEIVERS_WORDS) + uint(EDGE_COUNT_RECEIVERS_PARTS)]
			: 0u;
}

/// Bit mask of the tile's parts in a view. Part i of a tile is part i / BLOCKS_PER_TILE of block i % BLOCKS_PER_TILE.
uint find_parts_of_tile(uvec2 p_tile, uint p_view) {
	uint parts_of_tile = 0u;
	for (uint i = gl_SubgroupInvocationID; i < BLOCKS_PER_TILE; i += GROUP_SIZE) {
		const uint parts = load_parts(find_block(p_tile, i));
		for (uint part = 0u; part < PART_COUNT; ++part) {
			const bool is_valid = (parts >> part & 1u) != 0u && find_part_view(parts, part) == p_view;
			parts_of_tile |= is_valid ? 1u << (part * BLOCKS_PER_TILE + i) : 0u;
		}
	}
	return subgroup_or(parts_of_tile);
}

/// The index of a part of the tile in the buffers that have one item per block and part.
uint find_part_index(uvec2 p_tile, uint p_index) {
	return find_block(p_tile, p_index % BLOCKS_PER_TILE) * PART_COUNT + p_index / BLOCKS_PER_TILE;
}

/// The bounds of a part of the tile; empty if the bit mask p_parts does not contain the part.
CountBounds load_box(uvec2 p_tile, uint p_parts, uint p_index) {
	const bool is_valid = p_index < PARTS_PER_TILE && (p_parts >> p_index & 1u) != 0u;
	const CountBlockBox loaded = boxes[is_valid ? find_part_index(p_tile, p_index) : 0u];
	return is_valid ? unpack_count_bounds(loaded) : make_count_bounds();
}

/// True if the bit mask p_parts contains a part from p_first on. Loops process GROUP_SIZE parts per iteration.
bool is_part_left(uint p_parts, uint p_first) {
	return p_first < PARTS_PER_TILE && p_parts >> p_first != 0u;
}

/// The range of w of the parts in the bit mask p_parts.
vec2 find_w_range_of_tile(uvec2 p_tile, uint p_parts) {
	vec2 w = vec2(COUNT_FAR, -COUNT_FAR);
	uint first = 0u;
	do {
		const CountBounds box = load_box(p_tile, p_parts, first + gl_SubgroupInvocationID);
		w = vec2(min(w.x, box.w_range.x), max(w.y, box.w_range.y)); // no change if it is empty
		first += GROUP_SIZE;
	} while (is_part_left(p_parts, first));
	return vec2(subgroup_min(w.x), subgroup_max(w.y));
}

/// The joint bounds of the parts whose middle w is in p_min_w .. p_max_w, relative to the plane of one of them.
/// The parts are distributed over the invocations.
CountBounds find_bounds(uvec2 p_tile, uint p_parts, float p_min_w, float p_max_w) {
	CountBounds bounds = make_count_bounds();
	uint first = 0u;
	do {
		const CountBounds box = load_box(p_tile, p_parts, first + gl_SubgroupInvocationID);
		const float middle = 0.5 * (box.w_range.x + box.w_range.y);
		const bool is_selected =
				!is_count_bounds_empty(box) && middle >= p_min_w && middle < p_max_w;
		bounds = is_selected ? join_count_bounds(bounds, box) : bounds;
		first += GROUP_SIZE;
	} while (is_part_left(p_parts, first));
	const bool is_empty = is_count_bounds_empty(bounds);
	const uvec4 filled = subgroup_ballot(!is_empty);
	const uint leader = subgroupBallotBitCount(filled) > 0u ? subgroupBallotFindLSB(filled) : 0u;
	const vec2 slope = subgroupShuffle(bounds.slope, leader);
	bounds.range = is_empty ? bounds.range : find_range_about(bounds, slope);
	bounds.slope = slope;
	return find_subgroup_bounds(bounds);
}

BoxPair make_pair(uint p_view, CountBounds p_near, CountBounds p_far) {
	const CountViewConstants view = load_count_view(p_view);
	BoxPair pair;
	pair.near = make_count_box(light, view, is_count_bounds_empty(p_near) ? p_far : p_near);
	pair.far = make_count_box(light, view, is_count_bounds_empty(p_far) ? p_near : p_far);
	pair.count = is_count_bounds_empty(p_near) || is_count_bounds_empty(p_far) ? 1u : 2u;
	return pair;
}

/// Divides the tile's parts in a view at the middle of their range of w.
BoxPair find_tile_pair(uvec2 p_tile, uint p_view, uint p_parts) {
	const vec2 w = find_w_range_of_tile(p_tile, p_parts);
	const float middle = 0.5 * (w.x + w.y);
	return make_pair(p_view, find_bounds(p_tile, p_parts, middle, COUNT_FAR),
			find_bounds(p_tile, p_parts, -COUNT_FAR, middle));
}

// Bundles that may matter to the tile, in order. candidates: edges of them that may matter to the tile, or bundles that
// may matter to one part. What exceeds the size of an array is processed in a further round.
const uint MAX_NEEDED_BUNDLES = 512u;
shared uint needed_bundles[MAX_NEEDED_BUNDLES];
const uint MAX_CANDIDATES = 1024u;
shared uint candidates[MAX_CANDIDATES];
// Edges within the reach of a part's box.
const uint MAX_REACHED_EDGES = 512u;
shared uint reached_edges[MAX_REACHED_EDGES];

/// The list of a part while it is written.
struct Chain {
	uint first; // first chunk
	uint chunk; // last chunk
	uint edge_count;
	bool is_smooth; // all edges are far, see EDGE_COUNT_BLOCKS_SMOOTH
};
shared Chain part_chains[PARTS_PER_TILE]; // of the current view
shared float part_distances[PARTS_PER_TILE]; // EDGE_COUNT_CHAIN_DISTANCE
shared uint block_edge_counts[BLOCKS_PER_TILE]; // of all views
shared uint block_solids[BLOCKS_PER_TILE]; // flags, see find_box_solids
shared uint blocks_have_room[BLOCKS_PER_TILE];
shared uint blocks_are_smooth[BLOCKS_PER_TILE];

bool may_use_bundle(BoxPair p_pair, uint p_bundle) {
	const CountEdgeBundle bundle = load_count_bundle(p_bundle);
	return may_use_bundle(p_pair.near, bundle) || (p_pair.count > 1u && may_use_bundle(p_pair.far, bundle));
}

/// Collects in needed_bundles the bundles from r_next on that the tile may need, until all are tested or the next group
/// may not fit. Returns their number. r_next becomes the bundle to continue from.
uint choose_bundles(BoxPair p_pair, uint p_bundle_count, inout uint r_next) {
	const uint size = uint(EDGE_COUNT_BUNDLES_PER_GROUP);
	const uint group_count = (p_bundle_count + size - 1u) / size;
	uint count = 0u;
	bool has_room = true;
	do {
		const uint first_group = r_next / size;
		const uint group = first_group + gl_SubgroupInvocationID;
		const bool is_group = group < group_count;
		const bool is_group_needed =
				is_group && may_use_bundle(p_pair, is_group ? light.max_bundle_count + group : 0u);
		uvec4 groups = subgroup_ballot(is_group_needed);
		r_next += GROUP_SIZE * size;
		do {
			const bool is_valid = subgroupBallotBitCount(groups) != 0u;
			const uint lane = is_valid ? subgroupBallotFindLSB(groups) : 0u;
			groups[lane / 32u] &= ~(1u << (lane & 31u));
			has_room = count + size <= MAX_NEEDED_BUNDLES;
			if (is_valid && !has_room) {
				r_next = (first_group + lane) * size; // continue here next time
				groups = uvec4(0u);
			}
			uint first = (first_group + lane) * size;
			const uint end = is_valid && has_room ? min(first + size, p_bundle_count) : 0u;
			do {
				const uint bundle = first + gl_SubgroupInvocationID;
				const bool is_needed = bundle < end && may_use_bundle(p_pair, bundle < end ? bundle : 0u);
				const uvec4 needed = subgroup_ballot(is_needed);
				if (is_needed) {
					needed_bundles[count + subgroupBallotExclusiveBitCount(needed)] = bundle;
				}
				count += subgroupBallotBitCount(needed);
				first += GROUP_SIZE;
				count_iteration();
			} while (first < end);
			check_end(first < end);
			count_iteration();
		} while (subgroupBallotBitCount(groups) != 0u);
		check_end(subgroupBallotBitCount(groups) != 0u);
		count_iteration();
	} while (r_next < p_bundle_count && has_room && has_iterations_left());
	check_end(r_next < p_bundle_count && has_room);
	sync_subgroup_memory();
	return count;
}

/// Returns the list entry of an edge within the reach of a part's box. r_is_used: false if it adds nothing to any
/// receiver of the box, or is of a level of detail that they do not see. r_min_fraction: lowered to find_min_fraction of
/// the edge, if that is used.
uint make_entry(CountBox p_box, uint p_index, bool p_is_valid, out bool r_is_used, inout float r_min_fraction) {
	const CountEdgeRecord edge = load_count_edge(p_index);
	const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
	const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
	const uint packed_weight = find_packed_weight(p_box, make_count_kind(edge.a_face0.w, edge.b_face1.w),
			load_count_plane0(edge), load_count_plane1(edge));
	r_is_used = p_is_valid && is_in_distance_range(p_box.distances.x, edge) &&
			packed_weight != COUNT_ADDS_NOTHING && max(find_light_side(p_box, a), find_light_side(p_box, b)) >= 0;
	r_min_fraction = r_is_used ? min(r_min_fraction, find_min_fraction(p_box, a, b)) : r_min_fraction;
	return p_index | packed_weight << COUNT_PACKED_WEIGHT_SHIFT;
}

/// Appends the entries of all invocations with p_is_used to the list.
void append_edges(uint p_entry, bool p_is_used, inout Chain r_chain) {
	const uint size = uint(EDGE_COUNT_CHUNK_SIZE);
	const uvec4 used = subgroup_ballot(p_is_used);
	const uint begin = r_chain.edge_count % size;
	const uint end = begin + subgroupBallotBitCount(used);
	uint chunk = r_chain.chunk;
	const bool needs_chunk = end > begin && (begin == 0u || end > size);
	if (needs_chunk) {
		if (subgroupElect()) {
			chunk = atomicAdd(dispatches[EDGE_COUNT_DISPATCH_CHUNKS], 1u);
			if (r_chain.edge_count > 0u && max(r_chain.chunk, chunk) < light.chunk_capacity) {
				lists[light.chunk_capacity * size + r_chain.chunk] = chunk;
			}
		}
		chunk = subgroupBroadcastFirst(chunk);
	}
	const uint slot = begin + subgroupBallotExclusiveBitCount(used);
	const uint target = begin == 0u || slot >= size ? chunk : r_chain.chunk;
	if (p_is_used && target < light.chunk_capacity) {
		lists[target * size + slot % size] = p_entry;
	}
	r_chain.first = r_chain.edge_count == 0u ? chunk : r_chain.first;
	r_chain.chunk = chunk;
	r_chain.edge_count += end - begin;
}

/// Collects in candidates those of the tile's needed bundles that a part may need. Returns their number.
uint collect_part_bundles(CountBox p_box, uint p_needed_count) {
	uint count = 0u;
	uint first = 0u;
	do {
		const uint item = first + gl_SubgroupInvocationID;
		const uint bundle = item < p_needed_count ? needed_bundles[item] : 0u;
		const bool is_used = item < p_needed_count && may_use_bundle(p_box, load_count_bundle(bundle));
		const uvec4 used = subgroup_ballot(is_used);
		if (is_used) {
			candidates[count + subgroupBallotExclusiveBitCount(used)] = bundle;
		}
		count += subgroupBallotBitCount(used);
		first += GROUP_SIZE;
		count_iteration();
	} while (first < p_needed_count);
	check_end(first < p_needed_count);
	sync_subgroup_memory();
	return count;
}

/// Collects in reached_edges the edges within the reach of a part's box, from item r_first on, until all are tested or
/// the next ones may not fit. Returns their number. candidates has the edges, or their bundles if p_has_bundles.
uint collect_reached_edges(CountBox p_box, bool p_has_bundles, uint p_edge_count, inout uint r_first) {
	const uint shift = p_has_bundles ? uint(findMSB(EDGE_COUNT_BUNDLE_SIZE)) : 0u; // log2 of a candidate's edges
	const uint light_edge_count = find_edge_count();
	uint count = 0u;
	do {
		// Each invocation loads a candidate, and the others get it by shuffles: llvmpipe loads from shared memory one
		// invocation after the other.
		const uint first_candidate = r_first >> shift;
		const uint loaded = candidates[min(first_candidate + gl_SubgroupInvocationID, MAX_CANDIDATES - 1u)];
		const uint end = min((first_candidate + GROUP_SIZE) << shift, p_edge_count);
		do {
			const uint item = r_first + gl_SubgroupInvocationID;
			const uint candidate = subgroupShuffle(loaded, ((item >> shift) - first_candidate) % GROUP_SIZE);
			const uint index = (candidate << shift) + (item & (1u << shift) - 1u);
			const bool is_valid = item < end && index < light_edge_count;
			const CountEdgeRecord edge = load_count_edge(is_valid ? index : 0u);
			const bool is_reached = is_valid &&
					is_edge_in_reach(p_box, uintBitsToFloat(edge.a_face0.xyz), uintBitsToFloat(edge.b_face1.xyz));
			const uvec4 reached = subgroup_ballot(is_reached);
			if (is_reached) {
				reached_edges[count + subgroupBallotExclusiveBitCount(reached)] = index;
			}
			count += subgroupBallotBitCount(reached);
			r_first += GROUP_SIZE;
			count_iteration();
		} while (r_first < end && count + GROUP_SIZE <= MAX_REACHED_EDGES);
		check_end(r_first < end && count + GROUP_SIZE <= MAX_REACHED_EDGES);
		count_iteration();
	} while (r_first < p_edge_count && count + GROUP_SIZE <= MAX_REACHED_EDGES);
	check_end(r_first < p_edge_count && count + GROUP_SIZE <= MAX_REACHED_EDGES);
	sync_subgroup_memory();
	return count;
}

/// Tests p_edge_count edges and lists those that a part may need; see collect_reached_edges.
void list_candidates(CountBox p_box, bool p_has_bundles, uint p_edge_count,
		inout float r_min_fraction, inout Chain r_chain) {
	uint next = 0u;
	do {
		const uint count = collect_reached_edges(p_box, p_has_bundles, p_edge_count, next);
		uint first = 0u;
		do {
			const uint item = first + gl_SubgroupInvocationID;
			const bool is_valid = item < count;
			bool is_used;
			const uint entry =
					make_entry(p_box, is_valid ? reached_edges[item] : 0u, is_valid, is_used, r_min_fraction);
			append_edges(entry, is_used, r_chain);
			first += GROUP_SIZE;
			count_iteration();
		} while (first < count);
		check_end(first < count);
		sync_subgroup_memory();
		count_iteration();
	} while (next < p_edge_count && has_iterations_left());
	check_end(next < p_edge_count);
}

/// Lists for each part the edges that it may need, out of p_needed_count bundles in needed_bundles or of
/// p_candidate_edge_count edges in candidates. One of the two numbers is 0.
void list_parts(uvec2 p_tile, uint p_view, uint p_parts, uint p_needed_count, uint p_candidate_edge_count) {
	sync_subgroup_memory();
	const bool has_bundles = p_needed_count > 0u;
	uint parts = p_needed_count + p_candidate_edge_count > 0u ? p_parts : 0u;
	do {
		const bool is_valid = parts != 0u;
		const uint i = is_valid ? uint(findLSB(parts)) : 0u;
		CountBox box = make_count_box(light, load_count_view(p_view), load_box(p_tile, p_parts, i));
		box.distances = vec2(part_distances[i]);
		Chain chain = part_chains[i];
		float min_fraction = COUNT_FAR;
		const uint bundle_count = collect_part_bundles(box, is_valid ? p_needed_count : 0u);
		const uint edge_count = has_bundles ? bundle_count * uint(EDGE_COUNT_BUNDLE_SIZE) : p_candidate_edge_count;
		list_candidates(box, has_bundles, is_valid ? edge_count : 0u, min_fraction, chain);
		chain.is_smooth = chain.is_smooth && subgroup_all(min_fraction >= box.smooth_fraction);
		if (is_valid && gl_SubgroupInvocationID == 0u) {
			part_chains[i] = chain;
		}
		count_iteration();
		parts &= parts - 1u;
	} while (parts != 0u && has_iterations_left());
	check_end(parts != 0u);
	sync_subgroup_memory();
}

/// Collects in candidates the edges of needed_bundles that the tile may need, from r_first on, until all are tested or
/// the next ones may not fit. Returns their number. r_first becomes the edge to continue from.
uint collect_tile_edges(BoxPair p_pair, uint p_item_count, inout uint r_first) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint light_edge_count = find_edge_count();
	uint count = 0u;
	do {
		const uint first_bundle = r_first / size; // see collect_reached_edges
		const uint loaded = needed_bundles[min(first_bundle + gl_SubgroupInvocationID, MAX_NEEDED_BUNDLES - 1u)];
		const uint end = min((first_bundle + GROUP_SIZE) * size, p_item_count);
		do {
			const uint item = r_first + gl_SubgroupInvocationID;
			const uint bundle = subgroupShuffle(loaded, (item / size - first_bundle) % GROUP_SIZE);
			const uint index = bundle * size + item % size;
			const bool is_valid = item < end && index < light_edge_count;
			const CountEdgeRecord edge = load_count_edge(is_valid ? index : 0u);
			const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
			const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
			const bool is_candidate = is_valid &&
					(is_edge_in_reach(p_pair.near, a, b) || (p_pair.count > 1u && is_edge_in_reach(p_pair.far, a, b)));
			const uvec4 candidate = subgroup_ballot(is_candidate);
			if (is_candidate) {
				candidates[count + subgroupBallotExclusiveBitCount(candidate)] = index;
			}
			count += subgroupBallotBitCount(candidate);
			r_first += GROUP_SIZE;
			count_iteration();
		} while (r_first < end && count + GROUP_SIZE <= MAX_CANDIDATES);
		check_end(r_first < end && count + GROUP_SIZE <= MAX_CANDIDATES);
		count_iteration();
	} while (r_first < p_item_count && count + GROUP_SIZE <= MAX_CANDIDATES);
	check_end(r_first < p_item_count && count + GROUP_SIZE <= MAX_CANDIDATES);
	return count;
}

/// Lists for each part the edges of needed_bundles that it may need.
void list_bundles(BoxPair p_pair, uvec2 p_tile, uint p_view, uint p_parts, uint p_needed_count) {
	const bool has_split_block = uint(bitCount(p_parts)) > BLOCKS_PER_TILE; // some block has several parts
	const uint item_count = has_split_block ? 0u : p_needed_count * uint(EDGE_COUNT_BUNDLE_SIZE);
	uint first = 0u;
	do {
		const uint candidate_edge_count = collect_tile_edges(p_pair, item_count, first);
		list_parts(p_tile, p_view, p_parts, has_split_block ? p_needed_count : 0u, candidate_edge_count);
		count_iteration();
	} while (first < item_count && has_iterations_left());
	check_end(first < item_count);
}

/// Looks for faces that may separate receivers of a part. Sets the flags of block_solids from parts without edges. If
/// such a face is in a part with edges, the block is not smooth. One invocation per part.
void check_faces_of_view(uvec2 p_tile, uint p_view, uint p_parts) {
	uint first = 0u;
	do {
		const uint i = first + gl_SubgroupInvocationID;
		const CountBounds bounds = load_box(p_tile, p_parts, i);
		const uint block = i % BLOCKS_PER_TILE;
		const bool has_edges = part_chains[min(i, PARTS_PER_TILE - 1u)].edge_count > 0u;
		// A light of size 0 lists no edges, but its shadows have borders.
		const bool is_needed = !is_count_bounds_empty(bounds) && light.max_edge_count > 0u &&
				(!has_edges || blocks_are_smooth[block] != 0u);
		if (is_needed) {
			const uint solids = find_box_solids(p_view, part_distances[i], bounds);
			atomicOr(block_solids[block], has_edges ? 0u : solids);
			atomicAnd(blocks_are_smooth[block], has_edges && solids == MAY_VARY ? 0u : 1u);
		}
		// The steps of has_no_separating_face, and of count_solids, which walks one of its lists.
		iteration_count += 2u * subgroup_max(step_count) + 1u;
		step_count = 0u;
		first += GROUP_SIZE;
	} while (is_part_left(p_parts, first));
	check_end(is_part_left(p_parts, first));
}

/// Loads the distances of the tile's parts, 0 for parts without receivers.
void load_distances_of_tile(uvec2 p_tile) {
	for (uint i = gl_SubgroupInvocationID; i < PARTS_PER_TILE; i += GROUP_SIZE) {
		const uint block = find_block(p_tile, i % BLOCKS_PER_TILE);
		const bool is_valid = (load_parts(block) & (1u << i / BLOCKS_PER_TILE)) != 0u;
		const uint word = is_valid
				? find_part_index(p_tile, i) * uint(EDGE_COUNT_CHAIN_WORDS) + uint(EDGE_COUNT_CHAIN_DISTANCE)
				: 0u;
		part_distances[i] = is_valid ? uintBitsToFloat(chains[word]) : 0.0;
	}
	sync_subgroup_memory();
}

/// The range of the distances of the tile's parts in a view.
vec2 find_distances_of_tile(uint p_parts) {
	vec2 distances = vec2(COUNT_FAR, -COUNT_FAR);
	for (uint i = gl_SubgroupInvocationID; i < PARTS_PER_TILE; i += GROUP_SIZE) {
		const bool is_valid = (p_parts >> i & 1u) != 0u;
		distances.x = is_valid ? min(distances.x, part_distances[i]) : distances.x;
		distances.y = is_valid ? max(distances.y, part_distances[i]) : distances.y;
	}
	return vec2(subgroup_min(distances.x), subgroup_max(distances.y));
}

/// Lists the edges that the tile's receivers in one view may need.
void list_view(uvec2 p_tile, uint p_view) {
	const uint bundle_count = find_bundle_count(find_edge_count());
	for (uint i = gl_SubgroupInvocationID; i < PARTS_PER_TILE; i += GROUP_SIZE) {
		part_chains[i] = Chain(0u, 0u, 0u, true);
	}
	sync_subgroup_memory();
	const uint parts = find_parts_of_tile(p_tile, p_view);
	BoxPair pair = find_tile_pair(p_tile, p_view, parts);
	pair.near.distances = find_distances_of_tile(parts);
	pair.far.distances = pair.near.distances;
	uint next = 0u;
	do {
		const uint needed_count = choose_bundles(pair, bundle_count, next);
		list_bundles(pair, p_tile, p_view, parts, needed_count);
		count_iteration();
	} while (next < bundle_count && has_iterations_left());
	check_end(next < bundle_count);
	uint first = 0u;
	do {
		const uint i = first + gl_SubgroupInvocationID;
		if (i < PARTS_PER_TILE && (parts >> i & 1u) != 0u) {
			const Chain chain = part_chains[i];
			const uint first_word = find_part_index(p_tile, i) * uint(EDGE_COUNT_CHAIN_WORDS);
			chains[first_word + uint(EDGE_COUNT_CHAIN_FIRST)] = chain.first;
			chains[first_word + uint(EDGE_COUNT_CHAIN_COUNT)] = chain.edge_count;
			atomicAdd(block_edge_counts[i % BLOCKS_PER_TILE], chain.edge_count);
			listed_edge_count += chain.edge_count;
			longest_list = max(longest_list, chain.edge_count);
			// Chunks are allocated in increasing order: if the last one fits, all do.
			if (chain.edge_count > 0u && chain.chunk >= light.chunk_capacity) {
				blocks_have_room[i % BLOCKS_PER_TILE] = 0u;
			}
			if (!chain.is_smooth) {
				blocks_are_smooth[i % BLOCKS_PER_TILE] = 0u;
			}
		}
		first += GROUP_SIZE;
	} while (is_part_left(parts, first));
	check_end(is_part_left(parts, first));
	sync_subgroup_memory();
	check_faces_of_view(p_tile, p_view, parts);
}

/// Adds the tile's counts and faults to the status buffer.
void write_status() {
	const uint listed = subgroup_add(listed_edge_count);
	const uint longest = subgroup_max(longest_list);
	const uint faults = subgroup_or(count_faults);
	const bool is_elected = subgroupElect();
	if (is_elected && (listed | faults) != 0u) {
		atomicAdd(status[EDGE_COUNT_STATUS_LISTED_EDGES], listed);
		atomicMax(status[EDGE_COUNT_STATUS_LONGEST_LIST], longest);
		atomicOr(status[EDGE_COUNT_STATUS_FAULTS], faults << EDGE_COUNT_PASS_LIST_BLOCKS);
	}
}

/// Adds a block to the list of its kind. The order is arbitrary and does not affect the mask.
void add_block(uint p_block, uint p_kind) {
	const uint first = 3u * p_kind; // of the three arguments of the kind's dispatch
	const uint slot = atomicAdd(dispatches[first], 1u);
	blocks[p_kind * light.block_count.x * light.block_count.y + slot] = p_block;
	dispatches[first + 1u] = 1u;
	dispatches[first + 2u] = 1u;
}

void main() {
	load_light();
	bool is_valid;
	const uvec2 tile = find_lit_tile(light.block_count * uint(EDGE_COUNT_BLOCK_PX), is_valid);
	if (!is_valid) {
		return;
	}
	uint views = 0u;
	for (uint i = gl_SubgroupInvocationID; i < BLOCKS_PER_TILE; i += GROUP_SIZE) {
		const uint parts = load_parts(find_block(tile, i));
		const uint view = 1u << (parts >> EDGE_COUNT_VIEW_SHIFT & EDGE_COUNT_VIEW_MASK);
		views |= (parts & EDGE_COUNT_IS_SORTED) != 0u ? view : parts & EDGE_COUNT_PARTS_MASK;
		block_edge_counts[i] = 0u;
		blocks_have_room[i] = 1u;
		// A line along which a face cuts the disc moves as the disc turns to face other receivers.
		blocks_are_smooth[i] = (parts & EDGE_COUNT_IS_SMOOTH) != 0u && find_cut_face_count() == 0u ? 1u : 0u;
		block_solids[i] = (parts & EDGE_COUNT_IS_PARTLY_LIT) != 0u ? SOME_ARE_LIT : 0u;
	}
	views = subgroup_or(views);
	load_distances_of_tile(tile);
	do {
		list_view(tile, views != 0u ? uint(findLSB(views)) : 0u);
		views &= views - 1u;
	} while (views != 0u && has_iterations_left());
	check_end(views != 0u);
	sync_subgroup_memory();
	for (uint i = gl_SubgroupInvocationID; i < BLOCKS_PER_TILE; i += GROUP_SIZE) {
		const uint block = find_block(tile, i);
		if (block != NO_BLOCK) {
			const uint edge_count = block_edge_counts[i];
			const uint solids = block_solids[i];
			const bool is_tested = has_iterations_left() && !is_incomplete; // all edges of the tile
			const bool is_smooth = blocks_are_smooth[i] != 0u && edge_count <= MAX_SMOOTH_EDGES;
			uint kind = uint(is_smooth ? EDGE_COUNT_BLOCKS_SMOOTH : EDGE_COUNT_BLOCKS_LISTED);
			kind = is_tested && blocks_have_room[i] != 0u ? kind : uint(EDGE_COUNT_BLOCKS_UNLISTED);
			kind = edge_count > light.budget ? uint(EDGE_COUNT_BLOCKS_FILTERED) : kind;
			const bool has_nothing = is_tested && edge_count == 0u && find_cut_face_count() == 0u;
			// All receivers see the same number of solids: at most one of SOME_ARE_LIT and SOME_ARE_DARK, not MAY_VARY.
			const bool is_even = has_nothing && light.max_edge_count > 0u && solids <= SOME_ARE_DARK;
			kind = has_nothing ? uint(is_even ? EDGE_COUNT_BLOCKS_DARK : EDGE_COUNT_BLOCKS_PLAIN) : kind;
			if (!is_even || solids == SOME_ARE_DARK) {
				add_block(block, kind);
			}
		}
	}
	write_status();
}
