#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_volume/bounds_inc.glsl"

// Tests which casters are not hidden from the light. One workgroup per subtree: if its box is
// hidden, so are all its casters; otherwise each caster is tested.
layout(local_size_x = CULLING_CASTERS_PER_SUBTREE) in;
layout(std140, set = 0, binding = CULLING_BINDING_CONSTANTS) restrict readonly buffer Constants {
	CullingConstants constants;
};
layout(std430, set = 0, binding = CULLING_BINDING_BOUNDS) readonly buffer Bounds {
	float bounds[];
};
layout(std430, set = 0, binding = CULLING_BINDING_BOXES) readonly buffer Boxes {
	CullingBox boxes[];
};
layout(std430, set = 0, binding = CULLING_BINDING_WORDS) writeonly buffer Words {
	uint words[]; // after the header one per caster, 0 = hidden
};

// Boxes are grown by this fraction of their distance, for rounding in float32.
const float GROWTH = 1e-5;
const float GROWTH_PX = 0.01;
// A box must be behind the bound by this fraction of its distance (orthographic: of the view's
// depth).
const float LEAST_GAP = 1e-3;
const int MOST_TEXELS = 6; // maximum texels of a level along a box's side

const uint SEEN = 0u;
const uint HIDDEN = 1u;
const uint OUTSIDE = 2u;

shared bool is_subtree_hidden;

bool is_behind(uint p_view, vec2 p_least_ndc, vec2 p_greatest_ndc, float p_depth) {
	const float size_px = float(CULLING_MAP_SIZE_PX);
	const vec2 begin = (p_least_ndc * 0.5 + 0.5) * size_px - GROWTH_PX;
	const vec2 end = (p_greatest_ndc * 0.5 + 0.5) * size_px + GROWTH_PX;
	ivec2 first = ivec2(clamp(floor(begin), 0.0, size_px - 1.0));
	ivec2 last = ivec2(clamp(floor(end), 0.0, size_px - 1.0));
	uint level = 0u;
	while (level + 1u < CULLING_LEVEL_COUNT && max(last.x - first.x, last.y - first.y) >= MOST_TEXELS) {
		++level;
		first /= CULLING_LEVEL_FACTOR;
		last /= CULLING_LEVEL_FACTOR;
	}
	for (int y = first.y; y <= last.y; ++y) {
		for (int x = first.x; x <= last.x; ++x) {
			if (bounds[bounds_index(p_view, level, uvec2(x, y))] <= p_depth) {
				return false;
			}
		}
	}
	return true;
}

/// What the view knows about the part of the box that is in it. Depths that are compared are greater
/// than the box's by the gap.
uint look_at(uint p_view, CullingBox p_box) {
	const CullingView view = constants.views[p_view];
	const mat3 axes = mat3(view.view_from_relative);
	const vec3 center = (view.view_from_relative * vec4(p_box.center_m.xyz, 1.0)).xyz;
	const vec3 size = p_box.half_extent_m.xyz;
	vec3 half_size = abs(axes[0]) * size.x + abs(axes[1]) * size.y + abs(axes[2]) * size.z;
	const vec3 reach = abs(center) + half_size;
	half_size += GROWTH * max(max(reach.x, reach.y), reach.z);
	const vec3 low = center - half_size;
	const vec3 high = center + half_size;
	vec2 least;
	vec2 greatest;
	float depth;
	if (view.is_orthographic != 0u) {
		least = low.xy / view.half_extent;
		greatest = high.xy / view.half_extent;
		depth = (view.far_m - low.z) / (view.far_m - view.near_m) + LEAST_GAP;
	} else {
		// In the view |x| <= half_extent z, so that the box's part in it begins here at the least.
		const vec2 nearest_z = max(max(low.xy, -high.xy), 0.0) / view.half_extent;
		const float begin = max(max(low.z, view.near_m), max(nearest_z.x, nearest_z.y));
		if (begin > high.z) {
			return OUTSIDE;
		}
		least = mix(low.xy / high.z, low.xy / begin, lessThan(low.xy, vec2(0.0))) / view.half_extent;
		greatest = mix(high.xy / high.z, high.xy / begin, greaterThan(high.xy, vec2(0.0))) / view.half_extent;
		if (low.z > view.near_m) {
			// Its own corners are closer than those of the box round it.
			vec2 corner_least = vec2(1e30);
			vec2 corner_greatest = vec2(-1e30);
			for (uint i = 0u; i < 8u; ++i) {
				const vec3 corner = center + axes * (size * (vec3(i & 1u, i >> 1u & 1u, i >> 2u) * 2.0 - 1.0));
				corner_least = min(corner_least, corner.xy / corner.z);
				corner_greatest = max(corner_greatest, corner.xy / corner.z);
			}
			least = max(least, corner_least / view.half_extent - GROWTH);
			greatest = min(greatest, corner_greatest / view.half_extent + GROWTH);
		}
		depth = view.near_m / begin * (1.0 + LEAST_GAP);
	}
	if (any(greaterThan(least, vec2(1.0))) || any(lessThan(greatest, vec2(-1.0)))) {
		return OUTSIDE;
	}
	const bool is_within = all(greaterThanEqual(least, vec2(-1.0))) && all(lessThanEqual(greatest, vec2(1.0)));
	if (constants.view_count == 1u && !is_within) {
		return SEEN; // nothing is known outside the view
	}
	return is_behind(p_view, least, greatest, depth) ? HIDDEN : SEEN;
}

bool is_hidden(CullingBox p_box) {
	bool is_in_a_view = false;
	for (uint view = 0u; view < constants.view_count; ++view) {
		const uint found = look_at(view, p_box);
		if (found == SEEN) {
			return false;
		}
		is_in_a_view = is_in_a_view || found == HIDDEN;
	}
	return is_in_a_view;
}

void main() {
	const CullingBox subtree = boxes[gl_WorkGroupID.x];
	const uint lane = gl_LocalInvocationIndex;
	if (lane == 0u) {
		is_subtree_hidden = is_hidden(subtree);
		if (gl_WorkGroupID.x == 0u) {
			words[0] = constants.key_low;
			words[1] = constants.key_high;
		}
	}
	barrier();
	if (lane < subtree.count) {
		const CullingBox box = boxes[subtree.first + lane];
		words[CULLING_HEADER_WORDS + box.first] = is_subtree_hidden || is_hidden(box) ? 0u : 1u;
	}
}
