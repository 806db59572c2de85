#version 460
// The farthest depth of the triangle's plane within the texel; reversed depth is linear there.
layout(depth_less) out float gl_FragDepth;

void main() {
	const float change = abs(dFdx(gl_FragCoord.z)) + abs(dFdy(gl_FragCoord.z));
	gl_FragDepth = max(gl_FragCoord.z - 0.5 * change, 0.0);
}
