#version 460
#extension GL_GOOGLE_include_directive : require
#include "editor/ui_shared.h"

// Draws the editor's triangles. Positions are in pixels from the top left.
layout(push_constant) uniform Push {
	UiPush push;
};
layout(location = 0) in vec2 in_position_px;
layout(location = 1) in vec2 in_uv;
layout(location = 2) in vec4 in_color;
layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec4 out_color;

void main() {
	out_uv = in_uv;
	out_color = in_color;
	gl_Position = vec4(in_position_px * push.clip_per_px - 1.0, 0.0, 1.0);
}
