#ifndef SILHOUETTE_SHARED_H
#define SILHOUETTE_SHARED_H
#include "shared/shared_begin.h"

// Lists of silhouette edges: find_edges.comp and list_edges.comp of shadows. An edge word holds
// one bit for each of 32 edges; a block counts the silhouettes of 64 words.
#define SILHOUETTE_EDGES_PER_WORD 32
#define SILHOUETTE_WORDS_PER_BLOCK 64

#define SILHOUETTE_BINDING_POSITIONS 0
#define SILHOUETTE_BINDING_EDGES 1
#define SILHOUETTE_BINDING_WORDS 2
#define SILHOUETTE_BINDING_BLOCKS 3
#define SILHOUETTE_BINDING_LIST 4
#define SILHOUETTE_BINDING_DRAWS 5

/// Push constants: one caster.
struct SHARED_ALIGN SilhouettePush {
	vec4 light_node; // xyz / w: the light's centre; w = 0: the direction towards it
	uint edge_count;
	uint first_word;
	uint first_block;
	uint first_in_list;
	uint draw_index;
	uint vertices_per_edge;
	uint padding0;
	uint padding1;
};
SHARED_SIZE(SilhouettePush, 48);

/// VkDrawIndirectCommand.
struct SHARED_ALIGN SilhouetteDraw {
	uint vertex_count;
	uint instance_count;
	uint first_vertex;
	uint first_instance;
};
SHARED_SIZE(SilhouetteDraw, 16);

#include "shared/shared_end.h"
#endif
