#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
#include "shadow_edge_count/count_solids_inc.glsl"

// Resolves leaves without edges: a receiver is lit if it sees the light's centre, else dark.
layout(set = 0, binding = COUNT_BINDING_OUTPUT, r16f) uniform writeonly image2D mask_image;

void main() {
	load_count_constants();
	bool is_valid;
	const uint leaf = find_group_leaf(is_valid);
	const CountSubject subject = load_group_subject(leaf, is_valid);
	const CountCrossings crossings = count_subject_crossings(subject);
	if (subject.is_receiver) {
		imageStore(mask_image, subject.pixel, vec4(sum_crossings(crossings) == 0 ? 1.0 : 0.0));
	}
	report_subgroup_status();
}
