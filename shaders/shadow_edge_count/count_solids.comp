#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/count_solids_inc.glsl"

// Counts the solids between a leaf's receivers and the light's centre. Leaves without edges are resolved thereby: a
// receiver is lit if it sees the light's centre, else dark. For others the mask has the solids until their edges are
// counted, see count_output_inc.glsl.
layout(set = 0, binding = COUNT_BINDING_OUTPUT, r16f) uniform writeonly image2D mask_image;

void main() {
	load_count_constants();
	bool is_valid;
	const uint leaf = find_group_leaf(is_valid);
	// Of smooth leaves only some receivers are counted.
	const bool is_smooth = push.kind == uint(EDGE_COUNT_LEAVES_SMOOTH);
	const uint invocation = gl_LocalInvocationIndex;
	const CountLeaf group_leaf = leaves[leaf];
	const uint pixel = is_smooth ? find_pixel_index(find_smooth_pixel(invocation % uint(EDGE_COUNT_FEW_PIXELS)))
								 : find_set_bit(group_leaf.pixels_flags.xy, invocation);
	const uint count = is_smooth ? uint(EDGE_COUNT_FEW_PIXELS) : count_leaf_pixels(group_leaf);
	const CountSubject subject = load_subject(leaf, pixel, is_valid && invocation < count);
	const int solids = pack_solids(count_subject_crossings(subject));
	const bool is_plain = push.kind == uint(EDGE_COUNT_LEAVES_PLAIN);
	if (subject.is_receiver) {
		imageStore(mask_image, subject.pixel, vec4(is_plain ? float(unpack_solid_count(solids) == 0) : float(solids)));
	}
	report_subgroup_status();
}
