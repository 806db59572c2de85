#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/depth_inc.glsl"
#include "common/normal_inc.glsl"
#include "renderer/gbuffer_inc.glsl"

// gbuffer.frag for devices without gl_PrimitiveID in fragment shaders. It writes no geometric normal, because
// derivatives are too inaccurate for it at grazing angles.
layout(set = 0, binding = GBUFFER_BINDING_FRAME) uniform Frame { // why uniform: gbuffer_inc.glsl
	FrameConstants frame;
};
layout(std430, set = 0, binding = GBUFFER_BINDING_INSTANCES) readonly buffer Instances {
	GBufferInstance instances[];
};

layout(location = 0) in vec3 in_normal; // world axes; 0 where the mesh has none
layout(location = 4) flat in uint in_instance;
layout(location = 0) out vec4 out_base_color;
layout(location = 1) out uint out_shading_normal;
layout(location = 2) out vec4 out_material;
layout(location = 3) out vec4 out_emissive;

void main() {
	// An approximate face normal, only for meshes without normals and to find the visible side.
	const vec3 position = position_from_depth(frame, ivec2(gl_FragCoord.xy), gl_FragCoord.z);
	const vec3 scaled_face_normal = cross(dFdx(position), dFdy(position));
	const float length2 = dot(scaled_face_normal, scaled_face_normal);
	const vec3 face = length2 > 0.0 ? scaled_face_normal * inversesqrt(length2) : -normalize(position);
	const vec3 shading = make_shading_normal(in_normal, dot(face, position) > 0.0 ? -face : face);

	const SurfaceTexels texels = make_texels(instances[in_instance], shading);
	out_base_color = texels.base_color;
	out_shading_normal = pack_normal(texels.shading_normal);
	out_material = texels.material;
	out_emissive = vec4(texels.emissive, 1.0);
}
