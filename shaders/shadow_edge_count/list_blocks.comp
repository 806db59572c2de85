#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shadow_edge_count/count_boxes_inc.glsl"
#include "shadow_edge_count/count_buffers_inc.glsl"
#include "shadow_edge_count/count_cull_inc.glsl"

// For each block of pixels the edges that may matter to any of its receivers, view by view, in their
// own order; then the block goes to those of its kind. One subgroup deals with one block.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) in;
layout(set = 0, binding = COUNT_BINDING_LIGHT) uniform Light {
	CountLightConstants light;
};
layout(std430, set = 0, binding = COUNT_BINDING_BOXES) readonly buffer Boxes {
	CountGroupBox boxes[];
};
layout(set = 0, binding = COUNT_BINDING_BUNDLES) uniform textureBuffer bundles_buffer;
layout(set = 0, binding = COUNT_BINDING_TOTALS) uniform utextureBuffer totals_buffer;
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

CountEdgeBundle load_count_bundle(uint p_index) {
	const int first = int(2u * p_index);
	return CountEdgeBundle(texelFetch(bundles_buffer, first), texelFetch(bundles_buffer, first + 1));
}

uint find_total(uint p_index) {
	return texelFetch(totals_buffer, int(p_index)).r;
}

/// Of those boxes of the block's groups whose middle w lies in a range.
CountBounds find_bounds(uvec2 p_block, uint p_view, float p_least_w, float p_greatest_w) {
	const uint side = light.groups_per_block_side;
	CountBounds bounds = make_count_bounds();
	const uint count = side * side * uint(EDGE_COUNT_BOXES_PER_GROUP);
	for (uint i = gl_SubgroupInvocationID; i < count; i += gl_SubgroupSize) {
		const uint place = i / uint(EDGE_COUNT_BOXES_PER_GROUP);
		const uvec2 group = min(
				p_block * side + uvec2(place % side, place / side), light.group_count - uvec2(1u));
		const CountBounds box = unpack_count_bounds(light.views[p_view],
				boxes[((group.y * light.group_count.x + group.x) * light.view_count + p_view) *
								uint(EDGE_COUNT_BOXES_PER_GROUP) +
						i % uint(EDGE_COUNT_BOXES_PER_GROUP)]);
		const float middle = 0.5 * (box.least.z + box.greatest.z);
		const bool is_inside = !is_count_bounds_empty(box) && middle >= p_least_w &&
				middle < p_greatest_w;
		bounds.least = is_inside ? min(bounds.least, box.least) : bounds.least;
		bounds.greatest = is_inside ? max(bounds.greatest, box.greatest) : bounds.greatest;
	}
	return CountBounds(subgroupMin(bounds.least), subgroupMax(bounds.greatest));
}

/// The receivers of a block in one view: they lie in either of two boxes, or in the near one alone.
struct BlockBoxes {
	CountBox near;
	CountBox far;
	uint box_count;
};

// Bundles of edges that may matter to the block, in their order.
const uint MOST_WANTED = 512u;
shared uint wanted_bundles[MOST_WANTED];

/// Puts bundles from r_next on into wanted_bundles, until all are asked for or there may be no room, and
/// returns how many.
uint choose_bundles(uint p_view, BlockBoxes p_boxes, uint p_bundle_count, inout uint r_next) {
	const CountViewConstants view = light.views[p_view];
	const uint first = p_view * light.bundle_capacity;
	uint count = 0u;
	do {
		const uint bundle = r_next + gl_SubgroupInvocationID;
		const CountEdgeBundle loaded = load_count_bundle(first + min(bundle, p_bundle_count - 1u));
		const bool is_wanted = bundle < p_bundle_count &&
				(may_use_bundle(view, p_boxes.near, loaded) ||
						may_use_bundle(view, p_boxes.far, loaded));
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

/// Lists those edges of some bundles that the block needs from r_end on, as far as there is room, and
/// counts all of them.
void list_bundles(uint p_block_index, uint p_view, BlockBoxes p_boxes, uint p_wanted_count,
		uint p_edge_count, inout uint r_end) {
	const CountViewConstants view = light.views[p_view];
	const uint item_count = p_wanted_count * uint(EDGE_COUNT_BUNDLE_SIZE);
	for (uint first = 0u; first < item_count; first += gl_SubgroupSize) {
		const uint item = first + gl_SubgroupInvocationID;
		const uint place = min(item, item_count - 1u);
		const uint edge = wanted_bundles[place / uint(EDGE_COUNT_BUNDLE_SIZE)] *
						uint(EDGE_COUNT_BUNDLE_SIZE) +
				place % uint(EDGE_COUNT_BUNDLE_SIZE);
		const uint record = p_view * light.record_capacity + min(edge, p_edge_count - 1u);
		const CountEdgeRecord loaded = load_count_record(record);
		uint use = 0u;
		CountBox box = p_boxes.near;
		uint i = 0u;
		do { // not twice where there is one box: software drivers run a branch that nobody takes
			use |= find_count_use(view, box, loaded);
			box = p_boxes.far;
			++i;
		} while (i < p_boxes.box_count);
		const bool is_used = item < item_count && edge < p_edge_count && use != 0u;
		const uvec4 used = subgroupBallot(is_used);
		const uint target = r_end + subgroupBallotExclusiveBitCount(used);
		if (is_used && target < light.list_capacity) {
			lists[p_block_index * light.list_capacity + target] = record;
		}
		r_end += subgroupBallotBitCount(used);
	}
	subgroupMemoryBarrierShared();
	subgroupBarrier();
}

/// Lists the edges of one view.
void list_view(uint p_block_index, uint p_view, BlockBoxes p_boxes, uint p_edge_count, inout uint r_end) {
	const uint bundle_count = (p_edge_count + uint(EDGE_COUNT_BUNDLE_SIZE) - 1u) /
			uint(EDGE_COUNT_BUNDLE_SIZE);
	for (uint next = 0u; next < bundle_count;) {
		const uint wanted_count = choose_bundles(p_view, p_boxes, bundle_count, next);
		list_bundles(p_block_index, p_view, p_boxes, wanted_count, p_edge_count, r_end);
	}
}

/// Puts the block into the list of its kind. In no order: what a block's pixels get does not depend on it.
void add_block(uint p_block_index, uint p_kind) {
	const uint first = 3u * p_kind;
	const uint place = atomicAdd(dispatches[first], 1u);
	blocks[p_kind * light.block_count.x * light.block_count.y + place] = p_block_index;
	dispatches[first + 1u] = light.groups_per_block_side * light.groups_per_block_side;
	dispatches[first + 2u] = 1u;
	if (p_kind == uint(EDGE_COUNT_BLOCKS_FILTERED)) {
		const uvec2 map_groups = (light.views[0].map_size_px + uint(MAP_RESOLVE_GROUP_SIZE) - 1u) /
				uint(MAP_RESOLVE_GROUP_SIZE);
		dispatches[EDGE_COUNT_DISPATCH_MAP] = map_groups.x;
		dispatches[EDGE_COUNT_DISPATCH_MAP + 1] = map_groups.y;
		dispatches[EDGE_COUNT_DISPATCH_MAP + 2] = light.view_count;
	}
}

void main() {
	const uvec2 block = gl_WorkGroupID.xy;
	const uint block_index = block.y * light.block_count.x + block.x;
	const uint first_end = block_index * uint(EDGE_COUNT_ENDS_PER_BLOCK);
	uint end = 0u;
	bool is_over = false;
	for (uint v = 0u; v < light.view_count; ++v) {
		const CountViewConstants view = light.views[v];
		const CountBounds all = find_bounds(block, v, -COUNT_FAR, COUNT_FAR);
		if (!is_count_bounds_empty(all)) {
			// Near and far ones, as they lie about the middle.
			const float middle = 0.5 * (all.least.z + all.greatest.z);
			const CountBounds near = find_bounds(block, v, middle, COUNT_FAR);
			const CountBounds far = find_bounds(block, v, -COUNT_FAR, middle);
			const bool is_one = is_count_bounds_empty(near) || is_count_bounds_empty(far);
			const CountBox whole = make_count_box(view, all.least, all.greatest);
			BlockBoxes block_boxes = BlockBoxes(whole, whole, 1u);
			if (!is_one) {
				block_boxes = BlockBoxes(make_count_box(view, near.least, near.greatest),
						make_count_box(view, far.least, far.greatest), 2u);
			}
			const uint edge_count = find_total(uint(EDGE_COUNT_TOTAL_RECORDS) + v);
			is_over = is_over || edge_count > light.record_capacity ||
					find_total(uint(EDGE_COUNT_TOTAL_FRAGMENTS) + v) > light.fragment_capacity;
			list_view(block_index, v, block_boxes, min(edge_count, light.record_capacity), end);
		}
		if (subgroupElect()) {
			ends[first_end + v] = end;
		}
	}
	is_over = is_over || end > light.list_capacity;
	if (subgroupElect()) {
		add_block(block_index,
				is_over ? uint(EDGE_COUNT_BLOCKS_FILTERED)
						: (end > 0u ? uint(EDGE_COUNT_BLOCKS_COUNTED) : uint(EDGE_COUNT_BLOCKS_PLAIN)));
	}
}
