// Boxes in scalar registers of GPUs.
#ifndef UNIFORM_BOX_INC_GLSL
#define UNIFORM_BOX_INC_GLSL

#include "shadow_edge_count/count_box_inc.glsl"

// Of subgroup_inc.glsl, which is included later.
float subgroup_uniform(float p_value);
vec2 subgroup_uniform(vec2 p_value);
vec3 subgroup_uniform(vec3 p_value);
vec4 subgroup_uniform(vec4 p_value);

/// All invocations must be active, and have the same box.
CountBox make_uniform_box(CountBox p_box) {
	CountBox box = p_box;
	box.above = subgroup_uniform(box.above);
	box.below = subgroup_uniform(box.below);
	box.smooth_fraction = subgroup_uniform(box.smooth_fraction);
	for (int i = 0; i < 4; ++i) {
		box.outside[i] = subgroup_uniform(box.outside[i]);
	}
	box.frame.x = subgroup_uniform(box.frame.x);
	box.frame.y = subgroup_uniform(box.frame.y);
	box.frame.z = subgroup_uniform(box.frame.z);
	box.center = subgroup_uniform(box.center);
	box.half_size = subgroup_uniform(box.half_size);
	box.slope = subgroup_uniform(box.slope);
	box.range = subgroup_uniform(box.range);
	box.margin = subgroup_uniform(box.margin);
	return box;
}

#endif
