// Computes the vertices of a shadow volume. All extrusion methods use the same code, so that sides and caps meet
// without cracks.
#ifndef VOLUME_INC_GLSL
#define VOLUME_INC_GLSL

#include "shadow_volume/shadow_volume_shared.h"

layout(push_constant) uniform Push {
	VolumePush push;
};
// Members of VolumeShape. ROBUST_FACES is one of VOLUMES_FACES_*.
layout(constant_id = VOLUMES_CONSTANT_ROBUST_FACES) const uint ROBUST_FACES = VOLUMES_FACES_NONE;
layout(constant_id = VOLUMES_CONSTANT_HAS_FAR_CAP) const bool HAS_FAR_CAP = true;

/// True when the selection p_faces (VOLUMES_FACES_*) includes a face of a solid, or not solid, part of the mesh.
bool volume_includes(uint p_faces, bool p_is_solid) {
	return p_faces == VOLUMES_FACES_ALL || (p_faces == VOLUMES_FACES_NOT_SOLID && !p_is_solid);
}

/// Clip position of a caster's vertex or, with p_is_far, of its projection from the light to infinity (w = 0). With
/// reversed depth and the far plane at infinity, the depth at infinity is exactly 0, so that nothing is clipped there.
vec4 volume_position_clip(vec3 p_position_node, bool p_is_far) {
	precise const vec3 away = p_position_node * push.light_position_node.w - push.light_position_node.xyz;
	precise const vec4 corner_node = p_is_far ? vec4(away, 0.0) : vec4(p_position_node, 1.0);
	precise const vec4 position = push.clip_from_node * corner_node;
	return position;
}

// Vertices of a side along an edge a -> b of the light-facing surface. Bit 0: at b instead of a; bit
// 1: at infinity. Seen from outside the volume they are counter-clockwise, like the surface.
const uint VOLUME_SIDE_CORNERS[VOLUMES_VERTICES_PER_SIDE] = uint[VOLUMES_VERTICES_PER_SIDE](0u, 2u, 1u, 1u, 2u, 3u);
const uint VOLUME_AT_B = 1u;
const uint VOLUME_AT_INFINITY = 2u;

#endif
