#ifndef SILHOUETTE_SHARED_H
#define SILHOUETTE_SHARED_H
#include "shared/shared_begin.h"

// Constants of find_edges.comp and list_edges.comp, which list silhouette edges. An edge word has
// one bit for each of 32 edges. For each run of 64 words the number of silhouettes is stored.
#define SILHOUETTE_EDGES_PER_WORD 32
#define SILHOUETTE_WORDS_PER_RUN 64

#define SILHOUETTE_BINDING_POSITIONS 0
#define SILHOUETTE_BINDING_EDGES 1
#define SILHOUETTE_BINDING_WORDS 2
#define SILHOUETTE_BINDING_RUNS 3
#define SILHOUETTE_BINDING_LIST 4
#define SILHOUETTE_BINDING_DRAWS 5

/// Push constants of both shaders: one caster.
struct SHARED_ALIGN SilhouettePush {
	vec4 light_position_node; // xyz / w: the light's centre; w = 0: the direction towards it
	uint edge_count;
	uint first_word;	// index of the caster's first edge word
	uint first_run;		// index of its first run
	uint first_in_list; // index of its first entry in the list of silhouette edges
	uint draw_index;	// index of its SilhouetteDraw
	uint vertices_per_edge;
	uint padding0;
	uint padding1;
};
SHARED_SIZE(SilhouettePush, 48);

/// Same layout as VkDrawIndirectCommand.
struct SHARED_ALIGN SilhouetteDraw {
	uint vertex_count;
	uint instance_count;
	uint first_vertex;
	uint first_instance;
};
SHARED_SIZE(SilhouetteDraw, 16);

#include "shared/shared_end.h"
#endif
