#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
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
	uint words[]; // CULLING_HEADER_WORDS, then one per caster: 0 = hidden, 1 = not hidden
};

// Boxes are grown by this fraction of their distance, for rounding in float32.
const float GROWTH = 1e-5;
const float GROWTH_PX = 0.01; // and their projections by this many texels
// A box must be behind the occluders' depth by this fraction of its distance (orthographic: of the
// view's depth range).
const float MIN_GAP = 1e-3;
const int MAX_TEXELS = 6; // the finest level is used at which a box covers at most 6 x 6 texels

const uint VISIBLE = 0u;
const uint HIDDEN = 1u;
const uint OUTSIDE = 2u;

shared bool is_subtree_hidden;

/// True when the occluders in all texels of the rectangle are nearer than the reversed depth p_depth.
bool is_behind(uint p_view, vec2 p_min_ndc, vec2 p_max_ndc, float p_depth) {
	const float size_px = float(CULLING_MAP_SIZE_PX);
	const vec2 begin = (p_min_ndc * 0.5 + 0.5) * size_px - GROWTH_PX;
	const vec2 end = (p_max_ndc * 0.5 + 0.5) * size_px + GROWTH_PX;
	ivec2 first = ivec2(clamp(floor(begin), 0.0, size_px - 1.0));
	ivec2 last = ivec2(clamp(floor(end), 0.0, size_px - 1.0));
	uint level = 0u;
	while (level + 1u < CULLING_LEVEL_COUNT && max(last.x - first.x, last.y - first.y) >= MAX_TEXELS) {
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

/// Classifies what of the box is inside the view: VISIBLE (not certainly hidden), HIDDEN (behind occluders) or
/// OUTSIDE (nothing is inside). The box's nearest depth is moved towards the light by MIN_GAP before it is compared.
uint test_box(uint p_view, CullingBox p_box) {
	const CullingView view = constants.views[p_view];
	const mat3 axes = mat3(view.view_from_relative);
	const vec3 center = (view.view_from_relative * vec4(p_box.center_m.xyz, 1.0)).xyz;
	const vec3 box_half = p_box.half_extent_m.xyz; // along the world's axes
	vec3 half_size = abs(axes[0]) * box_half.x + abs(axes[1]) * box_half.y + abs(axes[2]) * box_half.z;
	const vec3 reach = abs(center) + half_size;
	half_size += GROWTH * max(max(reach.x, reach.y), reach.z);
	const vec3 low = center - half_size;
	const vec3 high = center + half_size;
	vec2 min_ndc;
	vec2 max_ndc;
	float depth;
	if (view.is_orthographic != 0u) {
		min_ndc = low.xy / view.half_extent;
		max_ndc = high.xy / view.half_extent;
		depth = (view.far_m - low.z) / (view.far_m - view.near_m) + MIN_GAP;
	} else {
		// Inside the view |x| <= half_extent.x * z (and so for y), so points of the box inside it have at least this z.
		const vec2 nearest_z = max(max(low.xy, -high.xy), 0.0) / view.half_extent;
		const float begin = max(max(low.z, view.near_m), max(nearest_z.x, nearest_z.y));
		if (begin > high.z) {
			return OUTSIDE;
		}
		min_ndc = mix(low.xy / high.z, low.xy / begin, lessThan(low.xy, vec2(0.0))) / view.half_extent;
		max_ndc = mix(high.xy / high.z, high.xy / begin, greaterThan(high.xy, vec2(0.0))) / view.half_extent;
		if (low.z > view.near_m) {
			// The box's own corners give tighter bounds than the axis-aligned box around them in view space.
			vec2 corner_min = vec2(1e30);
			vec2 corner_max = vec2(-1e30);
			for (uint i = 0u; i < 8u; ++i) {
				const vec3 corner = center + axes * (box_half * (vec3(i & 1u, i >> 1u & 1u, i >> 2u) * 2.0 - 1.0));
				corner_min = min(corner_min, corner.xy / corner.z);
				corner_max = max(corner_max, corner.xy / corner.z);
			}
			min_ndc = max(min_ndc, corner_min / view.half_extent - GROWTH);
			max_ndc = min(max_ndc, corner_max / view.half_extent + GROWTH);
		}
		depth = view.near_m / begin * (1.0 + MIN_GAP);
	}
	if (any(greaterThan(min_ndc, vec2(1.0))) || any(lessThan(max_ndc, vec2(-1.0)))) {
		return OUTSIDE;
	}
	const bool is_within = all(greaterThanEqual(min_ndc, vec2(-1.0))) && all(lessThanEqual(max_ndc, vec2(1.0)));
	if (constants.view_count == 1u && !is_within) {
		return VISIBLE; // no occluders were drawn outside the only view
	}
	return is_behind(p_view, min_ndc, max_ndc, depth) ? HIDDEN : VISIBLE;
}

/// True when occluders hide the box in every view that it reaches into, and there is such a view.
bool is_hidden(CullingBox p_box) {
	bool is_in_a_view = false;
	for (uint view = 0u; view < constants.view_count; ++view) {
		const uint found = test_box(view, p_box);
		if (found == VISIBLE) {
			return false;
		}
		is_in_a_view = is_in_a_view || found == HIDDEN;
	}
	return is_in_a_view;
}

void main() {
	const uint group = find_work_group();
	if (group >= constants.subtree_count) {
		return;
	}
	const CullingBox subtree = boxes[group];
	const uint lane = gl_LocalInvocationIndex;
	if (lane == 0u) {
		is_subtree_hidden = is_hidden(subtree);
		if (group == 0u) {
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
