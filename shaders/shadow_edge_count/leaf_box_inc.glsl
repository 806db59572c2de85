// Boxes of leaves, in scalar registers of GPUs. Include it after SUBGROUP_SIZE is defined.
#ifndef LEAF_BOX_INC_GLSL
#define LEAF_BOX_INC_GLSL

#include "common/subgroup_inc.glsl"
#include "shadow_edge_count/leaf_inc.glsl"

/// The box of receivers of the leaf, which have these bounds. p_radius: see make_count_box. All invocations must be active, and
/// have the same bounds.
CountBox make_leaf_box(CountLeaf p_leaf, CountBounds p_bounds, float p_radius) {
	CountBox box = make_count_box(light, p_radius, make_count_frame(p_leaf.axis_distance.xyz), p_bounds,
			p_leaf.axis_distance.w, is_wide_leaf(p_leaf));
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
