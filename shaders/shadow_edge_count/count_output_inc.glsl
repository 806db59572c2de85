// The mask of the passes that count edges. On GPUs it first has the receivers' solids, which count_solids.comp writes: in
// a pass of their own they take fewer registers, and are not counted again by each of a receiver's invocations.
#ifndef COUNT_OUTPUT_INC_GLSL
#define COUNT_OUTPUT_INC_GLSL

#include "shadow_edge_count/count_resolve_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_OUTPUT, r16f) uniform image2D mask_image;

/// The solids on the way of a receiver whose mask is not written yet, see pack_solids. All invocations must be active.
int find_solids(CountSubject p_subject) {
	if (IS_CPU) {
		return pack_solids(count_subject_crossings(p_subject));
	}
	return int(p_subject.is_receiver ? imageLoad(mask_image, p_subject.pixel).x : 0.0);
}

#endif
