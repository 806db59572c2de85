#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

layout(set = 0, binding = COUNT_BINDING_LIGHT) uniform Light {
	CountLightConstants light;
};

#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/count_bundles_inc.glsl"
#include "shadow_edge_count/count_parts_inc.glsl"

// For each part of a block's receivers the edges that may matter to any of them, in their own order; then the block
// goes to those of its kind. One subgroup deals with one tile of blocks: first it finds the bundles of edges that may
// matter to the tile. Where there are few parts, all of like depth, it tests the edges of these for the tile, and those
// that are left for the box of each part; else the bundles for each part, and the edges of those that are left.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) in;
layout(std430, set = 0, binding = COUNT_BINDING_BOXES) readonly buffer Boxes {
	CountBlockBox boxes[];
};
layout(std430, set = 0, binding = COUNT_BINDING_RECEIVES) readonly buffer Receives {
	uint receives[]; // of each block, EDGE_COUNT_RECEIVES_*
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

const uint GROUP_SIZE = gl_WorkGroupSize.x;
const uint BLOCKS_PER_TILE = uint(EDGE_COUNT_BLOCKS_PER_TILE_SIDE * EDGE_COUNT_BLOCKS_PER_TILE_SIDE);
const uint PARTS_PER_TILE = BLOCKS_PER_TILE * PART_COUNT;
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

/// The first of the words of EDGE_COUNT_RECEIVES_*.
uint load_parts(uint p_block) {
	return p_block != NO_BLOCK
			? receives[p_block * uint(EDGE_COUNT_RECEIVES_WORDS) + uint(EDGE_COUNT_RECEIVES_PARTS)]
			: 0u;
}

/// Part i of the tile is part i / BLOCKS_PER_TILE of block i % BLOCKS_PER_TILE; a bit for each that is in the view.
uint find_parts_of_tile(uvec2 p_tile, uint p_view) {
	uint parts_of_tile = 0u;
	for (uint i = gl_SubgroupInvocationID; i < BLOCKS_PER_TILE; i += GROUP_SIZE) {
		const uint parts = load_parts(find_block(p_tile, i));
		for (uint part = 0u; part < PART_COUNT; ++part) {
			const bool is_there = (parts >> part & 1u) != 0u && find_part_view(parts, part) == p_view;
			parts_of_tile |= is_there ? 1u << (part * BLOCKS_PER_TILE + i) : 0u;
		}
	}
	return subgroupOr(parts_of_tile);
}

/// The place of a part of the tile in the buffers that have one item for each.
uint find_part_place(uvec2 p_tile, uint p_index) {
	return find_block(p_tile, p_index % BLOCKS_PER_TILE) * PART_COUNT + p_index / BLOCKS_PER_TILE;
}

/// The box of one of the parts of the tile; empty where p_parts does not have it.
CountBounds load_box(uvec2 p_tile, uint p_parts, uint p_index) {
	const bool is_there = p_index < PARTS_PER_TILE && (p_parts >> p_index & 1u) != 0u;
	const CountBlockBox loaded = boxes[is_there ? find_part_place(p_tile, p_index) : 0u];
	return is_there ? unpack_count_bounds(loaded) : make_count_bounds();
}

/// Least and greatest w of parts.
vec2 find_w_range_of_tile(uvec2 p_tile, uint p_parts) {
	vec2 w = vec2(COUNT_FAR, -COUNT_FAR);
	for (uint i = 0u; i < PARTS_PER_TILE && p_parts >> i != 0u; i += GROUP_SIZE) {
		const CountBounds box = load_box(p_tile, p_parts, i + gl_SubgroupInvocationID);
		const vec2 range = find_w_range(box);
		w = is_count_bounds_empty(box) ? w : vec2(min(w.x, range.x), max(w.y, range.y));
	}
	return vec2(subgroupMin(w.x), subgroupMax(w.y));
}

/// The bounds of those boxes of parts whose middle w lies in a range, about the plane of the first; each
/// invocation has some of the boxes.
CountBounds find_bounds(uvec2 p_tile, uint p_parts, float p_least_w, float p_greatest_w) {
	CountBounds bounds = make_count_bounds();
	for (uint i = 0u; i < PARTS_PER_TILE && p_parts >> i != 0u; i += GROUP_SIZE) {
		const CountBounds box = load_box(p_tile, p_parts, i + gl_SubgroupInvocationID);
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

BoxPair find_tile_pair(uvec2 p_tile, uint p_view, uint p_parts) {
	const vec2 w = find_w_range_of_tile(p_tile, p_parts);
	const float middle = 0.5 * (w.x + w.y);
	return make_pair(p_view, find_bounds(p_tile, p_parts, middle, COUNT_FAR),
			find_bounds(p_tile, p_parts, -COUNT_FAR, middle));
}

// Bundles that may matter to the tile, in their order; and edges of them that may.
const uint MOST_WANTED = 512u;
shared uint wanted_bundles[MOST_WANTED];
const uint MOST_HELD = 1024u;
shared uint held_edges[MOST_HELD];

/// The list of a part that is being written.
struct Chain {
	uint first;
	uint chunk; // the last one
	uint edge_count;
	bool is_smooth; // no edge is near, see EDGE_COUNT_BLOCKS_SMOOTH
};
shared Chain part_chains[PARTS_PER_TILE]; // in one view
shared uint block_edge_counts[BLOCKS_PER_TILE]; // in all views
// A sum of what is known of the solids between a block's receivers and the light's centre.
const uint SOME_ARE_LIT = 1u;
const uint SOME_ARE_DARK = 2u;
const uint MAY_VARY = 4u;
shared uint block_solids[BLOCKS_PER_TILE];
shared uint blocks_have_room[BLOCKS_PER_TILE];
shared uint blocks_are_smooth[BLOCKS_PER_TILE];

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
		r_next += GROUP_SIZE;
		iteration_count += 2u;
	} while (r_next < p_bundle_count && count + GROUP_SIZE <= MOST_WANTED &&
			iteration_count < MOST_ITERATIONS);
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	return count;
}

/// An edge, as a list has it. r_is_used: false where it adds nothing to any receiver of the box. r_least_share: the
/// least of find_least_share.
uint test_edge(CountBox p_box, uint p_index, out bool r_is_used, inout float r_least_share) {
	const CountEdgeRecord edge = load_count_edge(p_index);
	const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
	const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
	const bool is_in_reach = is_edge_in_reach(p_box, a, b) &&
			max(find_light_side(p_box, a), find_light_side(p_box, b)) >= 0;
	uint known = 0u;
	bool is_tested = !is_in_reach;
	while (!is_tested) { // not a branch: software drivers run what a branch skips
		known = find_known_weight(p_box, make_count_kind(edge.a_face0.w, edge.b_face1.w),
				load_count_plane0(edge), load_count_plane1(edge));
		r_least_share = known != COUNT_ADDS_NOTHING ? min(r_least_share, find_least_share(p_box, a, b)) : r_least_share;
		is_tested = true;
	}
	r_is_used = is_in_reach && known != COUNT_ADDS_NOTHING;
	return p_index | known << COUNT_KNOWN_SHIFT;
}

/// Appends the entries of those invocations that use theirs.
void append_edges(uint p_entry, bool p_is_used, inout Chain r_chain) {
	const uint size = uint(EDGE_COUNT_CHUNK_SIZE);
	const uvec4 used = subgroupBallot(p_is_used);
	const uint begin = r_chain.edge_count % size;
	const uint end = begin + subgroupBallotBitCount(used);
	uint chunk = r_chain.chunk;
	bool is_full = end > begin && (begin == 0u || end > size);
	while (is_full) { // not a branch: software drivers run what a branch skips
		if (subgroupElect()) {
			chunk = atomicAdd(dispatches[EDGE_COUNT_DISPATCH_CHUNKS], 1u);
			if (r_chain.edge_count > 0u && max(r_chain.chunk, chunk) < light.chunk_capacity) {
				lists[light.chunk_capacity * size + r_chain.chunk] = chunk;
			}
		}
		chunk = subgroupBroadcastFirst(chunk);
		is_full = false;
	}
	const uint place = begin + subgroupBallotExclusiveBitCount(used);
	const uint target = begin == 0u || place >= size ? chunk : r_chain.chunk;
	if (p_is_used && target < light.chunk_capacity) {
		lists[target * size + place % size] = p_entry;
	}
	r_chain.first = r_chain.edge_count == 0u ? chunk : r_chain.first;
	r_chain.chunk = chunk;
	r_chain.edge_count += end - begin;
}

/// Tests the edges of a bundle.
void list_bundle(
		CountBox p_box, uint p_bundle, uint p_edge_count, inout float r_least_share, inout Chain r_chain) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	uint i = gl_SubgroupInvocationID;
	do {
		const uint index = p_bundle * size + i;
		const bool is_there = i < size && index < p_edge_count;
		bool is_used;
		const uint entry = test_edge(p_box, is_there ? index : p_edge_count - 1u, is_used, r_least_share);
		append_edges(entry, is_there && is_used, r_chain);
		i += GROUP_SIZE;
	} while (i - gl_SubgroupInvocationID < size);
	iteration_count += 3u * (size / GROUP_SIZE + 1u);
}

/// Lists those edges of the chosen bundles that a part needs.
void list_part(CountBox p_box, uint p_wanted_count, uint p_edge_count, inout float r_least_share,
		inout Chain r_chain) {
	for (uint first = 0u; first < p_wanted_count; first += GROUP_SIZE) {
		const uint item = first + gl_SubgroupInvocationID;
		const uint bundle = wanted_bundles[min(item, p_wanted_count - 1u)];
		const uvec4 used = subgroupBallot(item < p_wanted_count && may_use_bundle(p_box, load_count_bundle(bundle)));
		uvec2 left = used.xy;
		while ((left.x | left.y) != 0u) {
			const uint lane = left.x != 0u ? uint(findLSB(left.x)) : 32u + uint(findLSB(left.y));
			left = left.x != 0u ? uvec2(left.x & (left.x - 1u), left.y) : uvec2(0u, left.y & (left.y - 1u));
			list_bundle(p_box, wanted_bundles[first + lane], p_edge_count, r_least_share, r_chain);
		}
		++iteration_count;
	}
}

/// Lists held edges that a part needs.
void list_held(CountBox p_box, uint p_held_count, inout float r_least_share, inout Chain r_chain) {
	for (uint first = 0u; first < p_held_count; first += GROUP_SIZE) {
		const uint item = first + gl_SubgroupInvocationID;
		bool is_used;
		const uint entry = test_edge(p_box, held_edges[min(item, p_held_count - 1u)], is_used, r_least_share);
		append_edges(entry, is_used && item < p_held_count, r_chain);
		iteration_count += 3u;
	}
}

/// Lists what each part needs of the chosen bundles and of the held edges; one of both numbers is 0.
void list_parts(uvec2 p_tile, uint p_view, uint p_parts, uint p_wanted_count, uint p_held_count) {
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	const uint edge_count = find_edge_count();
	uint parts = p_wanted_count + p_held_count > 0u ? p_parts : 0u;
	while (parts != 0u && iteration_count < MOST_ITERATIONS) {
		const uint i = uint(findLSB(parts));
		const CountBox box = make_count_box(light, light.views[p_view], load_box(p_tile, p_parts, i));
		Chain chain = part_chains[i];
		float least_share = COUNT_FAR;
		list_part(box, p_wanted_count, edge_count, least_share, chain);
		list_held(box, p_held_count, least_share, chain);
		chain.is_smooth = chain.is_smooth && subgroupAll(least_share >= box.smooth_share);
		if (subgroupElect()) {
			part_chains[i] = chain;
		}
		++iteration_count;
		parts &= parts - 1u;
	}
	subgroupMemoryBarrierShared();
	subgroupBarrier();
}

/// Holds those edges of the chosen bundles that the tile needs, and lists what its parts need of them.
void list_bundles(BoxPair p_pair, uvec2 p_tile, uint p_view, uint p_parts, uint p_wanted_count) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint edge_count = find_edge_count();
	const uint item_count = p_wanted_count * size;
	uint first = 0u;
	while (first < item_count && iteration_count < MOST_ITERATIONS) {
		uint held_count = 0u;
		do {
			const uint item = first + gl_SubgroupInvocationID;
			const uint place = min(item, item_count - 1u);
			const uint index = wanted_bundles[place / size] * size + place % size;
			const CountEdgeRecord edge = load_count_edge(min(index, edge_count - 1u));
			const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
			const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
			bool is_held = is_edge_in_reach(p_pair.near, a, b);
			bool is_open = !is_held && p_pair.count > 1u;
			while (is_open) { // not a branch: software drivers run what a branch skips
				is_held = is_edge_in_reach(p_pair.far, a, b);
				is_open = false;
			}
			is_held = is_held && item < item_count && index < edge_count;
			const uvec4 held = subgroupBallot(is_held);
			if (is_held) {
				held_edges[held_count + subgroupBallotExclusiveBitCount(held)] = index;
			}
			held_count += subgroupBallotBitCount(held);
			first += GROUP_SIZE;
			iteration_count += 2u;
		} while (first < item_count && held_count + GROUP_SIZE <= MOST_HELD);
		list_parts(p_tile, p_view, p_parts, 0u, held_count);
	}
}

// Through lists of faces. So many that no size of the map reaches it in usual scenes: what a block is does not depend on
// that. So few that the views of an omni light stay below llvmpipe's limit.
const uint MOST_STEPS = 2048u;
uint step_count = 0u;

/// True where the face lies wholly before the receivers of the box, or wholly behind them.
bool is_face_off(CountBox p_box, uint p_face) {
	const CountFaceRecord face = load_count_face(p_face);
	const vec3 a = uintBitsToFloat(face.a_kind.xyz);
	const vec3 b = uintBitsToFloat(face.b.xyz);
	const vec3 c = uintBitsToFloat(face.c.xyz);
	const float least_before =
			min(find_linear(p_box.below, a), min(find_linear(p_box.below, b), find_linear(p_box.below, c)));
	const float most_behind =
			max(find_linear(p_box.above, a), max(find_linear(p_box.above, b), find_linear(p_box.above, c)));
	return least_before > p_box.margin || most_behind < -p_box.margin;
}

/// True where no receiver of the box can be on another side of a face than the others, of all faces that the texels
/// p_first..p_last list.
bool are_faces_aside(CountBox p_box, uint p_view, uvec2 p_first, uvec2 p_last) {
	uvec2 texel = p_first;
	uint next = load_count_first_node(p_view, texel);
	const uint end = step_count + MOST_STEPS;
	bool is_aside = true;
	// One loop over all lists: a loop takes as many iterations as its slowest invocation.
	while (texel.y <= p_last.y && is_aside) {
		const uvec2 node = load_count_node(p_view * light.node_capacity + max(next, 1u) - 1u);
		const vec4 plane = load_count_plane(node.x);
		bool is_known = next == 0u || find_count_side(p_box, plane) != 0;
		bool is_open = !is_known;
		while (is_open) { // not a branch: software drivers run what a branch skips
			is_known = is_face_off(p_box, node.x);
			is_open = false;
		}
		is_aside = is_known && step_count < end;
		const bool is_end = next == 0u || node.y == 0u;
		const bool is_row_end = is_end && texel.x == p_last.x;
		texel.x = is_row_end ? p_first.x : (is_end ? texel.x + 1u : texel.x);
		texel.y += is_row_end ? 1u : 0u;
		next = is_end ? load_count_first_node(p_view, min(texel, p_last)) : node.y;
		++step_count;
	}
	return is_aside;
}

/// What is known of the solids between all receivers of a box and the light's centre, where no edge passes between:
/// their number changes only through a face. MAY_VARY: a face may part the receivers.
uint find_box_solids(uint p_view, CountBounds p_bounds) {
	const CountViewConstants view = light.views[p_view];
	const CountBox box = make_count_box(light, view, p_bounds);
	const vec2 least = box.center - box.half_size;
	const vec2 greatest = box.center + box.half_size;
	const bool is_inside = all(greaterThanEqual(least, -view.half_extent)) &&
			all(lessThanEqual(greatest, view.half_extent));
	bool is_even = is_inside &&
			are_faces_aside(box, p_view, find_count_texel(p_view, least), find_count_texel(p_view, greatest));
	// A receiver in the middle of the box.
	const float w = dot(box.slope, box.center) + box.range.x;
	const vec3 place = box.is_directional ? vec3(box.center, light.depth_far_m - w) : vec3(box.center, 1.0) / w;
	const vec3 position = place.x * view.axis_x.xyz + place.y * view.axis_y.xyz + place.z * view.axis_z.xyz;
	uint result = MAY_VARY;
	while (is_even) { // not a branch: software drivers run what a branch skips
		const int solids = count_solids(light, p_view, box.center, make_count_receiver(light, position));
		result = solids == 0 ? SOME_ARE_LIT : SOME_ARE_DARK;
		is_even = false;
	}
	return result;
}

/// Looks for faces that part receivers: adds what is known of parts that have no edges, and where there are edges,
/// a block with such a face is not smooth. One invocation a part.
void check_faces_of_view(uvec2 p_tile, uint p_view, uint p_parts) {
	for (uint first = 0u; first < PARTS_PER_TILE && p_parts >> first != 0u; first += GROUP_SIZE) {
		const uint i = first + gl_SubgroupInvocationID;
		const CountBounds bounds = load_box(p_tile, p_parts, i);
		const uint block = i % BLOCKS_PER_TILE;
		const bool has_edges = part_chains[min(i, PARTS_PER_TILE - 1u)].edge_count > 0u;
		// Without edges a light of size 0 has borders all the same.
		bool is_wanted = !is_count_bounds_empty(bounds) && light.most_edges > 0u &&
				(!has_edges || blocks_are_smooth[block] != 0u);
		while (is_wanted) { // not a branch: software drivers run what a branch skips
			const uint solids = find_box_solids(p_view, bounds);
			atomicOr(block_solids[block], has_edges ? 0u : solids);
			atomicAnd(blocks_are_smooth[block], has_edges && solids == MAY_VARY ? 0u : 1u);
			is_wanted = false;
		}
		iteration_count += 3u * subgroupMax(step_count) + 2u;
		step_count = 0u;
	}
}

/// Lists the edges of one view.
void list_view(uvec2 p_tile, uint p_view) {
	const uint bundle_count = find_bundle_count(find_edge_count());
	for (uint i = gl_SubgroupInvocationID; i < PARTS_PER_TILE; i += GROUP_SIZE) {
		part_chains[i] = Chain(0u, 0u, 0u, true);
	}
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	const uint parts = find_parts_of_tile(p_tile, p_view);
	const BoxPair pair = find_tile_pair(p_tile, p_view, parts);
	const bool is_deep = uint(bitCount(parts)) > BLOCKS_PER_TILE;
	for (uint next = 0u; next < bundle_count && iteration_count < MOST_ITERATIONS;) {
		const uint wanted_count = choose_bundles(pair, bundle_count, next);
		list_parts(p_tile, p_view, parts, is_deep ? wanted_count : 0u, 0u);
		list_bundles(pair, p_tile, p_view, parts, is_deep ? 0u : wanted_count);
	}
	for (uint first = 0u; first < PARTS_PER_TILE && parts >> first != 0u; first += GROUP_SIZE) {
		const uint i = first + gl_SubgroupInvocationID;
		if (i < PARTS_PER_TILE && (parts >> i & 1u) != 0u) {
			const Chain chain = part_chains[i];
			const uint place = find_part_place(p_tile, i) * uint(EDGE_COUNT_CHAIN_WORDS);
			chains[place + uint(EDGE_COUNT_CHAIN_FIRST)] = chain.first;
			chains[place + uint(EDGE_COUNT_CHAIN_COUNT)] = chain.edge_count;
			atomicAdd(block_edge_counts[i % BLOCKS_PER_TILE], chain.edge_count);
			// Chunks are taken in the order of their numbers: the last one has room where all have.
			if (chain.edge_count > 0u && chain.chunk >= light.chunk_capacity) {
				blocks_have_room[i % BLOCKS_PER_TILE] = 0u;
			}
			if (!chain.is_smooth) {
				blocks_are_smooth[i % BLOCKS_PER_TILE] = 0u;
			}
		}
	}
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	check_faces_of_view(p_tile, p_view, parts);
}

/// Puts the block into the list of its kind. In no order: what a block's pixels get does not depend on it.
void add_block(uint p_entry, uint p_kind) {
	const uint first = 3u * p_kind;
	const uint place = atomicAdd(dispatches[first], 1u);
	blocks[p_kind * light.block_count.x * light.block_count.y + place] = p_entry;
	dispatches[first + 1u] = 1u;
	dispatches[first + 2u] = 1u;
}

void main() {
	const uvec2 tile = uvec2(gl_WorkGroupID.x, find_work_row());
	uint views = 0u;
	for (uint i = gl_SubgroupInvocationID; i < BLOCKS_PER_TILE; i += GROUP_SIZE) {
		const uint parts = load_parts(find_block(tile, i));
		const uint view = 1u << (parts >> EDGE_COUNT_VIEW_SHIFT & EDGE_COUNT_VIEW_MASK);
		views |= (parts & EDGE_COUNT_IS_SORTED) != 0u ? view : parts & EDGE_COUNT_PARTS_MASK;
		block_edge_counts[i] = 0u;
		blocks_have_room[i] = 1u;
		// Where a face cuts the disc, its line there moves as the disc turns.
		blocks_are_smooth[i] = (parts & EDGE_COUNT_IS_SMOOTH) != 0u && find_cut_face_count() == 0u ? 1u : 0u;
		block_solids[i] = (parts & EDGE_COUNT_IS_PARTLY_LIT) != 0u ? SOME_ARE_LIT : 0u;
	}
	views = subgroupOr(views);
	while (views != 0u && iteration_count < MOST_ITERATIONS) {
		list_view(tile, uint(findLSB(views)));
		views &= views - 1u;
	}
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	for (uint i = gl_SubgroupInvocationID; i < BLOCKS_PER_TILE; i += GROUP_SIZE) {
		const uint block = find_block(tile, i);
		if (block != NO_BLOCK) {
			const uint edge_count = block_edge_counts[i];
			const uint solids = block_solids[i];
			const bool is_whole = iteration_count < MOST_ITERATIONS;
			uint kind = uint(blocks_are_smooth[i] != 0u ? EDGE_COUNT_BLOCKS_SMOOTH : EDGE_COUNT_BLOCKS_LISTED);
			kind = is_whole && blocks_have_room[i] != 0u ? kind : uint(EDGE_COUNT_BLOCKS_UNLISTED);
			kind = edge_count > light.budget ? uint(EDGE_COUNT_BLOCKS_FILTERED) : kind;
			const bool is_even = light.most_edges > 0u && solids <= SOME_ARE_DARK;
			kind = is_whole && edge_count == 0u && find_cut_face_count() == 0u
					? uint(is_even ? EDGE_COUNT_BLOCKS_EVEN : EDGE_COUNT_BLOCKS_PLAIN)
					: kind;
			const bool is_dark = kind == uint(EDGE_COUNT_BLOCKS_EVEN) && solids == SOME_ARE_DARK;
			add_block(block | (is_dark ? EDGE_COUNT_BLOCK_IS_DARK : 0u), kind);
		}
	}
}
