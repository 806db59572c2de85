#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shadow_edge_count/count_boxes_inc.glsl"
#include "shadow_edge_count/count_pixels_inc.glsl"

// The bounds of the receivers of each group of 8 x 8 pixels, in each light view. One subgroup deals with
// one group.
layout(local_size_x_id = EDGE_COUNT_CONSTANT_GROUP_SIZE) in;
layout(std430, set = 0, binding = COUNT_BINDING_BOXES) writeonly buffer Boxes {
	CountGroupBox boxes[];
};

const uint PIXEL_COUNT = uint(EDGE_COUNT_GROUP_PX * EDGE_COUNT_GROUP_PX);
const uint PIXELS_PER_INVOCATION = (PIXEL_COUNT + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;

/// The receiver of one of the group's pixels. False: it is none, or no caster can hide it.
bool load_warped(uint p_index, out vec3 r_warped, out uint r_view) {
	const uint side = uint(EDGE_COUNT_GROUP_PX);
	const ivec2 pixel = ivec2(gl_WorkGroupID.xy * side + uvec2(p_index % side, p_index / side));
	r_warped = vec3(0.0);
	r_view = 0u;
	if (p_index >= PIXEL_COUNT || !is_in_picture(pixel) || !is_receiver_pixel(pixel)) {
		return false;
	}
	r_warped = load_count_receiver(pixel, r_view).warped;
	return may_count_at(r_warped, r_view);
}

/// Where to part receivers between two w: in the middle where they are far apart, else before all.
float find_split(uint p_view, float p_least, float p_greatest) {
	const float APART_SIZES = 0.05; // of S
	const bool is_directional = light.views[p_view].is_directional != 0u;
	const float apart_m =
			is_directional ? p_greatest - p_least : 1.0 / p_least - 1.0 / p_greatest;
	return apart_m > APART_SIZES * light.views[p_view].scene_size_m ? 0.5 * (p_least + p_greatest)
																	 : -COUNT_FAR;
}

/// Writes both boxes of a view from what each invocation found.
void write_boxes(uint p_view, vec3 p_warped[PIXELS_PER_INVOCATION], bool p_is_here[PIXELS_PER_INVOCATION]) {
	float least_w = COUNT_FAR;
	float greatest_w = -COUNT_FAR;
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		least_w = p_is_here[i] ? min(least_w, p_warped[i].z) : least_w;
		greatest_w = p_is_here[i] ? max(greatest_w, p_warped[i].z) : greatest_w;
	}
	least_w = subgroupMin(least_w);
	greatest_w = subgroupMax(greatest_w);
	const float split = least_w < greatest_w ? find_split(p_view, least_w, greatest_w) : -COUNT_FAR;
	CountBounds near = make_count_bounds();
	CountBounds far = make_count_bounds();
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		const bool is_near = p_is_here[i] && p_warped[i].z >= split;
		const bool is_far = p_is_here[i] && p_warped[i].z < split;
		near.least = is_near ? min(near.least, p_warped[i]) : near.least;
		near.greatest = is_near ? max(near.greatest, p_warped[i]) : near.greatest;
		far.least = is_far ? min(far.least, p_warped[i]) : far.least;
		far.greatest = is_far ? max(far.greatest, p_warped[i]) : far.greatest;
	}
	near = CountBounds(subgroupMin(near.least), subgroupMax(near.greatest));
	far = CountBounds(subgroupMin(far.least), subgroupMax(far.greatest));
	if (subgroupElect()) {
		const uint group = gl_WorkGroupID.y * light.group_count.x + gl_WorkGroupID.x;
		const uint first = (group * VIEW_COUNT + p_view) * uint(EDGE_COUNT_BOXES_PER_GROUP);
		boxes[first + EDGE_COUNT_BOX_NEAR] = pack_count_bounds(light.views[p_view], near);
		boxes[first + EDGE_COUNT_BOX_FAR] = pack_count_bounds(light.views[p_view], far);
	}
}

void main() {
	vec3 warped[PIXELS_PER_INVOCATION];
	bool is_there[PIXELS_PER_INVOCATION];
	uint views[PIXELS_PER_INVOCATION];
	for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
		is_there[i] =
				load_warped(i * gl_WorkGroupSize.x + gl_SubgroupInvocationID, warped[i], views[i]);
	}
	for (uint v = 0u; v < VIEW_COUNT; ++v) {
		bool is_here[PIXELS_PER_INVOCATION];
		for (uint i = 0u; i < PIXELS_PER_INVOCATION; ++i) {
			is_here[i] = is_there[i] && views[i] == v;
		}
		write_boxes(v, warped, is_here);
	}
}
