#pragma once

#include "modules/renderer/kept_views.h"
#include "modules/shadow_edge_count/block_passes.h"

#include <vector>

namespace gnomon {

/// Soft shadows by counting: the solids between a receiver and the light's centre, from a map of
/// all layers, plus the silhouette edges crossed on the way to each point of the light. No noise,
/// no bias to tune, and the map's size hardly matters. See doc/techniques/edge_count.md.
class ShadowEdgeCount : public ShadowTechnique {
public:
	void get_light_properties(PropertyList &r_list) const override;
	void get_quality_settings(
			const LightSnapshot &p_light, std::vector<QualitySetting> &r_settings) const override;
	void get_light_views(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	bool asks_receivers_alone() const override { return true; }
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	void at_light_view(
			RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	void get_debug_views(std::vector<DebugView> &r_views) const override;
	std::vector<std::string> get_shader_files() const override;

private:
	/// What a view's edges were found with.
	struct FoundView {
		LightView view;
		double disc_radius = -1;
		CountCasters casters;
	};

	/// Of the views that are drawn: whose edges are found anew, and whose are kept.
	void plan_edges(
			const Inputs &p_inputs, std::vector<CountCasters> &r_casters, TechniquePlan &r_plan);
	RGBuffer import_masks(RenderGraph &r_graph, const Inputs &p_inputs);

	CountBuffers buffers;
	KeptViews views;
	std::vector<FoundView> found;
	OwnedBuffer masks;
	uint32_t mask_turn_count = 0;
	double drawn_disc_radius = -1;
	uint32_t drawn_layer_count = 0;

	// This frame.
	CountSettings settings;
	uint32_t empty_views = 0;
	bool may_be_over = true;
	RGTexture debug_picture;
};

} // namespace gnomon
