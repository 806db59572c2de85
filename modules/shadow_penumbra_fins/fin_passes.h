#pragma once

#include "modules/shadow_penumbra_fins/fins_settings.h"
#include "modules/shadows/silhouette_lists.h"

namespace gnomon {

/// The textures of the fin passes. `color` and `penumbra_depth` are attachments. `layer_1` and
/// `layer_2` are inputs: the depth layers against which fragments of fins are tested. All are
/// texture arrays with one array layer per light view.
struct FinTargets {
	RGTexture color;		  // RG16_SFLOAT: R visibility 0..1; G 0.5: outer fin, 0: inner or none
	RGTexture penumbra_depth; // D32_SFLOAT, see penumbra_depth in penumbra_inc.glsl; 0 = no fin
	RGTexture layer_1;
	RGTexture layer_2; // null when it was not peeled
};

/// Returns the uniform constants with which the fin draws of one view project vertices and convert
/// depths. Lengths are in metres.
shader::FinsViewConstants compute_fins_view_constants(const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, const FinsSettings &p_settings);

/// Adds a pass that draws one view's fins into p_targets. Without casters or fins it only clears
/// the attachments. p_lists: the result of add_silhouette_passes, read only with
/// FinMethod::COMPUTE.
void add_fin_pass(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, const FinsSettings &p_settings, const SilhouetteCasters &p_casters,
		const SilhouetteLists &p_lists, const FinTargets &p_targets);

/// Returns the number of the casters' vertices whose normal is zero, because their faces' normals
/// cancel. Fins have no width there.
uint32_t count_zero_normals(const SilhouetteCasters &p_casters);

/// Returns the sign that makes normals, transformed by the cofactor matrix, point out of the solid:
/// -1 for mirrored instances or closed meshes that are inside out, but 1 for both at once; else 1.
float compute_normal_sign(const MeshTopology &p_topology, const InstanceSnapshot &p_instance);

/// Returns the number of vertices per silhouette edge: 6 for each half (outer, inner) whose width
/// is above 0, see FIN_CORNERS in fin_inc.glsl.
uint32_t get_vertices_per_edge(const FinsSettings &p_settings);

} // namespace gnomon
