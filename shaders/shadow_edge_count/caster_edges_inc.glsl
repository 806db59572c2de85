// The edges of the casters, for the passes that find those that may be silhouettes.
#ifndef CASTER_EDGES_INC_GLSL
#define CASTER_EDGES_INC_GLSL

#include "shadow_edge_count/casters_inc.glsl"

FETCHED_UVEC4S(FIND_BINDING_MESH_EDGES, mesh_edges_buffer); // of all meshes: CountMeshEdge

CountMeshEdge load_mesh_edge(CountCasterRecord p_caster, uint p_index) {
	const uvec4 words = FETCH_UVEC4(mesh_edges_buffer, p_caster.first_mesh_edge + p_index);
	return CountMeshEdge(words.x, words.y, words.z, words.w);
}

#endif
