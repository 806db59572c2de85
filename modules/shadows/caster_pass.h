#pragma once

#include "modules/shadows/light_view.h"
#include "modules/shadows/mesh_store.h"
#include "modules/shadows/shadow_technique.h"

#include "shadows/shadows_shared.h"

#include <vector>

namespace gnomon {

/// One caster as shadows/depth.vert draws it.
struct CasterDraw {
	const GpuMesh *mesh = nullptr;
	shader::DepthPush push;
};

/// Builds the draws of one view's casters, and uploads the meshes that are not on the GPU yet.
std::vector<CasterDraw> build_caster_draws(const ShadowTechnique::Inputs &p_inputs,
		const LightView &p_view, const CasterList &p_casters);

/// Describes a pipeline that draws casters through shadows/depth.vert: no face culling, the nearest
/// fragment wins (reversed depth), depth clamped at the near plane where the device supports it.
/// All pipelines built from it give a caster the same depth, bit for bit. The caller sets the name,
/// the fragment shader and the targets.
RasterPipelineDesc make_caster_pipeline_desc(const RenderingDevice &p_device);

/// Records the draws. The pipeline and its resources must be bound already.
void record_caster_draws(CommandList &r_commands, const std::vector<CasterDraw> &p_draws);

/// Adds a depth-only pass that draws a view's casters into one array layer of a D32_SFLOAT texture
/// and clears that layer first.
void add_depth_pass(RenderGraph &r_graph, const std::string &p_name,
		const ShadowTechnique::Inputs &p_inputs, const LightView &p_view,
		const CasterList &p_casters, RGTexture p_target, uint32_t p_layer);

/// Instance indices of the casters of all views in p_view_indices, each once, ascending.
std::vector<uint32_t> collect_casters(
		const ShadowTechnique::Inputs &p_inputs, const std::vector<uint32_t> &p_view_indices);

// For techniques without a shadow map, which still need to know which casters matter.

/// Builds views for ShadowTechnique::get_light_views that only serve to list casters.
std::vector<LightView> build_listing_views(const LightSnapshot &p_light, const LightScene &p_scene);
/// Skips all of the light's views in the plan and returns the instance indices of their casters,
/// ascending.
std::vector<uint32_t> list_casters(const ShadowTechnique::Inputs &p_inputs, TechniquePlan &r_plan);

} // namespace gnomon
