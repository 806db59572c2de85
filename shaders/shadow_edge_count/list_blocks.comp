#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

layout(set = 0, binding = COUNT_BINDING_LIGHT) uniform Light {
	CountLightConstants light;
};

#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/count_bundles_inc.glsl"

// For each block of pixels the edges that may matter to any of its receivers, view by view, in their own order;
// then the block goes to those of its kind. One subgroup deals with one tile of blocks: first it finds the edges
// that may matter to the tile, then tests each block with these.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) in;
layout(std430, set = 0, binding = COUNT_BINDING_BOXES) readonly buffer Boxes {
	CountBlockBox boxes[];
};
layout(std430, set = 0, binding = COUNT_BINDING_PRESENT) readonly buffer Present {
	uint present_boxes[];
};
layout(std430, set = 0, binding = COUNT_BINDING_CHAINS) writeonly buffer Chains {
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

const uint MOST_BOXES = uint(EDGE_COUNT_BOXES_PER_BLOCK);
const uint BLOCKS_PER_TILE = uint(EDGE_COUNT_BLOCKS_PER_TILE_SIDE * EDGE_COUNT_BLOCKS_PER_TILE_SIDE);
const uint BOXES_PER_TILE = BLOCKS_PER_TILE * MOST_BOXES;
const uint NO_BLOCK = 0xffffffffu;

// llvmpipe ends every loop once an invocation has made 65535 iterations, of all its loops together. A tile that would
// need more gets no lists. The margin is more than what is done between two checks.
const uint MOST_ITERATIONS = 40000u;
uint iteration_count = 0u;

/// Receivers in one view: in either of two boxes, or in the first alone.
struct BoxPair {
	CountBox near;
	CountBox far;
	uint count;
};

uint find_block(uvec2 p_tile, uint p_index) {
	const uint side = uint(EDGE_COUNT_BLOCKS_PER_TILE_SIDE);
	const uvec2 block = p_tile * side + uvec2(p_index % side, p_index / side);
	return all(lessThan(block, light.block_count)) ? block.y * light.block_count.x + block.x : NO_BLOCK;
}

/// One of the boxes of the tile's blocks in a view; empty where it is not there.
CountBounds load_box(uvec2 p_tile, uint p_view, uint p_index) {
	const uint block = find_block(p_tile, p_index / MOST_BOXES);
	const uint box = p_index % MOST_BOXES;
	const bool is_there = p_index < BOXES_PER_TILE && block != NO_BLOCK &&
			(present_boxes[min(block, light.block_count.x * light.block_count.y - 1u)] >>
							(MOST_BOXES * p_view + box) &
					1u) != 0u;
	const uint place = is_there ? (block * light.view_count + p_view) * MOST_BOXES + box : 0u;
	const CountBlockBox loaded = boxes[place];
	return is_there ? unpack_count_bounds(loaded) : make_count_bounds();
}

/// Least and greatest w of the tile's receivers in a view.
vec2 find_w_range_of_tile(uvec2 p_tile, uint p_view) {
	vec2 w = vec2(COUNT_FAR, -COUNT_FAR);
	for (uint i = gl_SubgroupInvocationID; i < BOXES_PER_TILE; i += gl_SubgroupSize) {
		const CountBounds box = load_box(p_tile, p_view, i);
		const vec2 range = find_w_range(box);
		w = is_count_bounds_empty(box) ? w : vec2(min(w.x, range.x), max(w.y, range.y));
	}
	return vec2(subgroupMin(w.x), subgroupMax(w.y));
}

/// The bounds of those boxes of the tile's blocks whose middle w lies in a range, about the plane of the first;
/// each invocation has some of the boxes.
CountBounds find_bounds(uvec2 p_tile, uint p_view, float p_least_w, float p_greatest_w) {
	CountBounds bounds = make_count_bounds();
	for (uint i = gl_SubgroupInvocationID; i < BOXES_PER_TILE; i += gl_SubgroupSize) {
		const CountBounds box = load_box(p_tile, p_view, i);
		const vec2 w = find_w_range(box);
		const float middle = 0.5 * (w.x + w.y);
		const bool is_here =
				!is_count_bounds_empty(box) && middle >= p_least_w && middle < p_greatest_w;
		bounds = is_here ? join_count_bounds(bounds, box) : bounds;
	}
	const bool is_empty = is_count_bounds_empty(bounds);
	const uvec4 filled = subgroupBallot(!is_empty);
	const uint leader = subgroupBallotBitCount(filled) > 0u ? subgroupBallotFindLSB(filled) : 0u;
	const vec2 slope = subgroupBroadcast(bounds.slope, leader);
	const vec2 range = is_empty ? bounds.range : find_range_about(bounds, slope);
	return CountBounds(subgroupMin(bounds.least), subgroupMax(bounds.greatest), slope,
			vec2(subgroupMin(range.x), subgroupMax(range.y)));
}

BoxPair make_pair(uint p_view, CountBounds p_near, CountBounds p_far) {
	const CountViewConstants view = light.views[p_view];
	BoxPair pair;
	pair.near = make_count_box(light, view, is_count_bounds_empty(p_near) ? p_far : p_near);
	pair.far = make_count_box(light, view, is_count_bounds_empty(p_far) ? p_near : p_far);
	pair.count = is_count_bounds_empty(p_near) || is_count_bounds_empty(p_far) ? 1u : 2u;
	return pair;
}

BoxPair find_tile_pair(uvec2 p_tile, uint p_view) {
	const vec2 w = find_w_range_of_tile(p_tile, p_view);
	const float middle = 0.5 * (w.x + w.y);
	return make_pair(p_view, find_bounds(p_tile, p_view, middle, COUNT_FAR),
			find_bounds(p_tile, p_view, -COUNT_FAR, middle));
}

// Bundles that may matter to the tile, in their order; and edges of them that may.
const uint MOST_WANTED = 512u;
shared uint wanted_bundles[MOST_WANTED];
const uint MOST_HELD = 1024u;
shared uint held_edges[MOST_HELD];

/// The list of a block that is being written.
struct Chain {
	uint first;
	uint chunk; // the last one
	uint edge_count;
};
shared Chain block_chains[BLOCKS_PER_TILE]; // in one view
shared uint block_edge_counts[BLOCKS_PER_TILE]; // in all views
shared uint blocks_have_room[BLOCKS_PER_TILE];

/// Puts bundles from r_next on into wanted_bundles, until all are tested or there may be no room, and
/// returns how many.
uint choose_bundles(BoxPair p_pair, uint p_bundle_count, inout uint r_next) {
	uint count = 0u;
	do {
		const uint bundle = r_next + gl_SubgroupInvocationID;
		const CountEdgeBundle loaded = load_count_bundle(min(bundle, p_bundle_count - 1u));
		bool is_wanted = bundle < p_bundle_count && may_use_bundle(p_pair.near, loaded);
		bool is_open = bundle < p_bundle_count && !is_wanted && p_pair.count > 1u;
		while (is_open) { // not a branch: software drivers run what a branch skips
			is_wanted = may_use_bundle(p_pair.far, loaded);
			is_open = false;
		}
		const uvec4 wanted = subgroupBallot(is_wanted);
		if (is_wanted) {
			wanted_bundles[count + subgroupBallotExclusiveBitCount(wanted)] = bundle;
		}
		count += subgroupBallotBitCount(wanted);
		r_next += gl_SubgroupSize;
		iteration_count += 2u;
	} while (r_next < p_bundle_count && count + gl_SubgroupSize <= MOST_WANTED &&
			iteration_count < MOST_ITERATIONS);
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	return count;
}

bool is_in_reach_of_pair(BoxPair p_pair, vec3 p_a, vec3 p_b) {
	bool is_in_reach = is_edge_in_reach(p_pair.near, p_a, p_b);
	bool is_open = !is_in_reach && p_pair.count > 1u;
	while (is_open) { // not a branch: software drivers run what a branch skips
		is_in_reach = is_edge_in_reach(p_pair.far, p_a, p_b);
		is_open = false;
	}
	return is_in_reach;
}

/// An edge, as a list has it. r_is_used: false where it adds nothing to any receiver of the block.
uint test_edge(BoxPair p_pair, uint p_index, out bool r_is_used) {
	const CountEdgeRecord edge = load_count_edge(p_index);
	const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
	const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
	const bool is_in_reach = is_in_reach_of_pair(p_pair, a, b);
	uint known = 0u;
	ivec2 sides = ivec2(1);
	bool is_tested = !is_in_reach;
	while (!is_tested) { // not a branch
		const CountEdgeKind kind = make_count_kind(edge.a_face0.w, edge.b_face1.w);
		const vec4 plane0 = load_count_plane0(edge);
		const vec4 plane1 = load_count_plane1(edge);
		// Where there is one box, `far` is the same.
		const uint known_far = find_known_weight(p_pair.far, kind, plane0, plane1);
		const ivec2 sides_far = ivec2(find_light_side(p_pair.far, a), find_light_side(p_pair.far, b));
		known = find_known_weight(p_pair.near, kind, plane0, plane1);
		known = known == known_far ? known : 0u;
		sides = ivec2(find_light_side(p_pair.near, a), find_light_side(p_pair.near, b));
		sides = sides == sides_far ? sides : ivec2(0);
		is_tested = true;
	}
	r_is_used = is_in_reach && known != COUNT_ADDS_NOTHING && max(sides.x, sides.y) >= 0;
	return p_index | known << COUNT_KNOWN_SHIFT;
}

/// Appends the entries of those invocations that use theirs.
void append_edges(uint p_entry, bool p_is_used, inout Chain r_chain) {
	const uint size = uint(EDGE_COUNT_CHUNK_SIZE);
	const uvec4 used = subgroupBallot(p_is_used);
	const uint begin = r_chain.edge_count % size;
	const uint end = begin + subgroupBallotBitCount(used);
	uint chunk = r_chain.chunk;
	const bool is_full = end > begin && (begin == 0u || end > size);
	if (is_full && subgroupElect()) {
		chunk = atomicAdd(dispatches[EDGE_COUNT_DISPATCH_CHUNKS], 1u);
		if (r_chain.edge_count > 0u && max(r_chain.chunk, chunk) < light.chunk_capacity) {
			lists[light.chunk_capacity * size + r_chain.chunk] = chunk;
		}
	}
	chunk = subgroupBroadcastFirst(chunk);
	const uint place = begin + subgroupBallotExclusiveBitCount(used);
	const uint target = begin == 0u || place >= size ? chunk : r_chain.chunk;
	if (p_is_used && target < light.chunk_capacity) {
		lists[target * size + place % size] = p_entry;
	}
	r_chain.first = r_chain.edge_count == 0u ? chunk : r_chain.first;
	r_chain.chunk = chunk;
	r_chain.edge_count += end - begin;
}

/// Gives the held edges to the lists of those blocks that need them.
void share_edges(uvec2 p_tile, uint p_view, uint p_held_count) {
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	for (uint i = 0u; p_held_count > 0u && i < BLOCKS_PER_TILE; ++i) {
		const CountBounds near = load_box(p_tile, p_view, MOST_BOXES * i + uint(EDGE_COUNT_BOX_NEAR));
		const CountBounds far = load_box(p_tile, p_view, MOST_BOXES * i + uint(EDGE_COUNT_BOX_FAR));
		const bool is_empty = is_count_bounds_empty(near) && is_count_bounds_empty(far);
		const BoxPair pair = make_pair(p_view, near, far);
		Chain chain = block_chains[i];
		for (uint first = 0u; !is_empty && first < p_held_count; first += gl_SubgroupSize) {
			const uint item = first + gl_SubgroupInvocationID;
			bool is_used;
			const uint entry = test_edge(pair, held_edges[min(item, p_held_count - 1u)], is_used);
			append_edges(entry, is_used && item < p_held_count, chain);
			iteration_count += 3u;
		}
		if (subgroupElect()) {
			block_chains[i] = chain;
		}
	}
	subgroupMemoryBarrierShared();
	subgroupBarrier();
}

/// Lists those edges of the chosen bundles that the tile's blocks need.
void list_bundles(BoxPair p_pair, uvec2 p_tile, uint p_view, uint p_wanted_count, uint p_edge_count) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint item_count = p_wanted_count * size;
	uint first = 0u;
	while (first < item_count && iteration_count < MOST_ITERATIONS) {
		uint held_count = 0u;
		do {
			const uint item = first + gl_SubgroupInvocationID;
			const uint place = min(item, item_count - 1u);
			const uint index = wanted_bundles[place / size] * size + place % size;
			const CountEdgeRecord edge = load_count_edge(min(index, p_edge_count - 1u));
			const bool is_held = item < item_count && index < p_edge_count &&
					is_in_reach_of_pair(p_pair, uintBitsToFloat(edge.a_face0.xyz),
							uintBitsToFloat(edge.b_face1.xyz));
			const uvec4 held = subgroupBallot(is_held);
			if (is_held) {
				held_edges[held_count + subgroupBallotExclusiveBitCount(held)] = index;
			}
			held_count += subgroupBallotBitCount(held);
			first += gl_SubgroupSize;
			iteration_count += 2u;
		} while (first < item_count && held_count + gl_SubgroupSize <= MOST_HELD);
		share_edges(p_tile, p_view, held_count);
	}
}

/// Lists the edges of one view.
void list_view(uvec2 p_tile, uint p_view) {
	const uint edge_count = find_edge_count();
	const uint bundle_count = find_bundle_count(edge_count);
	for (uint i = gl_SubgroupInvocationID; i < BLOCKS_PER_TILE; i += gl_SubgroupSize) {
		block_chains[i] = Chain(0u, 0u, 0u);
	}
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	const BoxPair pair = find_tile_pair(p_tile, p_view);
	for (uint next = 0u; next < bundle_count && iteration_count < MOST_ITERATIONS;) {
		const uint wanted_count = choose_bundles(pair, bundle_count, next);
		list_bundles(pair, p_tile, p_view, wanted_count, edge_count);
	}
	for (uint i = gl_SubgroupInvocationID; i < BLOCKS_PER_TILE; i += gl_SubgroupSize) {
		const uint block = find_block(p_tile, i);
		const Chain chain = block_chains[i];
		if (block != NO_BLOCK) {
			const uint place = (block * light.view_count + p_view) * uint(EDGE_COUNT_CHAIN_WORDS);
			chains[place + uint(EDGE_COUNT_CHAIN_FIRST)] = chain.first;
			chains[place + uint(EDGE_COUNT_CHAIN_COUNT)] = chain.edge_count;
		}
		block_edge_counts[i] += chain.edge_count;
		// Chunks are taken in the order of their numbers: the last one has room where all have.
		blocks_have_room[i] &= chain.edge_count == 0u || chain.chunk < light.chunk_capacity ? 1u : 0u;
	}
}

/// Puts the block into the list of its kind. In no order: what a block's pixels get does not depend on it.
void add_block(uint p_block, uint p_kind) {
	const uint first = 3u * p_kind;
	const uint place = atomicAdd(dispatches[first], 1u);
	blocks[p_kind * light.block_count.x * light.block_count.y + place] = p_block;
	dispatches[first + 1u] = 1u;
	dispatches[first + 2u] = 1u;
}

void main() {
	const uvec2 tile = uvec2(gl_WorkGroupID.x, find_work_row());
	uint views = 0u;
	for (uint i = gl_SubgroupInvocationID; i < BLOCKS_PER_TILE; i += gl_SubgroupSize) {
		const uint block = find_block(tile, i);
		views |= block == NO_BLOCK ? 0u : present_boxes[block];
		block_edge_counts[i] = 0u;
		blocks_have_room[i] = 1u;
	}
	views = subgroupOr(views);
	views = (views | views >> 1) & 0x555u;
	while (views != 0u && iteration_count < MOST_ITERATIONS) {
		list_view(tile, uint(findLSB(views)) / MOST_BOXES);
		views &= views - 1u;
	}
	for (uint i = gl_SubgroupInvocationID; i < BLOCKS_PER_TILE; i += gl_SubgroupSize) {
		const uint block = find_block(tile, i);
		if (block != NO_BLOCK) {
			const uint edge_count = block_edge_counts[i];
			const bool is_whole = iteration_count < MOST_ITERATIONS;
			uint kind = is_whole && blocks_have_room[i] != 0u ? uint(EDGE_COUNT_BLOCKS_LISTED)
															  : uint(EDGE_COUNT_BLOCKS_UNLISTED);
			kind = edge_count > light.budget ? uint(EDGE_COUNT_BLOCKS_FILTERED) : kind;
			add_block(block, is_whole && edge_count == 0u ? uint(EDGE_COUNT_BLOCKS_PLAIN) : kind);
		}
	}
}
