// The extensions of compute shaders that read texel buffers, or use common/subgroup_inc.glsl. An entry point includes it
// first, since extensions come before all code.
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
