// Counts the edges of a block's pixels: what the resolve and its debug pictures share.
//
// Software drivers run a branch that nobody takes, and a loop's body once even where nobody enters it. So
// what is rare has a loop of its own behind the common case, and loops ask at their ends.
#ifndef COUNT_RESOLVE_INC_GLSL
#define COUNT_RESOLVE_INC_GLSL

#include "shadow_edge_count/count_blocks_inc.glsl"
#include "shadow_edge_count/count_buffers_inc.glsl"
#include "shadow_edge_count/count_cull_inc.glsl"
#include "shadow_edge_count/count_edge_inc.glsl"
#include "shadow_edge_count/count_map_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_ENDS) uniform utextureBuffer ends_buffer;
layout(set = 0, binding = COUNT_BINDING_LISTS) uniform utextureBuffer lists_buffer;
layout(set = 0, binding = COUNT_BINDING_MASKS) uniform utextureBuffer masks_buffer;

uvec2 load_count_mask(uint p_index) {
	return texelFetch(masks_buffer, int(p_index)).rg;
}

CountEdgePlanes load_count_planes(uint p_record) {
	const int first = int(4u * p_record);
	return CountEdgePlanes(
			texelFetch(records_buffer, first + 2), texelFetch(records_buffer, first + 3));
}

CountSegment load_count_segment(uint p_record) {
	const int first = int(4u * p_record);
	return make_count_segment(
			texelFetch(records_buffer, first), texelFetch(records_buffer, first + 1));
}

// Edges that a subgroup has to count, in one word each: the record, above it what it is used for. Each
// subgroup has a slice; common ones stand at its begin, the others at its end.
const uint CHOSEN_PER_INVOCATION = 32u;
shared uint chosen_edges[CHOSEN_PER_INVOCATION * MAP_RESOLVE_GROUP_SIZE * MAP_RESOLVE_GROUP_SIZE];
const uint COUNT_USE_SHIFT = 26u;
const uint COUNT_RECORD_MASK = (1u << COUNT_USE_SHIFT) - 1u;

/// One pixel: what it receives, and what was counted.
struct CountPixel {
	ivec2 pixel;
	uint edge_count; // that its subgroup looked at
	float visibility; // 0 where it is no receiver
	int solid_count; // at the reference texel
};

/// Pixels of a work group so that those of a subgroup lie close together: 4 x 2, 8 x 4 or 8 x 8.
uvec2 find_count_place() {
	const uint index = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID;
	const uint x = (index & 1u) | ((index >> 1) & 2u) | ((index >> 2) & 4u);
	const uint y = ((index >> 1) & 1u) | ((index >> 2) & 2u) | ((index >> 3) & 4u);
	return uvec2(x, y);
}

/// Edges of a list that any of a box's receivers needs: numbers of common and of other ones.
struct CountChoice {
	uint next; // place in the list from where to go on
	uint common_count;
	uint other_count;
};

/// Each invocation asks for one edge at a time whether any receiver needs it. Ends where the slice may
/// be full.
CountChoice choose_edges(uint p_first, uint p_end, CountViewConstants p_view, CountBox p_box) {
	const uint slice_size = CHOSEN_PER_INVOCATION * gl_SubgroupSize;
	const uint slice = gl_SubgroupID * slice_size;
	CountChoice choice = CountChoice(p_first, 0u, 0u);
	do {
		const uint place = choice.next + gl_SubgroupInvocationID;
		const uint record = texelFetch(lists_buffer, int(min(place, p_end - 1u))).r;
		const uint use = place < p_end
				? find_count_use(p_view, p_box, load_count_record(record))
				: 0u;
		const bool is_common = (use & (COUNT_USE_CENTER | COUNT_USE_ONE_WEIGHT)) == COUNT_USE_ONE_WEIGHT;
		const uvec4 common_edges = subgroupBallot(use != 0u && is_common);
		const uvec4 other_edges = subgroupBallot(use != 0u && !is_common);
		if (use != 0u) {
			const uint at = is_common
					? choice.common_count + subgroupBallotExclusiveBitCount(common_edges)
					: slice_size - 1u - choice.other_count -
							subgroupBallotExclusiveBitCount(other_edges);
			chosen_edges[slice + at] = record | use << COUNT_USE_SHIFT;
		}
		choice.common_count += subgroupBallotBitCount(common_edges);
		choice.other_count += subgroupBallotBitCount(other_edges);
		choice.next += gl_SubgroupSize;
	} while (choice.next < p_end &&
			choice.common_count + choice.other_count + gl_SubgroupSize <= slice_size);
	subgroupMemoryBarrierShared();
	subgroupBarrier();
	return choice;
}

/// The edges of one view's list, counted by the subgroup's invocations that are in that view.
uint count_list(uint p_first, uint p_end, CountViewConstants p_view, CountBox p_box, bool p_is_here,
		CountReceiver p_receiver, inout CountState r_state) {
	const uint slice_size = CHOSEN_PER_INVOCATION * gl_SubgroupSize;
	const uint slice = gl_SubgroupID * slice_size;
	uint edge_count = 0u;
	uint next = p_first;
	do {
		const CountChoice choice = choose_edges(next, p_end, p_view, p_box);
		next = choice.next;
		uint i = 0u;
		do {
			const uint chosen = chosen_edges[slice + i];
			if (p_is_here && i < choice.common_count) {
				count_add_area(p_receiver, load_count_segment(chosen & COUNT_RECORD_MASK),
						count_use_weight(chosen >> COUNT_USE_SHIFT), r_state);
			}
			++i;
		} while (i < choice.common_count);
		i = 0u;
		do {
			const uint chosen = chosen_edges[slice + slice_size - 1u - i];
			if (p_is_here && i < choice.other_count) {
				const uint record = chosen & COUNT_RECORD_MASK;
				count_add_edge(p_view, p_receiver, load_count_segment(record), record,
						chosen >> COUNT_USE_SHIFT, r_state);
			}
			++i;
		} while (i < choice.other_count);
		edge_count += choice.common_count + choice.other_count;
		subgroupMemoryBarrierShared();
		subgroupBarrier();
	} while (next < p_end);
	return edge_count;
}

CountPixel count_pixel() {
	const float FAR = 3e38;
	const float GROUP_SIZES = 0.05; // of S
	const uint block = find_block();
	CountPixel result;
	result.pixel = ivec2(find_block_group(block) + find_count_place());
	result.edge_count = 0u;
	const bool is_receiver = is_in_picture(result.pixel) && is_receiver_pixel(result.pixel);
	uint view = 0u;
	CountReceiver receiver =
			make_count_receiver(light.views[0], vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0));
	if (is_receiver) {
		receiver = load_count_receiver(result.pixel, view);
	}
	const bool is_counted = is_receiver && may_count_at(receiver.warped, view);
	bool waits = is_counted;
	CountState state =
			make_count_state(find_count_reference(light.views[VIEW_COUNT == 1u ? 0u : view], receiver));
	do {
		// Those beside the first one: where pixels lie far apart, as beside an object's outline, what
		// is between them would make a group of them ask for many edges that none of them needs.
		const bool is_any = subgroupAny(waits);
		const uint leader = is_any ? subgroupBallotFindLSB(subgroupBallot(waits)) : 0u;
		const uint chosen = VIEW_COUNT == 1u ? 0u : subgroupBroadcast(view, leader);
		const vec3 away = receiver.r - subgroupBroadcast(receiver.r, leader);
		const CountViewConstants constants = light.views[chosen];
		const float widest = GROUP_SIZES * constants.scene_size_m;
		const bool is_here = waits && view == chosen && dot(away, away) <= widest * widest;
		const int end_place = int(block * uint(EDGE_COUNT_ENDS_PER_BLOCK) + chosen);
		const uint end = texelFetch(ends_buffer, end_place).r;
		const uint begin = chosen == 0u ? 0u : texelFetch(ends_buffer, end_place - 1).r;
		const CountBox box = make_count_box(constants,
				subgroupMin(is_here ? receiver.warped : vec3(FAR)),
				subgroupMax(is_here ? receiver.warped : vec3(-FAR)));
		const uint list = block * light.list_capacity;
		const bool has_edges = is_any && begin < end && end != EDGE_COUNT_OVER_BUDGET;
		result.edge_count += count_list(list + begin, list + (has_edges ? end : begin), constants, box,
				is_here, receiver, state);
		waits = waits && !is_here;
	} while (subgroupAny(waits));
	result.solid_count = state.reference.solid_count;
	result.visibility = is_counted ? count_resolve(state) : (is_receiver ? 1.0 : 0.0);
	return result;
}

#endif
