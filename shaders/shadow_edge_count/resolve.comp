#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/count_output_inc.glsl"
#include "shadow_edge_count/count_unfinished_inc.glsl"

// Resolves leaves with edges.
void main() {
	load_count_constants();
	iteration_limit = light.unfinished_round_count > 0u ? uint(EDGE_COUNT_MAX_ITERATIONS) : NO_ITERATION_LIMIT;
	bool is_valid;
	const uint leaf = find_group_leaf(is_valid);
	if (HAS_RUNGS && !is_valid) {
		return; // another pass resolves the leaf
	}
	const CountSubject subject = load_group_subject(leaf, is_valid);
	bool is_unfinished;
	const float visibility = find_visibility(count_receiver(subject, find_solids(subject), is_unfinished));
	if (subject.is_receiver && !is_unfinished) {
		imageStore(mask_image, subject.pixel, vec4(visibility));
	}
	add_unfinished(leaf, is_unfinished);
}
