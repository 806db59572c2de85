#ifndef SHADOW_VOLUME_SHARED_H
#define SHADOW_VOLUME_SHARED_H
#include "shared/shared_begin.h"

// receivers.frag
#define RECEIVERS_BINDING_FRAME 0
#define RECEIVERS_BINDING_DEPTH 1
#define RECEIVERS_BINDING_NORMAL 2
#define RECEIVERS_BINDING_RECEIVERS 3
#define RECEIVERS_BINDING_LIGHT 4

// Volumes are drawn for a camera that is moved along this axis of the world, Y, by the offset of
// the nearest receiver. The depth test is then exact for receivers with that offset and that
// normal, such as floors, and at least as accurate as without the move for all others.
#define VOLUMES_OFFSET_AXIS 1

/// Push constants of receivers.frag
struct SHARED_ALIGN VolumeReceiversPush {
	float camera_move_m; // of the volumes' camera along VOLUMES_OFFSET_AXIS
	float padding0;
	float padding1;
	float padding2;
};
SHARED_SIZE(VolumeReceiversPush, 16);

// volumes.geom, sides.vert, caps.vert
#define VOLUMES_BINDING_FACE_FLAGS 0
#define VOLUMES_BINDING_POSITIONS 1
#define VOLUMES_BINDING_EDGES 2
#define VOLUMES_BINDING_LIST 3
#define VOLUMES_BINDING_TRIANGLES 4

// Specialization constants of the same shaders
#define VOLUMES_CONSTANT_ROBUST_FACES 0
#define VOLUMES_CONSTANT_HAS_FAR_CAP 1

// Values of VOLUMES_CONSTANT_ROBUST_FACES, the same as in VolumeFaces of volume_shape.h
#define VOLUMES_FACES_NONE 0
#define VOLUMES_FACES_NOT_SOLID 1
#define VOLUMES_FACES_ALL 2

// Vertices of one side: two triangles between the edge and its projection to infinity.
#define VOLUMES_VERTICES_PER_SIDE 6

/// Push constants of the draws: one caster.
struct SHARED_ALIGN VolumePush {
	mat4 clip_from_node;
	vec4 light_position_node; // xyz / w: the light's centre; w = 0: xyz is the direction towards it
	uint first_in_list;		  // index of the caster's first edge in the list
	uint padding0;
	uint padding1;
	uint padding2;
};
SHARED_SIZE(VolumePush, 96);

#include "shared/shared_end.h"
#endif
