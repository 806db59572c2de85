// What a receiver reads of the light's buffers: as texel buffers, which software drivers read a fifth
// faster than storage buffers.
#ifndef COUNT_BUFFERS_INC_GLSL
#define COUNT_BUFFERS_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

layout(set = 0, binding = COUNT_BINDING_RECORDS) uniform textureBuffer records_buffer;

CountEdgeRecord load_count_record(uint p_index) {
	const int first = int(4u * p_index);
	return CountEdgeRecord(texelFetch(records_buffer, first), texelFetch(records_buffer, first + 1),
			texelFetch(records_buffer, first + 2), texelFetch(records_buffer, first + 3));
}

#endif
