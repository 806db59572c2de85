#pragma once

#include "modules/shadow_penumbra_fins/fins_maps.h"
#include "modules/shadows/cached_views.h"

namespace gnomon {

/// Approximate soft shadows of Sun, Lü, Liu, Wu 2010: three depth layers from the light, and fins
/// that are extruded from each silhouette edge along the vertex normals, r outwards and t inwards,
/// and rasterised into a penumbra map that each receiver looks up. Halves::OUTER selects the
/// method with which the paper compares its own (Lü et al. 2009): one depth layer and outer fins
/// only.
///
/// Spaces: fins are built in the light view's space (metres, float32); depths are compared as the
/// view stores them (reversed, float32); for each texel, the receiver's depth is that of its
/// tangent plane there.
class ShadowPenumbraFins : public ShadowTechnique {
public:
	enum class Halves { OUTER, OUTER_AND_INNER };
	explicit ShadowPenumbraFins(Halves p_halves) :
			has_inner_half(p_halves == Halves::OUTER_AND_INNER),
			id(has_inner_half ? "penumbra_fins" : "outer_fins") {}

	ShadowLimits get_limits(const PropertyValues &p_properties) const override;
	void get_light_properties(PropertyList &r_list) const override;
	void get_settings(PropertyList &r_list) const override;
	void get_quality_settings(
			const LightSnapshot &p_light, std::vector<QualitySetting> &r_settings) const override;
	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	bool queries_receivers_only() const override { return true; }
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	void before_light_view(
			RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) override;
	void at_light_view(
			RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	void get_debug_views(std::vector<DebugView> &r_views) const override;
	std::vector<std::string> get_shader_files() const override;

private:
	void plan_views(const Inputs &p_inputs, TechniquePlan &r_plan);
	void plan_fins(const Inputs &p_inputs, TechniquePlan &r_plan);
	/// Returns the stored depths that debug views of layers show as black and as white: those at
	/// the distance of the farthest caster (plus a fin's width) of the first view that is not
	/// empty, and at a third of it; orthographic: 0 and 1.
	glm::vec2 compute_layer_range(const Inputs &p_inputs) const;
	/// Adds a pass of p_shader ("resolve", "hard" or "cases"). Returns its output texture, with one
	/// texel per pixel of the image.
	RGTexture add_resolve_pass(
			RenderGraph &r_graph, const Inputs &p_inputs, const std::string &p_shader);

	const bool has_inner_half;
	const std::string id;
	FinsMaps maps;
	OwnedSampler sampler;		 // linear
	FinsSettings drawn_settings; // with which the cached maps were drawn
	CachedViews views;

	// State of the current frame.
	FinsSettings settings;
	bool draws_fins = false;
	SilhouetteCasters fin_casters;
	SilhouetteLists edge_lists;
	RGBuffer layer_texels;						   // r_texels of add_layer_passes
	RGTexture cases;							   // the case of each pixel, see cases.comp
	glm::vec2 layer_range = glm::vec2(0.0f, 1.0f); // depths that the debug views show
};

} // namespace gnomon
