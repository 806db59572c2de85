#pragma once

#include "modules/shadow_penumbra_fins/fins_settings.h"
#include "modules/shadows/silhouette_lists.h"

namespace gnomon {

/// What the fins of one light view are drawn into, and what hides them. Texture arrays with one
/// texture layer per light view.
struct FinTargets {
	RGTexture color;		  // RG16_SFLOAT: transition, class (0.5 outer, 0 inner or nothing)
	RGTexture penumbra_depth; // D32_SFLOAT, see penumbra_depth in penumbra_inc.glsl; 0 = no fin
	RGTexture layer_1;
	RGTexture layer_2; // empty: not peeled
};

/// How the draws of one view read and write depths. Lengths in metres.
shader::FinsViewConstants compute_fins_view_constants(const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, const FinsSettings &p_settings);

/// A pass that draws one view's fins. p_lists: with FinMethod::COMPUTE, from add_silhouette_passes.
void add_fin_pass(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, const FinsSettings &p_settings, const SilhouetteCasters &p_casters,
		const SilhouetteLists &p_lists, const FinTargets &p_targets);

/// Vertices of the casters where fins end in the edge: the normals of their faces cancel.
uint32_t count_zero_normals(const SilhouetteCasters &p_casters);

/// -1 where normals that are transformed by cofactors point into the solid: in mirrored instances,
/// and in closed meshes that are modelled inside out (not in both).
float compute_normal_sign(const MeshTopology &p_topology, const InstanceSnapshot &p_instance);

/// 6 for each half that has a width, as fin_inc.glsl has it.
uint32_t get_vertices_per_edge(const FinsSettings &p_settings);

} // namespace gnomon
