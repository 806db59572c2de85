#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
// As resolve_unfinished.comp, with 256 points of the light: four sets of 64.
#define COUNT_SAMPLE_SET_COUNT 4
#include "shadow_edge_count/count_rounds_inc.glsl"
