#pragma once

#include "modules/shadows/kept_depth_map.h"

namespace gnomon {

/// Depth seen from the light's centre, compared per pixel: hard, or the mean over n x n texels.
/// Blind to the light's size. Receivers are compared with their own plane at the texel's centre, so
/// that no depth bias has to be tuned. A map is kept while neither its view nor its casters change.
class ShadowMap : public ShadowTechnique {
public:
	void get_light_properties(PropertyList &r_list) const override;
	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	bool asks_receivers_alone() const override { return true; }
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	void at_light_view(
			RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	void get_debug_views(std::vector<DebugView> &r_views) const override;
	std::vector<std::string> get_shader_files() const override;

private:
	KeptDepthMap maps;
};

} // namespace gnomon
