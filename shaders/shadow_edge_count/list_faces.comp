#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "shadow_edge_count/light_faces_inc.glsl"
#include "shadow_edge_count/texel_rows_inc.glsl"

// Adds each face of a range, except those that may cut the light's disc (light_faces_inc.glsl), to the lists of the texels
// that it may cover in one view's map. This map is a grid of texels with one linked list each, not a depth map. The order
// of a list depends on scheduling, but not what receivers count. Nodes beyond the capacity are only counted, and
// retry_faces.comp prepares a further attempt with a map of half the size or less. One invocation per face; the whole
// work group processes the rows of large faces.
layout(local_size_x = FACE_LIST_GROUP_SIZE) in;
layout(std140, set = 0, binding = FACE_LIST_BINDING_LIGHT) restrict readonly buffer Light {
	CountLightConstants light;
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

const int LARGE_ROWS = 8; // faces that cover more rows are processed by the whole work group
shared uint large_count;
shared uint large_faces[FACE_LIST_GROUP_SIZE];

// The view's constants, which main() copies: see count_constants_inc.glsl.
CountViewConstants view;
uint node_capacity;
uint first_node;
uint first_head;

TexelRows find_rows(CountFaceRecord p_face, uint p_level) {
	return make_texel_rows(light, view, p_level, uintBitsToFloat(p_face.a_kind.xyz),
			uintBitsToFloat(p_face.b_first_distance.xyz), uintBitsToFloat(p_face.c_end_distance.xyz));
}

/// A row of a face's texels. Their nodes are allocated with one atomicAdd.
struct FaceRow {
	uint face_rows; // first word of the nodes, without the columns of cells
	vec2 range;		// of the face's x in texels
	int column;		// of the first texel
	uint head;		// of the first texel
	uint node;		// of the first texel
	uint count;
};

FaceRow allocate_row(uint p_face, TexelRows p_rows, int p_row) {
	const ivec2 columns = find_columns(p_rows, p_row);
	const uint rows = find_cells(p_rows.minimum.y, p_rows.maximum.y, p_row);
	FaceRow row;
	row.face_rows = p_face | rows << (EDGE_COUNT_NODE_CELLS_SHIFT + EDGE_COUNT_NODE_CELLS_PER_SIDE);
	row.range = vec2(p_rows.minimum.x, p_rows.maximum.x);
	row.column = columns.x;
	row.head = first_head + uint(p_row) * view.map_size_px.x + uint(columns.x);
	row.count = uint(max(columns.y - columns.x + 1, 0));
	row.node = atomicAdd(totals[EDGE_COUNT_TOTAL_NODES + push.view], row.count);
	return row;
}

/// Inserts the node of a row's texel p_index at the head of the texel's list, if the texel exists and the node fits.
void add_texel(FaceRow p_row, uint p_index) {
	const uint node = p_row.node + p_index;
	const bool has_room = p_index < p_row.count && node < node_capacity;
	const uint columns = find_cells(p_row.range.x, p_row.range.y, p_row.column + int(p_index));
	if (has_room) {
		nodes[first_node + node] = uvec2(p_row.face_rows | columns << EDGE_COUNT_NODE_CELLS_SHIFT,
				atomicExchange(heads[p_row.head + p_index], node + 1u));
	}
}

void add_small_face(uint p_face, TexelRows p_rows) {
	for (int y = p_rows.first_row; y <= p_rows.last_row; ++y) {
		const FaceRow row = allocate_row(p_face, p_rows, y);
		for (uint i = 0u; i < row.count; ++i) {
			add_texel(row, i);
		}
	}
}

/// The loop is unrolled by four, so that the latencies of four atomicExchange overlap: a large face covers thousands of
/// texels.
void add_row(FaceRow p_row) {
	for (uint i = 0u; i < p_row.count; i += 4u) {
		add_texel(p_row, i);
		add_texel(p_row, i + 1u);
		add_texel(p_row, i + 2u);
		add_texel(p_row, i + 3u);
	}
}

void main() {
	view = light.views[push.view];
	node_capacity = light.node_capacity;
	first_node = push.view * node_capacity;
	first_head = push.view * view.map_size_px.x * view.map_size_px.y;
	if (gl_LocalInvocationID.x == 0u) {
		large_count = 0u;
	}
	barrier();
	const uint level = totals[EDGE_COUNT_TOTAL_LEVELS + push.view];
	const uint item = find_work_item(uint(FACE_LIST_GROUP_SIZE));
	const bool is_valid = item < push.face_count;
	const uint face = push.first_face + (is_valid ? item : 0u);
	const CountFaceRecord record = load_face(face);
	if (is_valid && !is_cut_face(light, record)) {
		const TexelRows rows = find_rows(record, level);
		if (rows.last_row - rows.first_row >= LARGE_ROWS) {
			large_faces[atomicAdd(large_count, 1u)] = face;
		} else {
			add_small_face(face, rows);
		}
	}
	barrier();
	for (uint i = 0u; i < large_count; ++i) {
		const TexelRows rows = find_rows(load_face(large_faces[i]), level);
		for (int y = rows.first_row + int(gl_LocalInvocationID.x); y <= rows.last_row; y += FACE_LIST_GROUP_SIZE) {
			add_row(allocate_row(large_faces[i], rows, y));
		}
	}
}
