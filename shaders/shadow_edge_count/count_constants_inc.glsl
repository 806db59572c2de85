// Copies the light's constants to a variable. llvmpipe takes one instruction to read a word of a constant block at the
// start of main(), and 20 within loops and branches. So main() starts with load_light(), or with
// load_count_constants() of count_pixels_inc.glsl.
#ifndef COUNT_CONSTANTS_INC_GLSL
#define COUNT_CONSTANTS_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

layout(std140, set = 0, binding = COUNT_BINDING_LIGHT) restrict readonly buffer Light {
	CountLightConstants light_block;
};

CountLightConstants light;

void load_light() {
	light = light_block;
}

#endif
