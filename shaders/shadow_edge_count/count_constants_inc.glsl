// Copies the light's constants to variables. llvmpipe takes one instruction to read a word of a constant block at the
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

/// Selects by comparison, since a read with an index that differs between invocations takes longer.
CountViewConstants load_count_view(uint p_view) {
	CountViewConstants view = light.views[0];
	for (uint i = 1u; i < VIEW_COUNT; ++i) {
		if (p_view == i) {
			view = light.views[i];
		}
	}
	return view;
}

#endif
