#pragma once

#include "modules/shadow_penumbra_fins/fins_settings.h"
#include "modules/shadows/silhouette_lists.h"

namespace gnomon {

/// The textures of the fin passes: `color` and `penumbra_depth` are attachments, layer_1 and
/// layer_2 are inputs, depth layers against which fragments of fins are tested. All are texture
/// arrays with one array layer per light view.
struct FinTargets {
	RGTexture color;		  // RG16_SFLOAT: R visibility 0..1, G 0.5 outer fin, 0 inner or none
	RGTexture penumbra_depth; // D32_SFLOAT, see penumbra_depth in penumbra_inc.glsl; 0 = no fin
	RGTexture layer_1;
	RGTexture layer_2; // empty when it was not peeled
};

/// Constants by which the draws of one view read and write depths; lengths in metres.
shader::FinsViewConstants compute_fins_view_constants(const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, const FinsSettings &p_settings);

/// Adds a pass that draws one view's fins. p_lists: from add_silhouette_passes; read only with
/// FinMethod::COMPUTE.
void add_fin_pass(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, const FinsSettings &p_settings, const SilhouetteCasters &p_casters,
		const SilhouetteLists &p_lists, const FinTargets &p_targets);

/// Number of the casters' vertices whose normal is zero, because their faces' normals cancel: fins
/// have no width there.
uint32_t count_zero_normals(const SilhouetteCasters &p_casters);

/// -1 when normals that are transformed by the cofactor matrix point into the solid: for mirrored
/// instances or closed meshes that are inside out, but not for both at once; else 1.
float compute_normal_sign(const MeshTopology &p_topology, const InstanceSnapshot &p_instance);

/// Vertices per silhouette edge: 6 for each half with a width above 0, see fin_inc.glsl.
uint32_t get_vertices_per_edge(const FinsSettings &p_settings);

} // namespace gnomon
