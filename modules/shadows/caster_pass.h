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

/// The casters of one view, uploaded where they were not.
std::vector<CasterDraw> build_caster_draws(const ShadowTechnique::Inputs &p_inputs,
		const LightView &p_view, const CasterList &p_casters);

/// A pipeline that draws casters through shadows/depth.vert: both sides, the nearest wins
/// (reversed depth), depth clamped at the near plane where the device can. Every pipeline made from
/// it gives a caster the same depth, bit for bit. To be completed: name, fragment shader, targets.
RasterPipelineDesc make_caster_pipeline_desc(const RenderingDevice &p_device);

/// Records the draws; the pipeline and its resources are bound.
void record_caster_draws(CommandList &r_commands, const std::vector<CasterDraw> &p_draws);

/// A pass that draws a view's casters, depth only, into one layer of a D32_SFLOAT texture, which is
/// cleared first.
void add_depth_pass(RenderGraph &r_graph, const std::string &p_name,
		const ShadowTechnique::Inputs &p_inputs, const LightView &p_view,
		const CasterList &p_casters, RGTexture p_target, uint32_t p_layer);

/// The casters of all views that are listed in p_view_indices, each once, ascending.
std::vector<uint32_t> collect_casters(
		const ShadowTechnique::Inputs &p_inputs, const std::vector<uint32_t> &p_view_indices);

// For techniques that draw nothing from the light, but have to know which casters matter.

/// Views for ShadowTechnique::get_light_views that only list casters.
std::vector<LightView> build_listing_views(const LightSnapshot &p_light, const LightScene &p_scene);
/// Skips all of the light's views, and returns their casters, ascending.
std::vector<uint32_t> list_casters(const ShadowTechnique::Inputs &p_inputs, TechniquePlan &r_plan);

} // namespace gnomon
