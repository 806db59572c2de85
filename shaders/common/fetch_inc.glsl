// Buffers that are read often, as arrays of uint, uvec2, uvec4 or vec4. They are texel buffers: llvmpipe gathers a word
// of a texel buffer for all invocations at once, but within loops and branches it loads from storage buffers and shared
// memory one invocation after the other. The variant VARIANT_STORAGE, for devices that cannot store into texel buffers,
// uses storage buffers.
#ifndef FETCH_INC_GLSL
#define FETCH_INC_GLSL

#ifdef VARIANT_STORAGE
#define FETCHED_ITEMS(p_binding, p_item, p_name) \
	layout(std430, set = 0, binding = p_binding) readonly buffer p_name##_block { \
		p_item p_name[]; \
	}
#define FETCHED_UINTS(p_binding, p_name) FETCHED_ITEMS(p_binding, uint, p_name)
#define FETCHED_UVEC2S(p_binding, p_name) FETCHED_ITEMS(p_binding, uvec2, p_name)
#define FETCHED_UVEC4S(p_binding, p_name) FETCHED_ITEMS(p_binding, uvec4, p_name)
#define FETCHED_VEC4S(p_binding, p_name) FETCHED_ITEMS(p_binding, vec4, p_name)
#define FETCH_UINT(p_name, p_index) p_name[p_index]
#define FETCH_UVEC2(p_name, p_index) p_name[p_index]
#define FETCH_UVEC4(p_name, p_index) p_name[p_index]
#define FETCH_VEC4(p_name, p_index) p_name[p_index]
#else
#define FETCHED_UINTS(p_binding, p_name) layout(set = 0, binding = p_binding) uniform utextureBuffer p_name
#define FETCHED_UVEC2S(p_binding, p_name) layout(set = 0, binding = p_binding) uniform utextureBuffer p_name
#define FETCHED_UVEC4S(p_binding, p_name) layout(set = 0, binding = p_binding) uniform utextureBuffer p_name
#define FETCHED_VEC4S(p_binding, p_name) layout(set = 0, binding = p_binding) uniform textureBuffer p_name
#define FETCH_UINT(p_name, p_index) texelFetch(p_name, int(p_index)).r
#define FETCH_UVEC2(p_name, p_index) texelFetch(p_name, int(p_index)).rg
#define FETCH_UVEC4(p_name, p_index) texelFetch(p_name, int(p_index))
#define FETCH_VEC4(p_name, p_index) texelFetch(p_name, int(p_index))
#endif

#endif
