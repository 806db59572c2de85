// Copies the light's constants to variables. llvmpipe takes one instruction to read a word of a uniform block at the
// start of main(), and 20 within loops and branches. So main() starts with load_light(), or with
// load_count_constants() of count_pixels_inc.glsl.
#ifndef COUNT_CONSTANTS_INC_GLSL
#define COUNT_CONSTANTS_INC_GLSL

#include "shadow_edge_count/count_parts_inc.glsl"

layout(std140, set = 0, binding = COUNT_BINDING_LIGHT) restrict readonly buffer Light {
	CountLightConstants light_block;
};

CountLightConstants light; // for views other than the first, use load_count_view

void load_light() {
	light = light_block;
}

/// Avoids indexing if the light has one view.
CountViewConstants load_count_view(uint p_view) {
	if (VIEW_COUNT == 1u) {
		return light.views[0];
	}
	return light_block.views[p_view];
}

#endif
