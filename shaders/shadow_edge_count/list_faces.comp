#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/cut_faces_inc.glsl"
#include "shadow_edge_count/texel_rows_inc.glsl"

// Lists the light's faces in the texels of one view's map that they may cover, each list linked, in no order:
// what is counted does not depend on it. Nodes beyond the capacity are only counted: then a further attempt
// with larger texels follows. One invocation per face; large faces are shared out among all of the group.
layout(local_size_x = FACE_LIST_GROUP_SIZE) in;
layout(std140, set = 0, binding = FACE_LIST_BINDING_LIGHT) restrict readonly buffer Light {
	CountLightConstants light;
};
layout(std430, set = 0, binding = FACE_LIST_BINDING_FACES) readonly buffer Faces {
	CountFaceRecord faces[];
};
layout(std430, set = 0, binding = FACE_LIST_BINDING_HEADS) buffer Heads {
	uint heads[];
};
layout(std430, set = 0, binding = FACE_LIST_BINDING_NODES) writeonly buffer Nodes {
	uvec2 nodes[];
};
layout(std430, set = 0, binding = FACE_LIST_BINDING_TOTALS) buffer Totals {
	uint totals[];
};
layout(push_constant) uniform Push {
	CountFaceListPush push;
};

const int LARGE_ROWS = 8; // a face that covers more is shared out
shared uint large_count;
shared uint large_faces[FACE_LIST_GROUP_SIZE];

TexelRows find_rows(uint p_face, uint p_level) {
	return make_texel_rows(light, light.views[push.view], p_level, uintBitsToFloat(faces[p_face].a_kind.xyz),
			uintBitsToFloat(faces[p_face].b.xyz), uintBitsToFloat(faces[p_face].c.xyz));
}

void add_texel(uint p_face, ivec2 p_texel) {
	const uvec2 size_px = light.views[push.view].map_size_px;
	const uint index = (push.view * size_px.y + uint(p_texel.y)) * size_px.x + uint(p_texel.x);
	const uint node = atomicAdd(totals[EDGE_COUNT_TOTAL_NODES + push.view], 1u);
	if (node < light.node_capacity) {
		nodes[push.view * light.node_capacity + node] =
				uvec2(p_face, atomicExchange(heads[index], node + 1u));
	}
}

void add_rows(uint p_face, TexelRows p_rows, int p_first, int p_step) {
	for (int y = p_first; y <= p_rows.last_row; y += p_step) {
		const ivec2 columns = find_columns(p_rows, y);
		for (int x = columns.x; x <= columns.y; ++x) {
			add_texel(p_face, ivec2(x, y));
		}
	}
}

void main() {
	if (gl_LocalInvocationID.x == 0u) {
		large_count = 0u;
	}
	barrier();
	const uint level = totals[EDGE_COUNT_TOTAL_LEVELS + push.view];
	const uint face = gl_GlobalInvocationID.x;
	if (face < light.face_count && !is_cut_face(light, faces[face])) {
		const TexelRows rows = find_rows(face, level);
		if (rows.last_row - rows.first_row >= LARGE_ROWS) {
			large_faces[atomicAdd(large_count, 1u)] = face;
		} else {
			add_rows(face, rows, rows.first_row, 1);
		}
	}
	barrier();
	for (uint i = 0u; i < large_count; ++i) {
		const TexelRows rows = find_rows(large_faces[i], level);
		add_rows(large_faces[i], rows, rows.first_row + int(gl_LocalInvocationID.x), FACE_LIST_GROUP_SIZE);
	}
}
