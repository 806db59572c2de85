// The entry point of resolve_smooth.comp and resolve_smooth_fine.comp, which write the mask of smooth leaves
// (EDGE_COUNT_LEAVES_SMOOTH): every pixel of the block has a receiver, the receivers are on one nearly flat surface, and all
// silhouette edges that they see before the light are far from them.
//
// In such a leaf the image of each edge on the light's disc moves by a small fraction of R from one side of the block
// to the other, so the visibility is nearly a polynomial of the pixel's position. 16 of the 64 pixels are counted, and
// a least-squares polynomial of degree 3 gives the values of all 64. Its 10 coefficients also smooth the noise of the
// points on the disc.
#ifndef COUNT_SMOOTH_INC_GLSL
#define COUNT_SMOOTH_INC_GLSL

#include "shadow_edge_count/count_output_inc.glsl"

const uint SIDE = SMOOTH_SIDE;
const int MAX_DEGREE = 3;
const uint PIXELS_PER_INVOCATION = uint(EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX) / gl_WorkGroupSize.x;

shared float counted[SIDE * SIDE]; // visibility
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
		sum += counted[i] * find_basis(pixel.x)[p_index % SIDE] * find_basis(pixel.y)[p_index / SIDE];
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

void main() {
	load_count_constants();
	const uint invocation = gl_LocalInvocationIndex;
	bool is_valid;
	const uint leaf = find_group_leaf(is_valid);
	if (HAS_RUNGS && !is_valid) {
		return; // another pass resolves the leaf
	}
	const uint item = invocation / LANES_PER_RECEIVER;
	const CountSubject subject = load_subject(leaf, find_pixel_index(find_smooth_pixel(item)), is_valid);
	counted[item] = count_pixel(subject, find_solids(subject)).visibility; // all lanes of a receiver have the same
	barrier();
	coefficients[item] = find_coefficient(item);
	barrier();
	for (uint i = 0u; i < PIXELS_PER_INVOCATION && is_valid; ++i) {
		const uint index = i * gl_WorkGroupSize.x + invocation;
		imageStore(mask_image, find_image_pixel(subject.leaf, index), vec4(find_fitted(find_pixel_in_block(index))));
	}
}

#endif
