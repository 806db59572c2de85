// The layer map and the texel at which a receiver's solids are counted: LayerMap in float32.
#ifndef COUNT_LAYERS_INC_GLSL
#define COUNT_LAYERS_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"

// Shares of w (directional: of a length); see count_visibility.cpp.
const float COUNT_AWAY_TOLERANCE = 5e-5;
const float COUNT_TOWARD_TOLERANCE = 3e-4;
const float COUNT_DOUBLE_SIDED_TOLERANCE = 3e-3;
const float COUNT_STEEP_SLOPE = 3e-3;
const float COUNT_BAD_TEXEL = 1e6; // square texels: farther than any good one
const float COUNT_LOW_CLEARANCE = 0.02; // above which a solid leaves room for the way to a texel
const float COUNT_LOW_TEXEL = 2.0;		// square texels: where there is none

/// First fragment of a texel, and how many there are, with LAYERS_BURIED and
/// LAYERS_ONLY_AWAY. Texels of all views stand one
/// after the other, by view, row and column.
uvec2 load_count_texel(uint p_index);
/// w of a fragment, and its kind: 0 turned towards the light, 1 away, 2 of a double-sided mesh.
vec2 load_count_fragment(uint p_index);

/// Where the solids before a receiver are counted: the centre of a texel of the layer map.
struct CountReference {
	vec2 offset; // from the receiver in x', y'
	float w;	 // of the receiver's plane there
	int solid_count;
};

struct CountTexel {
	vec2 offset; // of its centre from the receiver, x', y'
	float rise;	 // of the receiver's plane there, not below 0
	int away_count;
	float clearance; // below the nearest solid; a share, as the tolerances
	bool is_bad; // buried, or inside a solid
};

vec2 count_texel_center(CountViewConstants p_view, ivec2 p_texel) {
	return ((vec2(p_texel) + 0.5) / vec2(p_view.map_size_px) * 2.0 - 1.0) * p_view.half_extent;
}

CountTexel count_texel(CountViewConstants p_view, CountReceiver p_receiver, ivec2 p_texel) {
	CountTexel texel;
	texel.offset = count_texel_center(p_view, p_texel) - p_receiver.warped.xy;
	texel.rise = max(count_rise(p_receiver, texel.offset), 0.0);
	const float w = p_receiver.warped.z + texel.rise;
	const float scale = count_depth_scale(p_view, w);
	const uvec2 range = load_count_texel(
			(p_view.index * p_view.map_size_px.y + uint(p_texel.y)) * p_view.map_size_px.x +
			uint(p_texel.x));
	texel.away_count = 0;
	texel.clearance = COUNT_LOW_CLEARANCE;
	int toward_count = 0;
	const uint count = range.y & LAYERS_COUNT_MASK;
	uint i = 0u;
	do { // asks at its end: see count_resolve_inc.glsl
		const bool is_there = i < count;
		const vec2 fragment = is_there ? load_count_fragment(range.x + i) : vec2(0.0);
		const float height = (fragment.x - w) / scale;
		const float toward_tolerance =
				fragment.y == 2.0 ? COUNT_DOUBLE_SIDED_TOLERANCE : COUNT_TOWARD_TOLERANCE;
		const bool is_away = is_there && fragment.y >= 1.0 && height > COUNT_AWAY_TOLERANCE;
		texel.away_count += is_away ? 1 : 0;
		texel.clearance = is_away ? min(texel.clearance, height) : texel.clearance;
		toward_count += is_there && fragment.y != 1.0 && height > toward_tolerance ? 1 : 0;
		++i;
	} while (i < count);
	const bool is_inside =
			(range.y & LAYERS_ONLY_AWAY) == 0u && texel.away_count != toward_count;
	texel.is_bad = (range.y & LAYERS_BURIED) != 0u || is_inside;
	return texel;
}

/// The nearest texel, unless it says little: then the best of the nine about it. Beside the map, which
/// holds all casters, nothing lies between the receiver and the light's centre.
CountReference find_count_reference(CountViewConstants p_view, CountReceiver p_receiver) {
	const vec2 place = (p_receiver.warped.xy / p_view.half_extent * 0.5 + 0.5) *
			vec2(p_view.map_size_px);
	const ivec2 last = ivec2(p_view.map_size_px) - 1;
	const ivec2 nearest = clamp(ivec2(floor(place)), ivec2(0), last);
	CountTexel chosen = count_texel(p_view, p_receiver, nearest);
	const float steep = COUNT_STEEP_SLOPE * p_receiver.scale;
	// A loop of no rounds and not a branch: software drivers run what a branch skips.
	const int candidate_count = chosen.is_bad || chosen.rise > steep ? 9 : 0;
	float least = 1e30;
	for (int i = 0; i < candidate_count; ++i) {
		const ivec2 texel = nearest + ivec2(i % 3, i / 3) - 1;
		const ivec2 inside = clamp(texel, ivec2(0), last);
		const CountTexel here = count_texel(p_view, p_receiver, inside);
		const vec2 away = vec2(inside) + 0.5 - place;
		const float rise = here.rise / steep;
		const float low = 1.0 - here.clearance / COUNT_LOW_CLEARANCE;
		const float cost = dot(away, away) + rise * rise + COUNT_LOW_TEXEL * low +
				(here.is_bad ? COUNT_BAD_TEXEL : 0.0);
		if (texel == inside && cost < least) {
			least = cost;
			chosen = here;
		}
	}
	const bool is_inside = all(lessThanEqual(abs(p_receiver.warped.xy), p_view.half_extent));
	return CountReference(is_inside ? chosen.offset : vec2(0.0),
			p_receiver.warped.z + (is_inside ? chosen.rise : 0.0),
			is_inside ? chosen.away_count : 0);
}

#endif
