#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "render_graph/render_graph_shared.h"

// Sets all words of a buffer to one value.
layout(local_size_x = FILL_GROUP_SIZE) in;
layout(std430, set = 0, binding = FILL_BINDING_WORDS) writeonly buffer Words {
	uint words[];
};
layout(push_constant) uniform Push {
	FillPush push;
};

void main() {
	const uint word = find_work_item(uint(FILL_GROUP_SIZE));
	if (word < push.word_count) {
		words[word] = push.value;
	}
}
