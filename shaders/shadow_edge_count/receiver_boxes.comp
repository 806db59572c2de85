#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
#include "shadow_edge_count/count_box_inc.glsl"
#include "shadow_edge_count/count_pixels_inc.glsl"

#define LIT_TILES_BINDING MAP_RESOLVE_BINDING_TILES
#include "common/lit_tiles_inc.glsl"

// Splits each block's receivers into parts and computes their bounds. One subgroup per block.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_SUBGROUP_SIZE) in;
layout(std430, set = 0, binding = COUNT_BINDING_BOXES) writeonly buffer Boxes {
	CountBlockBox boxes[];
};
layout(std430, set = 0, binding = COUNT_BINDING_BLOCK_RECEIVERS) writeonly buffer BlockReceivers {
	uint block_receivers[]; // per block, EDGE_COUNT_RECEIVERS_*
};

layout(std430, set = 0, binding = COUNT_BINDING_CHAINS) writeonly buffer Chains {
	uint chains[]; // per block and part, EDGE_COUNT_CHAIN_*; only the distances are written here
};

const uint GROUP_SIZE = gl_WorkGroupSize.x; // each work group is one subgroup
const uint SUBGROUP_SIZE = GROUP_SIZE;
#include "shadow_edge_count/plane_fit_inc.glsl"

const uint PIXEL_COUNT = uint(EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX);
const uint PIXELS_PER_INVOCATION = (PIXEL_COUNT + GROUP_SIZE - 1u) / GROUP_SIZE;
const uint NO_VIEW = 0xffffffffu;
const uint NO_PART = 0xffffffffu;

/// The receiver of one of a block's pixels. p_block: in blocks from the top left. Its view is NO_VIEW if there is none, or if no caster can hide it. In the
/// latter case r_is_lit becomes true.
CountPoint load_point(uvec2 p_block, uint p_index, inout bool r_is_lit) {
	const ivec2 pixel = ivec2(p_block * uint(EDGE_COUNT_BLOCK_PX) + find_pixel_in_block(p_index));
	CountPoint point = CountPoint(vec3(0.0), NO_VIEW, vec3(0.0), 0.0);
	if (p_index < PIXEL_COUNT && is_in_image(pixel) && is_receiver_pixel(pixel)) {
		const CountPoint loaded = load_count_point(pixel);
		if (may_count_at(loaded)) {
			point = loaded;
		} else {
			r_is_lit = true;
		}
	}
	return point;
}

/// Distance of a receiver from the camera in metres.
float find_camera_distance(CountPoint p_point) {
	return distance(p_point.position, light_from_camera[3].xyz);
}

/// True if distances from the camera differ so much that the receivers are sorted by distance.
bool needs_sorting(vec2 p_camera_range) {
	const float MIN_SORTED_RANGE_SIZES = 0.05; // in units of the scene size S
	return p_camera_range.y - p_camera_range.x > MIN_SORTED_RANGE_SIZES * light.scene_size_m;
}

/// The bounds of the receivers for which p_is_selected is true, relative to the plane that fits them best. Empty if
/// there is none.
CountBounds find_bounds(CountPoint p_points[PIXELS_PER_INVOCATION], bool p_is_selected[PIXELS_PER_INVOCATION]) {
	vec4 sum = vec4(0.0);
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		sum += p_is_selected[i] ? vec4(p_points[i].warped, 1.0) : vec4(0.0);
	}
	const vec3 mean = find_mean_receiver(sum);
	PlaneMoments moments = PlaneMoments(vec3(0.0), vec2(0.0));
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		add_to_moments(p_points[i].warped - mean, p_is_selected[i], moments);
	}
	CountBounds bounds = make_count_bounds();
	bounds.slope = find_fitted_slope(moments);
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		add_to_bounds(p_points[i].warped, p_is_selected[i], bounds);
	}
	return find_subgroup_bounds(bounds);
}

/// Writes a part's bounds, and the distance of its nearest receiver from the light (EDGE_COUNT_CHAIN_DISTANCE).
/// p_parts: the parts of the receivers.
void write_part(uint p_block, uint p_part, CountPoint p_points[PIXELS_PER_INVOCATION], uint p_parts[PIXELS_PER_INVOCATION]) {
	bool is_selected[PIXELS_PER_INVOCATION];
	float distance_m = COUNT_FAR;
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		is_selected[i] = p_parts[i] == p_part;
		const vec3 position = p_points[i].position;
		distance_m = is_selected[i] ? min(distance_m, IS_DIRECTIONAL ? position.z : length(position)) : distance_m;
	}
	distance_m = subgroup_min(distance_m);
	const CountBounds bounds = find_bounds(p_points, is_selected);
	if (subgroupElect()) {
		const uint index = p_block * PART_COUNT + p_part;
		boxes[index] = pack_count_bounds(bounds);
		chains[index * uint(EDGE_COUNT_CHAIN_WORDS) + uint(EDGE_COUNT_CHAIN_DISTANCE)] = floatBitsToUint(distance_m);
	}
}

shared float sort_keys[PIXEL_COUNT];
shared uint sorted_pixels[PIXEL_COUNT];

/// Writes the order of the block's pixels by distance from the camera, those without a receiver last. p_distances: of the
/// receivers, COUNT_FAR where there is none. p_parts: the parts of the receivers.
void write_order(uint p_block, float p_distances[PIXELS_PER_INVOCATION], uint p_parts[PIXELS_PER_INVOCATION]) {
	uint ranks[PIXELS_PER_INVOCATION];
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const uint pixel = i * GROUP_SIZE + gl_SubgroupInvocationID;
		ranks[i] = 0u;
		if (pixel < PIXEL_COUNT) {
			sort_keys[pixel] = p_distances[i];
		}
	}
	sync_subgroup_memory();
	for (uint other = 0u; other < PIXEL_COUNT; ++other) {
		const float distance_m = sort_keys[other];
		for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
			const uint pixel = i * GROUP_SIZE + gl_SubgroupInvocationID;
			ranks[i] += distance_m < p_distances[i] || (distance_m == p_distances[i] && other < pixel) ? 1u : 0u;
		}
	}
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const uint pixel = i * GROUP_SIZE + gl_SubgroupInvocationID;
		if (pixel < PIXEL_COUNT) {
			sorted_pixels[ranks[i]] = pixel | (p_parts[i] == NO_PART ? 0u : p_parts[i] << EDGE_COUNT_ORDER_PART_SHIFT);
		}
	}
	sync_subgroup_memory();
	for (uint i = gl_SubgroupInvocationID; i < PIXEL_COUNT / 4u; i += GROUP_SIZE) {
		block_receivers[p_block * uint(EDGE_COUNT_RECEIVERS_WORDS) + uint(EDGE_COUNT_RECEIVERS_ORDER) + i] =
				sorted_pixels[4u * i] | sorted_pixels[4u * i + 1u] << 8 | sorted_pixels[4u * i + 2u] << 16 |
				sorted_pixels[4u * i + 3u] << 24;
	}
}

/// True if each pixel has a receiver, and positions change evenly from pixel to pixel: they deviate from a linear
/// function through three corners of the block by no more than MAX_DEVIATION of the block's size. All receivers must
/// be in one view.
bool is_smooth(CountPoint p_points[PIXELS_PER_INVOCATION]) {
	const float MAX_DEVIATION = 0.25;
	const uint RIGHT = 21u; // indices of two corners, see find_pixel_in_block: the even bits are those of x
	const uint BOTTOM = 42u;
	const vec3 corner = subgroupShuffle(p_points[0].position, 0u);
	const vec3 right = subgroupShuffle(p_points[RIGHT / GROUP_SIZE].position, RIGHT % GROUP_SIZE) - corner;
	const vec3 bottom = subgroupShuffle(p_points[BOTTOM / GROUP_SIZE].position, BOTTOM % GROUP_SIZE) - corner;
	const float max_square = MAX_DEVIATION * MAX_DEVIATION * max(dot(right, right), dot(bottom, bottom));
	bool is_even = true;
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const uint pixel = i * GROUP_SIZE + gl_SubgroupInvocationID;
		const vec2 fraction = vec2(find_pixel_in_block(pixel)) / float(EDGE_COUNT_BLOCK_PX - 1);
		const vec3 deviation = p_points[i].position - corner - fraction.x * right - fraction.y * bottom;
		is_even = is_even &&
				(pixel >= PIXEL_COUNT || (p_points[i].view != NO_VIEW && dot(deviation, deviation) <= max_square));
	}
	return subgroup_all(is_even);
}

void main() {
	load_count_constants();
	bool is_valid;
	const uvec2 image_block = find_lit_block(frame_copy.size_px, is_valid);
	if (!is_valid) {
		return;
	}
	CountPoint points[PIXELS_PER_INVOCATION];
	float distances[PIXELS_PER_INVOCATION];
	bool is_lit = false;
	uint views = 0u;
	vec2 camera_range = vec2(COUNT_FAR, -COUNT_FAR);
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		points[i] = load_point(image_block, i * GROUP_SIZE + gl_SubgroupInvocationID, is_lit);
		const bool is_receiver = points[i].view != NO_VIEW;
		const float distance_m = find_camera_distance(points[i]);
		views |= is_receiver ? 1u << points[i].view : 0u;
		camera_range.x = is_receiver ? min(camera_range.x, distance_m) : camera_range.x;
		camera_range.y = is_receiver ? max(camera_range.y, distance_m) : camera_range.y;
		distances[i] = is_receiver ? distance_m : COUNT_FAR;
	}
	views = subgroup_or(views);
	camera_range = vec2(subgroup_min(camera_range.x), subgroup_max(camera_range.y));
	const bool has_one_view = bitCount(views) == 1;
	const bool is_sorted = has_one_view && needs_sorting(camera_range);
	// The parts of the receivers: they divide the range of distances evenly, or are the views.
	const float SORTED_PART_COUNT = float(EDGE_COUNT_SORTED_PARTS);
	const float parts_per_m = SORTED_PART_COUNT / (camera_range.y - camera_range.x);
	uint parts[PIXELS_PER_INVOCATION];
	uint all_parts = 0u;
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const float position = clamp((distances[i] - camera_range.x) * parts_per_m, 0.0, SORTED_PART_COUNT - 1.0);
		const uint part = is_sorted ? uint(position) : points[i].view;
		parts[i] = points[i].view != NO_VIEW ? part : NO_PART;
		all_parts |= points[i].view != NO_VIEW ? 1u << part : 0u;
	}
	all_parts = subgroup_or(all_parts);
	const uint block = image_block.y * light.block_count.x + image_block.x;
	for (uint left = all_parts; left != 0u; left &= left - 1u) {
		write_part(block, uint(findLSB(left)), points, parts);
	}
	const bool is_smooth_block = is_smooth(points) && has_one_view && !is_sorted;
	if (is_sorted) {
		write_order(block, distances, parts);
	}
	const uint flags = (is_sorted ? uint(findLSB(views)) << EDGE_COUNT_VIEW_SHIFT | EDGE_COUNT_IS_SORTED : 0u) |
			(is_smooth_block ? EDGE_COUNT_IS_SMOOTH : 0u) | (subgroup_any(is_lit) ? EDGE_COUNT_IS_PARTLY_LIT : 0u);
	if (subgroupElect()) {
		block_receivers[block * uint(EDGE_COUNT_RECEIVERS_WORDS) + uint(EDGE_COUNT_RECEIVERS_PARTS)] = all_parts | flags;
	}
}
