#ifndef RENDER_GRAPH_SHARED_H
#define RENDER_GRAPH_SHARED_H
#include "shared/shared_begin.h"

#define FILL_BINDING_WORDS 0
#define FILL_GROUP_SIZE 256

/// Push constants of fill.comp.
struct SHARED_ALIGN FillPush {
	uint value;
	uint word_count;
	uint padding0;
	uint padding1;
};
SHARED_SIZE(FillPush, 16);

#include "shared/shared_end.h"
#endif
