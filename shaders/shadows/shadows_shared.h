#ifndef SHADOWS_SHARED_H
#define SHADOWS_SHARED_H
#include "shared/shared_begin.h"

// Bindings of receivers.comp and normals_from_depth.comp.
#define SURFACE_BINDING_FRAME 0
#define SURFACE_BINDING_LIGHT 1
#define SURFACE_BINDING_DEPTH 2
#define SURFACE_BINDING_NORMAL 3
#define SURFACE_BINDING_RESULT 4
#define SURFACE_BINDING_TILES 5 // receivers.comp only
#define SURFACE_GROUP_SIZE 8

// Bindings of tint.comp.
#define TINT_BINDING_OPAQUE 0 // the mask of the opaque casters
#define TINT_BINDING_BOTH 1	  // the mask of the opaque casters and the group
#define TINT_BINDING_BEFORE 2 // the mask to be coloured, with earlier groups applied
#define TINT_BINDING_RESULT 3

// Bindings of hold_gray.comp and hold_color.comp.
#define HOLD_BINDING_MASK 0
#define HOLD_BINDING_RECEIVERS 1
#define HOLD_BINDING_RESULT 2
#define HOLD_BINDING_TILES 3

// Bindings of deform.comp and deform_tangents.comp. Inputs: positions and normals at rest, three
// floats per vertex (tangents: four), joint influences, displacements of the morph targets, and the
// pose.
#define DEFORM_BINDING_POSITIONS 0
#define DEFORM_BINDING_NORMALS 1
#define DEFORM_BINDING_INFLUENCES 2
#define DEFORM_BINDING_TARGETS 3
#define DEFORM_BINDING_POSE 4
#define DEFORM_BINDING_RESULT 5
#define DEFORM_BINDING_NORMAL_RESULT 6
// Bindings of deform_points.comp, deform_welded.comp and deform_normals.comp, which read deformed
// positions. SOURCES: what each vertex is computed from, that is, a point on a triangle, a vertex,
// or a range of faces.
#define MOVE_BINDING_POSITIONS 0
#define MOVE_BINDING_SOURCES 1
#define MOVE_BINDING_RESULT 2
#define MOVE_BINDING_TRIANGLES 3
#define DEFORM_GROUP_SIZE 64
// Bindings of vertex programs, see VertexProgram in modules/scene/vertex_program.h. POSITIONS: three floats per vertex, read
// and written; NORMALS: three, read; INPUTS: PROGRAM_INPUT_FLOATS per vertex; VALUES: words.
#define PROGRAM_BINDING_POSITIONS 0
#define PROGRAM_BINDING_NORMALS 1
#define PROGRAM_BINDING_INPUTS 2
#define PROGRAM_BINDING_VALUES 3
#define PROGRAM_BINDING_FIRST_TEXTURE 4
// Of a vertex: two UVs, the colour, the tangent.
#define PROGRAM_INPUT_FLOATS 12

/// Push constants of all deform shaders. All but vertex_count are 0 where a shader does not need
/// them.
struct SHARED_ALIGN DeformPush {
	uint vertex_count;
	uint influence_count; // per vertex; 0: no skin
	uint joint_count;	  // in the pose: three matrix rows each, followed by the morph weights
	uint target_count;	  // morph targets
};
SHARED_SIZE(DeformPush, 16);

/// A point on a triangle, see TrianglePoint in modules/scene/mesh.h.
struct SHARED_ALIGN DeformPoint {
	uvec4 corners; // xyz: vertex indices
	vec4 weights;  // xyz: barycentric weights
};
SHARED_SIZE(DeformPoint, 32);

/// Push constants of depth.vert.
struct SHARED_ALIGN DepthPush {
	mat4 clip_from_node;
};
SHARED_SIZE(DepthPush, 64);

/// Push constants of tint.comp.
struct SHARED_ALIGN TintPush {
	vec4 transmittance; // rgb
};
SHARED_SIZE(TintPush, 16);

/// Push constants of hold_gray.comp and hold_color.comp.
struct SHARED_ALIGN HoldPush {
	uint layer;				 // of the texture array
	float no_receiver_value; // the value of pixels without a receiver
	uint padding1;
	uint padding2;
};
SHARED_SIZE(HoldPush, 16);

#include "shared/shared_end.h"
#endif
