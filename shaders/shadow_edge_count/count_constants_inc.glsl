// The light's constants in variables. Within loops and branches llvmpipe takes 20 instructions to read a word of a
// uniform block, and one where main() begins; so main() begins with load_light(), or with
// load_count_constants() of count_pixels_inc.glsl.
#ifndef COUNT_CONSTANTS_INC_GLSL
#define COUNT_CONSTANTS_INC_GLSL

#include "shadow_edge_count/count_parts_inc.glsl"

layout(std140, set = 0, binding = COUNT_BINDING_LIGHT) restrict readonly buffer Light {
	CountLightConstants light_block;
};

CountLightConstants light; // views: only the first

void load_light() {
	light = light_block;
}

/// One view needs no reading by index.
CountViewConstants load_count_view(uint p_view) {
	if (VIEW_COUNT == 1u) {
		return light.views[0];
	}
	return light_block.views[p_view];
}

#endif
