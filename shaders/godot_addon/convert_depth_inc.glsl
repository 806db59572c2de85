#include "godot_addon/godot_addon_shared.h"

layout(push_constant) uniform Push {
	ConvertDepthPush push;
};

// Converts Godot's depth, which is 1 at the near plane and 0 at the far plane, to near / z. The background stays 0.
float convert_depth(float depth) {
	return depth > 0.0 ? (depth + push.offset) / (1.0 + push.offset) : 0.0;
}
