#pragma once

#include "modules/shadows/kept_depth_map.h"

namespace gnomon {

/// Percentage-closer soft shadows (Fernando 2005), as games use them: the mean depth of what lies
/// between receiver and light, from N taps of a depth map, gives the penumbra's width, and N more
/// taps over that width the visibility. One depth map, so that what one caster hides from the light
/// is unknown; noise where N is small for the width.
class ShadowPcss : public ShadowTechnique {
public:
	ShadowLimits get_limits(const PropertyValues &p_properties) const override;
	void get_light_properties(PropertyList &r_list) const override;
	void get_quality_settings(
			const LightSnapshot &p_light, std::vector<QualitySetting> &r_settings) const override;
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
