// The entry point of resolve.comp and resolve_fine.comp, which write the mask of leaves with edges.
#ifndef COUNT_MASK_INC_GLSL
#define COUNT_MASK_INC_GLSL

#include "shadow_edge_count/count_output_inc.glsl"
#include "shadow_edge_count/count_unfinished_inc.glsl"

void main() {
	load_count_constants();
	iteration_limit = light.unfinished_round_count > 0u ? uint(EDGE_COUNT_MAX_ITERATIONS) : NO_ITERATION_LIMIT;
	bool is_valid;
	const uint leaf = find_group_leaf(is_valid);
	if (HAS_RUNGS && !is_valid) {
		return; // another pass resolves the leaf
	}
	const CountSubject subject = load_group_subject(leaf, is_valid);
	const CountPixel pixel = count_pixel(subject, find_solids(subject));
	if (pixel.is_receiver && !pixel.is_unfinished) {
		imageStore(mask_image, pixel.pixel, vec4(pixel.visibility));
	}
	add_unfinished(subject.leaf_index, pixel.is_unfinished);
}

#endif
