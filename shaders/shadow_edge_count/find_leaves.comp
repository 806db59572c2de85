#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/shadow_edge_count_shared.h"

// Divides the receivers of each block of pixels into leaves, and computes their bounds. Leaves to which no node of the
// highest level of a tree may matter are lit, and are not written. One subgroup per block.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_SUBGROUP_SIZE) in;

const uint GROUP_SIZE = gl_WorkGroupSize.x; // each work group is one subgroup
const uint SUBGROUP_SIZE = GROUP_SIZE;
#define WRITES_LEAVES
#include "shadow_edge_count/leaf_tests_inc.glsl"
#include "shadow_edge_count/dispatches_inc.glsl"
#include "shadow_edge_count/plane_fit_inc.glsl"
#define LIT_TILES_BINDING MAP_RESOLVE_BINDING_TILES
#include "common/lit_tiles_inc.glsl"

const uint PIXEL_COUNT = uint(EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX);
const uint PIXELS_PER_INVOCATION = (PIXEL_COUNT + GROUP_SIZE - 1u) / GROUP_SIZE;
const uint NO_SLICE = 0xffffffffu;

/// The receivers of a block. Bits of masks: those of find_pixel_in_block. Invocation j has pixels j + i * GROUP_SIZE.
vec3 positions[PIXELS_PER_INVOCATION]; // in light space
uint slices[PIXELS_PER_INVOCATION]; // NO_SLICE: no receiver

uint find_pixel(uint p_index) {
	return p_index * GROUP_SIZE + gl_SubgroupInvocationID;
}

/// Loads the receivers of a block. p_block: in blocks from the top left. Returns the range of their distances from the
/// camera, in metres.
vec2 load_receivers(uvec2 p_block, out float r_distances[PIXELS_PER_INVOCATION]) {
	vec2 camera_range = vec2(COUNT_FAR, -COUNT_FAR);
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const ivec2 pixel = ivec2(p_block * uint(EDGE_COUNT_BLOCK_PX) + find_pixel_in_block(find_pixel(i) % PIXEL_COUNT));
		const bool is_receiver = find_pixel(i) < PIXEL_COUNT && is_in_image(pixel) && is_receiver_pixel(pixel);
		positions[i] = vec3(0.0);
		r_distances[i] = 0.0;
		slices[i] = NO_SLICE;
		if (is_receiver) {
			positions[i] = find_light_position(load_receiver(frame_copy, pixel).position);
			r_distances[i] = distance(positions[i], light_from_camera[3].xyz);
			slices[i] = 0u;
			camera_range = vec2(min(camera_range.x, r_distances[i]), max(camera_range.y, r_distances[i]));
		}
	}
	return vec2(subgroup_min(camera_range.x), subgroup_max(camera_range.y));
}

/// Divides the receivers into slices of equal ratio of distances, as thick as SLICE_WIDTHS times the block's width.
/// Returns a bit mask of the slices that have receivers.
uint choose_slices(vec2 p_camera_range, float p_distances[PIXELS_PER_INVOCATION]) {
	const float SLICE_WIDTHS = 3.0;
	const float nearest = max(p_camera_range.x, 1e-30);
	const float width = log2(1.0 + SLICE_WIDTHS * float(EDGE_COUNT_BLOCK_PX) * frame_copy.pixel_size_per_m);
	const float range = log2(max(p_camera_range.y, nearest) / nearest);
	const float count = clamp(ceil(range / width), 1.0, float(EDGE_COUNT_MAX_SLICES));
	uint used = 0u;
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const float slice = count * log2(max(p_distances[i], nearest) / nearest) / max(range, 1e-30);
		slices[i] = slices[i] != NO_SLICE && count > 1.0 ? uint(clamp(slice, 0.0, count - 1.0)) : slices[i];
		used |= slices[i] != NO_SLICE ? 1u << slices[i] : 0u;
	}
	return subgroup_or(used);
}

/// The leaf of a slice, or of all receivers. p_block: index of the block.
CountLeaf make_leaf(uint p_block, uint p_slice, bool p_has_all, bool p_may_be_smooth) {
	uint bits = 0u; // of the invocation's pixels
	uvec2 pixels = uvec2(0u);
	vec3 minimum = vec3(COUNT_FAR);
	vec3 maximum = vec3(-COUNT_FAR);
	float distance_m = COUNT_FAR;
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const bool is_own = p_has_all ? slices[i] != NO_SLICE : slices[i] == p_slice;
		const uint pixel = find_pixel(i) % PIXEL_COUNT;
		bits |= is_own ? 1u << i : 0u;
		pixels.x |= is_own && pixel < 32u ? 1u << pixel : 0u;
		pixels.y |= is_own && pixel >= 32u ? 1u << (pixel - 32u) : 0u;
		minimum = is_own ? min(minimum, positions[i]) : minimum;
		maximum = is_own ? max(maximum, positions[i]) : maximum;
		distance_m = is_own ? min(distance_m, IS_DIRECTIONAL ? positions[i].z : length(positions[i])) : distance_m;
	}
	pixels = uvec2(subgroup_or(pixels.x), subgroup_or(pixels.y));
	minimum = vec3(subgroup_min(minimum.xy), subgroup_min(minimum.z));
	maximum = vec3(subgroup_max(maximum.xy), subgroup_max(maximum.z));
	distance_m = subgroup_min(distance_m);
	// The frame points to the middle of the receivers.
	const vec3 middle = 0.5 * minimum + 0.5 * maximum;
	const float size = max(abs(middle.x), max(abs(middle.y), abs(middle.z)));
	const CountFrame frame = make_count_frame(size > 0.0 ? normalize(middle / size) : vec3(0.0, 0.0, 1.0));
	const float MIN_COSINE = 0.2; // of the angle between a receiver and the frame's axis
	bool is_wide = false;
	vec3 warped[PIXELS_PER_INVOCATION];
	vec4 sum = vec4(0.0);
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const bool is_own = (bits >> i & 1u) != 0u;
		const bool is_far_off =
				!IS_DIRECTIONAL && dot(frame.z, positions[i]) <= MIN_COSINE * length(positions[i]);
		is_wide = is_wide || (is_own && is_far_off);
		warped[i] = is_own && !is_far_off ? warp_to_frame(frame, light.depth_far_m, positions[i]) : vec3(0.0);
		sum += is_own && !is_far_off ? vec4(warped[i], 1.0) : vec4(0.0);
	}
	is_wide = subgroup_any(is_wide);
	const vec3 mean = find_mean_receiver(sum);
	PlaneMoments moments = PlaneMoments(vec3(0.0), vec2(0.0));
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		add_to_moments(warped[i] - mean, (bits >> i & 1u) != 0u && !is_wide, moments);
	}
	CountBounds bounds = make_count_bounds();
	bounds.slope = find_fitted_slope(moments);
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		add_to_bounds(warped[i], (bits >> i & 1u) != 0u && !is_wide, bounds);
	}
	bounds = find_subgroup_bounds(bounds);
	// The anchor is the receiver in the middle of the order of pixels.
	const uint anchor = find_set_bit(pixels, uint(bitCount(pixels.x) + bitCount(pixels.y)) / 2u);
	vec3 position = vec3(0.0);
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		position = i == anchor / GROUP_SIZE ? positions[i] : position;
	}
	position = subgroupShuffle(position, anchor % GROUP_SIZE);
	const uint flags = (p_may_be_smooth && !is_wide ? EDGE_COUNT_LEAF_IS_SMOOTH : 0u) |
			(is_wide ? EDGE_COUNT_LEAF_IS_WIDE : 0u);
	return CountLeaf(vec4(frame.z, distance_m), vec4(bounds.minimum, bounds.maximum),
			vec4(bounds.slope, bounds.range), vec4(position, uintBitsToFloat(p_block)),
			vec4(minimum, bounds.w_range.x), vec4(maximum, bounds.w_range.y), uvec4(pixels, flags, 0u));
}

/// False if the highest level of a tree has no node that may matter to the leaf.
bool may_any_matter(bool p_has_faces) {
	const CountTree tree = make_count_tree(p_has_faces);
	const uint level = tree.level_count - 1u;
	bool may_matter_here = false;
	for (uint first = 0u; first < uint(EDGE_COUNT_NODE_WIDTH); first += GROUP_SIZE) {
		const uint index = first + gl_SubgroupInvocationID;
		const bool exists = index < find_node_count(tree.item_count, level);
		may_matter_here =
				may_matter_here || (exists && may_matter(load_count_node(tree, level, exists ? index : 0u), p_has_faces));
	}
	return subgroup_any(may_matter_here);
}

/// True if each pixel has a receiver, and positions change evenly from pixel to pixel: they deviate from a linear
/// function through three corners of the block by no more than MAX_DEVIATION of the block's size.
bool is_smooth() {
	const float MAX_DEVIATION = 0.25;
	const uint RIGHT = 21u; // indices of two corners, see find_pixel_in_block: the even bits are those of x
	const uint BOTTOM = 42u;
	const vec3 corner = subgroupShuffle(positions[0], 0u);
	const vec3 right = subgroupShuffle(positions[RIGHT / GROUP_SIZE], RIGHT % GROUP_SIZE) - corner;
	const vec3 bottom = subgroupShuffle(positions[BOTTOM / GROUP_SIZE], BOTTOM % GROUP_SIZE) - corner;
	const float max_square = MAX_DEVIATION * MAX_DEVIATION * max(dot(right, right), dot(bottom, bottom));
	bool is_even = true;
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const uint pixel = i * GROUP_SIZE + gl_SubgroupInvocationID;
		const vec2 fraction = vec2(find_pixel_in_block(pixel)) / float(EDGE_COUNT_BLOCK_PX - 1);
		const vec3 deviation = positions[i] - corner - fraction.x * right - fraction.y * bottom;
		is_even = is_even &&
				(pixel >= PIXEL_COUNT || (slices[i] != NO_SLICE && dot(deviation, deviation) <= max_square));
	}
	return subgroup_all(is_even);
}

void main() {
	load_count_constants();
	bool is_valid;
	const uvec2 block = find_lit_block(frame_copy.size_px, is_valid);
	if (!is_valid) {
		return;
	}
	float distances[PIXELS_PER_INVOCATION];
	const vec2 camera_range = load_receivers(block, distances);
	uint used = choose_slices(camera_range, distances);
	if (used == 0u) {
		return;
	}
	uint count = uint(bitCount(used));
	// All blocks together may have a limited number of leaves beyond their first.
	const bool may_be_smooth = is_smooth() && count == 1u;
	const bool is_elected = subgroupElect();
	if (is_elected && count > 1u) {
		const uint more = atomicAdd(counts[EDGE_COUNT_COUNT_MORE], count - 1u);
		count = more + count - 1u <= light.leaf_capacity - light.block_count.x * light.block_count.y ? count : 1u;
	}
	count = subgroupBroadcastFirst(count);
	const bool has_cut_faces = find_cut_face_count() > 0u;
	for (uint i = 0u; i < count; ++i) {
		const CountLeaf leaf =
				make_leaf(block.y * light.block_count.x + block.x, uint(findLSB(used)), count == 1u, may_be_smooth);
		prepare_leaf_tests(leaf);
		const bool may_faces_matter = may_any_matter(/*p_has_faces=*/true);
		const bool may_edges_matter = may_any_matter(/*p_has_faces=*/false);
		const bool is_needed = may_faces_matter || may_edges_matter || has_cut_faces;
		if (is_elected && is_needed) {
			leaves[min(extend_dispatch(0u, uint(EDGE_COUNT_COUNT_ALL)), light.leaf_capacity - 1u)] = leaf;
		}
		used &= used - 1u;
	}
}
