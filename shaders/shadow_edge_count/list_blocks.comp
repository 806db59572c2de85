#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shadow_edge_count/shadow_edge_count_shared.h"

layout(set = 0, binding = COUNT_BINDING_LIGHT) uniform Light {
	CountLightConstants light;
};

#include "shadow_edge_count/count_bundles_inc.glsl"

// For each block of pixels the edges that may matter to any of its receivers, view by view, in their
// own order; then the block goes to those of its kind. One subgroup deals with one block.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) in;
layout(std430, set = 0, binding = COUNT_BINDING_BOXES) readonly buffer Boxes {
	CountGroupBox boxes[];
};
layout(std430, set = 0, binding = COUNT_BINDING_PRESENT) readonly buffer Present {
	uint present_boxes[];
};
layout(std430, set = 0, binding = COUNT_BINDING_ENDS) writeonly buffer Ends {
	uint ends[];
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

const uint MOST_BOXES = uint(EDGE_COUNT_BOXES_PER_GROUP);

/// The receivers of a block in one view: in either of two boxes, or in the first alone.
struct BlockBoxes {
	CountBox near;
	CountBox far;
	uint count;
};

uint find_group(uvec2 p_block, uint p_index) {
	const uint side = uint(EDGE_COUNT_GROUPS_PER_BLOCK_SIDE);
	const uvec2 group = p_block * side + uvec2(p_index % side, p_index / side);
	return all(lessThan(group, light.group_count)) ? group.y * light.group_count.x + group.x : 0xffffffffu;
}

const uint BOXES_PER_BLOCK =
		uint(EDGE_COUNT_GROUPS_PER_BLOCK_SIDE * EDGE_COUNT_GROUPS_PER_BLOCK_SIDE) * MOST_BOXES;

/// One of the boxes of the block's groups in a view; empty where it is not there.
CountBounds load_box(uvec2 p_block, uint p_view, uint p_index) {
	const uint group = find_group(p_block, p_index / MOST_BOXES);
	const uint box = p_index % MOST_BOXES;
	const bool is_there = p_index < BOXES_PER_BLOCK && group != 0xffffffffu &&
			(present_boxes[min(group, light.group_count.x * light.group_count.y - 1u)] >>
							(MOST_BOXES * p_view + box) &
					1u) != 0u;
	const uint place = is_there ? (group * light.view_count + p_view) * MOST_BOXES + box : 0u;
	const CountGroupBox loaded = boxes[place];
	return is_there ? unpack_count_bounds(loaded) : make_count_bounds();
}

/// Least and greatest w of the block's receivers in a view.
vec2 find_w_range_of_block(uvec2 p_block, uint p_view) {
	vec2 w = vec2(COUNT_FAR, -COUNT_FAR);
	for (uint i = gl_SubgroupInvocationID; i < BOXES_PER_BLOCK; i += gl_SubgroupSize) {
		const CountBounds box = load_box(p_block, p_view, i);
		const vec2 range = find_w_range(box);
		w = is_count_bounds_empty(box) ? w : vec2(min(w.x, range.x), max(w.y, range.y));
	}
	return vec2(subgroupMin(w.x), subgroupMax(w.y));
}

/// The bounds of those boxes of the block's groups whose middle w lies in a range, about the plane of the
/// first; each invocation has some of the boxes.
CountBounds find_bounds(uvec2 p_block, uint p_view, float p_least_w, float p_greatest_w) {
	CountBounds bounds = make_count_bounds();
	for (uint i = gl_SubgroupInvocationID; i < BOXES_PER_BLOCK; i += gl_SubgroupSize) {
		const CountBounds box = load_box(p_block, p_view, i);
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

BlockBoxes find_block_boxes(uvec2 p_block, uint p_view) {
	const CountViewConstants view = light.views[p_view];
	const vec2 w = find_w_range_of_block(p_block, p_view);
	const float middle = 0.5 * (w.x + w.y);
	const CountBounds near = find_bounds(p_block, p_view, middle, COUNT_FAR);
	const CountBounds far = find_bounds(p_block, p_view, -COUNT_FAR, middle);
	BlockBoxes result;
	result.near = make_count_box(light, view, is_count_bounds_empty(near) ? far : near);
	result.far = make_count_box(light, view, is_count_bounds_empty(far) ? near : far);
	result.count = is_count_bounds_empty(near) || is_count_bounds_empty(far) ? 1u : 2u;
	return result;
}

// Bundles that may matter to the block, in their order; and the first edges of its list.
const uint MOST_WANTED = 512u;
shared uint wanted_bundles[MOST_WANTED];
const uint MOST_HELD = 1024u;
shared uint held_edges[MOST_HELD];

/// Where a block's edges go: counted only, or written from a place in the lists on.
struct BlockList {
	uint edge_count;
	uint first; // in the lists
	bool is_written;
};

/// Puts bundles from r_next on into wanted_bundles, until all are tested or there may be no room, and
/// returns how many.
uint choose_bundles(BlockBoxes p_boxes, uint p_bundle_count, inout uint r_next) {
	uint count = 0u;
	do {
		const uint bundle = r_next + gl_SubgroupInvocationID;
		const CountEdgeBundle loaded = load_count_bundle(min(bundle, p_bundle_count - 1u));
		bool is_wanted = bundle < p_bundle_count && may_use_bundle(p_boxes.near, loaded);
		bool is_open = bundle < p_bundle_count && !is_wanted && p_boxes.count > 1u;
		while (is_open) { // not a branch: software drivers run what a branch skips
			is_wanted = may_use_bundle(p_boxes.far, loaded);
			is_open = false;
		}
		const uvec4 wanted = subgroupBallot(is_wanted);
		if (is_wanted) {
			wanted_bundles[count + subgroupBallotExclusiveBitCount(wanted)] = bundle;
		}
		count += subgroupBallotBitCount(wanted);
		r_next += gl_SubgroupSize;
	} while (r_next < p_bundle_count && count + gl_SubgroupSize <= MOST_WANTED);
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	return count;
}

/// An edge, as a list has it. r_is_used: false where it adds nothing to any receiver of the block.
uint test_edge(BlockBoxes p_boxes, uint p_index, out bool r_is_used) {
	const CountEdgeRecord edge = load_count_edge(p_index);
	const vec3 a = uintBitsToFloat(edge.a_face0.xyz);
	const vec3 b = uintBitsToFloat(edge.b_face1.xyz);
	bool is_in_reach = is_edge_in_reach(p_boxes.near, a, b);
	bool is_open = !is_in_reach && p_boxes.count > 1u;
	while (is_open) { // not a branch: software drivers run what a branch skips
		is_in_reach = is_edge_in_reach(p_boxes.far, a, b);
		is_open = false;
	}
	uint known = 0u;
	ivec2 sides = ivec2(1);
	bool is_wanted = is_in_reach;
	while (is_wanted) {
		const CountEdgeKind kind = make_count_kind(edge.a_face0.w, edge.b_face1.w);
		const vec4 plane0 = load_count_plane0(edge);
		const vec4 plane1 = load_count_plane1(edge);
		known = find_known_weight(p_boxes.near, kind, plane0, plane1);
		sides = ivec2(find_light_side(p_boxes.near, a), find_light_side(p_boxes.near, b));
		is_open = p_boxes.count > 1u;
		while (is_open) {
			known = known == find_known_weight(p_boxes.far, kind, plane0, plane1) ? known : 0u;
			sides = sides == ivec2(find_light_side(p_boxes.far, a), find_light_side(p_boxes.far, b)) ? sides
																								   : ivec2(0);
			is_open = false;
		}
		is_wanted = false;
	}
	const bool is_used = is_in_reach && known != COUNT_ADDS_NOTHING && max(sides.x, sides.y) >= 0;
	known |= min(sides.x, sides.y) > 0 ? COUNT_IS_BEFORE_LIGHT : 0u;
	r_is_used = is_used;
	return p_index | known << COUNT_KNOWN_SHIFT;
}

/// Adds those edges of the chosen bundles that the block needs.
void list_bundles(BlockBoxes p_boxes, uint p_wanted_count, uint p_edge_count, inout BlockList r_list) {
	const uint size = uint(EDGE_COUNT_BUNDLE_SIZE);
	const uint item_count = p_wanted_count * size;
	for (uint first = 0u; first < item_count; first += gl_SubgroupSize) {
		const uint item = first + gl_SubgroupInvocationID;
		const uint place = min(item, item_count - 1u);
		const uint index = wanted_bundles[place / size] * size + place % size;
		bool is_used;
		const uint entry = test_edge(p_boxes, min(index, p_edge_count - 1u), is_used);
		is_used = is_used && item < item_count && index < p_edge_count;
		const uvec4 used = subgroupBallot(is_used);
		const uint target = r_list.edge_count + subgroupBallotExclusiveBitCount(used);
		if (is_used && target < MOST_HELD) {
			held_edges[target] = entry;
		}
		if (is_used && r_list.is_written) {
			lists[r_list.first + target] = entry;
		}
		r_list.edge_count += subgroupBallotBitCount(used);
	}
	subgroupMemoryBarrierShared();
	subgroupBarrier();
}

/// Lists the edges of all views.
void list_views(uvec2 p_block, uint p_views, uint p_first_end, inout BlockList r_list) {
	const uint edge_count = find_edge_count();
	const uint bundle_count = find_bundle_count(edge_count);
	for (uint v = 0u; v < light.view_count; ++v) {
		if ((p_views >> (MOST_BOXES * v) & 3u) != 0u) {
			const BlockBoxes block_boxes = find_block_boxes(p_block, v);
			for (uint next = 0u; next < bundle_count;) {
				const uint wanted_count = choose_bundles(block_boxes, bundle_count, next);
				list_bundles(block_boxes, wanted_count, edge_count, r_list);
			}
		}
		if (subgroupElect()) {
			ends[p_first_end + 1u + v] = r_list.edge_count; // from the list's begin
		}
	}
}

/// Puts the block into the list of its kind. In no order: what a block's pixels get does not depend on it.
void add_block(uint p_block_index, uint p_kind) {
	const uint first = 3u * p_kind;
	const uint place = atomicAdd(dispatches[first], 1u);
	blocks[p_kind * light.block_count.x * light.block_count.y + place] = p_block_index;
	dispatches[first + 1u] = uint(EDGE_COUNT_GROUPS_PER_BLOCK_SIDE * EDGE_COUNT_GROUPS_PER_BLOCK_SIDE);
	dispatches[first + 2u] = 1u;
}

void main() {
	const uvec2 block = gl_WorkGroupID.xy;
	const uint block_index = block.y * light.block_count.x + block.x;
	const uint first_end = block_index * uint(EDGE_COUNT_ENDS_PER_BLOCK);
	uint views = 0u;
	for (uint i = 0u; i < uint(EDGE_COUNT_GROUPS_PER_BLOCK_SIDE * EDGE_COUNT_GROUPS_PER_BLOCK_SIDE); ++i) {
		const uint group = find_group(block, i);
		views |= group == 0xffffffffu ? 0u : present_boxes[group];
	}
	views = (views | views >> 1) & 0x555u;
	BlockList list = BlockList(0u, 0u, false);
	list_views(block, views, first_end, list);
	const uint edge_count = list.edge_count;
	uint kind = uint(EDGE_COUNT_BLOCKS_PLAIN);
	if (subgroupElect()) {
		ends[first_end] = 0u;
	}
	if (edge_count > light.budget) {
		kind = uint(EDGE_COUNT_BLOCKS_FILTERED);
	} else if (edge_count > 0u) {
		uint first = 0u;
		if (subgroupElect()) {
			first = atomicAdd(dispatches[EDGE_COUNT_DISPATCH_LISTED], edge_count);
		}
		first = subgroupBroadcastFirst(first);
		const bool has_room = edge_count <= light.list_capacity && first <= light.list_capacity - edge_count;
		kind = has_room ? uint(EDGE_COUNT_BLOCKS_LISTED) : uint(EDGE_COUNT_BLOCKS_UNLISTED);
		if (subgroupElect()) {
			ends[first_end] = first;
		}
		if (has_room && edge_count <= MOST_HELD) {
			for (uint i = gl_SubgroupInvocationID; i < edge_count; i += gl_SubgroupSize) {
				lists[first + i] = held_edges[i];
			}
		} else if (has_room) { // a long list is found a second time
			list = BlockList(0u, first, true);
			list_views(block, views, first_end, list);
		}
	}
	if (subgroupElect()) {
		add_block(block_index, kind);
	}
}
