#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/count_output_inc.glsl"

// Resolves leaves of which EDGE_COUNT_FEW_PIXELS receivers are counted, and the others interpolated.
//
// Smooth leaves (EDGE_COUNT_LEAVES_SMOOTH): every pixel of the block has a receiver, the receivers are on one nearly flat
// surface, and all silhouette edges that they see before the light are far from them. So the image of each edge on the
// light's disc moves by a small fraction of R from one side of the block to the other, and the visibility is nearly a
// polynomial of the pixel's position. A least-squares polynomial of degree 3 gives the values of all 64 pixels. Its 10
// coefficients also smooth the noise of the points on the disc.
//
// Leaves on EDGE_COUNT_RUNG_FEW_PIXELS: of each quad of 2 x 2 pixels one receiver is counted, and the others get a mean of
// the nearest counted ones.
layout(constant_id = EDGE_COUNT_CONSTANT_IS_SMOOTH) const bool IS_SMOOTH = false;

const uint SIDE = SMOOTH_SIDE; // of the block, in counted pixels
const int MAX_DEGREE = 3;
const uint PIXELS_PER_INVOCATION = uint(EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX) / gl_WorkGroupSize.x;

shared vec2 counted[SIDE * SIDE]; // visibility, or 0; 1 if there is a receiver, else 0; of quads by row and column
shared float coefficients[SIDE * SIDE]; // those of a degree above MAX_DEGREE are not used

/// Polynomials of degree 0 to 3 at a row or column p_line of the block, orthonormal over the four counted ones. Their
/// variable u is -1 at the first line and 1 at the last; the counted lines have u = +-1 and +-NEAR.
vec4 find_basis(uint p_line) {
	const float HALF = 3.5; // lines from the middle of the block to the first one
	const float NEAR = 1.5 / HALF;
	const float SQUARE = NEAR * NEAR;
	const float SUM = 1.0 + SQUARE; // half the sum of u^2 over the lines
	const float RATIO = (1.0 + SQUARE * SQUARE) / SUM; // of the sums of u^4 and u^2: u^3 - RATIO u is orthogonal to u
	// Half the sum of the squares of u^3 - RATIO u over the lines.
	const float CUBIC = (1.0 - RATIO) * (1.0 - RATIO) + SQUARE * (SQUARE - RATIO) * (SQUARE - RATIO);
	const float u = float(p_line) / HALF - 1.0;
	return vec4(0.5, u * inversesqrt(2.0 * SUM), (u * u - 0.5 * SUM) / (1.0 - SQUARE),
			u * (u * u - RATIO) * inversesqrt(2.0 * CUBIC));
}

/// The coefficient of the product of basis p_index % SIDE along x and basis p_index / SIDE along y.
float find_coefficient(uint p_index) {
	float sum = 0.0;
	for (uint i = 0u; i < SIDE * SIDE; ++i) {
		const uvec2 pixel = find_smooth_pixel(i);
		sum += counted[i].x * find_basis(pixel.x)[p_index % SIDE] * find_basis(pixel.y)[p_index / SIDE];
	}
	return sum;
}

/// The polynomial's value at a pixel, 0..1.
float find_fitted(uvec2 p_pixel) {
	const vec4 x = find_basis(p_pixel.x);
	const vec4 y = find_basis(p_pixel.y);
	float sum = 0.0;
	for (int row = 0; row <= MAX_DEGREE; ++row) {
		for (int column = 0; column <= MAX_DEGREE - row; ++column) {
			sum += coefficients[row * int(SIDE) + column] * x[column] * y[row];
		}
	}
	return clamp(sum, 0.0, 1.0);
}

/// The mean of the counted receivers of the four quads around a pixel, with weights of bilinear interpolation.
float find_interpolated(uvec2 p_pixel) {
	const vec2 position = clamp(0.5 * vec2(p_pixel) - 0.25, vec2(0.0), vec2(float(SIDE - 1u)));
	const uvec2 first = min(uvec2(position), uvec2(SIDE - 2u));
	const vec2 fraction = position - vec2(first);
	vec2 sum = vec2(0.0);
	for (uint i = 0u; i < 4u; ++i) {
		const uvec2 offset = uvec2(i & 1u, i >> 1);
		const vec2 weights = mix(1.0 - fraction, fraction, vec2(offset));
		const uvec2 quad = first + offset;
		sum += weights.x * weights.y * counted[quad.y * SIDE + quad.x];
	}
	return clamp(sum.x / sum.y, 0.0, 1.0); // the pixel's own quad has a receiver
}

void main() {
	load_count_constants();
	const uint invocation = gl_LocalInvocationIndex;
	bool is_valid;
	const uint leaf = find_group_leaf(is_valid);
	if (HAS_RUNGS && !is_valid) {
		return; // another pass resolves the leaf
	}
	const uvec2 pixels = leaves[leaf].pixels_flags.xy;
	const uint item = invocation / LANES_PER_RECEIVER;
	// Pixels 4 i .. 4 i + 3 are a quad, see find_pixel_in_block.
	const uint quad_bits = (item < 8u ? pixels.x : pixels.y) >> (4u * (item % 8u)) & 15u;
	const uint item_pixel =
			IS_SMOOTH ? find_pixel_index(find_smooth_pixel(item)) : 4u * item + uint(max(findLSB(quad_bits), 0));
	const CountSubject subject = load_subject(leaf, item_pixel, is_valid && (IS_SMOOTH || quad_bits != 0u));
	bool is_unfinished; // never: such leaves have few edges
	const float visibility = find_visibility(count_receiver(subject, find_solids(subject), is_unfinished));
	// All lanes of a receiver write the same.
	const uvec2 quad = find_pixel_in_block(4u * item) / 2u;
	counted[IS_SMOOTH ? item : quad.y * SIDE + quad.x] = subject.is_receiver ? vec2(visibility, 1.0) : vec2(0.0);
	barrier();
	if (IS_SMOOTH) {
		coefficients[item] = find_coefficient(item);
		barrier();
	}
	for (uint i = 0u; i < PIXELS_PER_INVOCATION && is_valid; ++i) {
		const uint index = i * gl_WorkGroupSize.x + invocation;
		if (IS_SMOOTH || ((index < 32u ? pixels.x : pixels.y) >> (index % 32u) & 1u) != 0u) {
			const uvec2 pixel = find_pixel_in_block(index);
			imageStore(mask_image, find_image_pixel(subject.leaf, index),
					vec4(IS_SMOOTH ? find_fitted(pixel) : find_interpolated(pixel)));
		}
	}
}
