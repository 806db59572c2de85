#pragma once

#include "modules/shadows/depth_map_technique.h"

namespace gnomon {

/// Percentage-closer soft shadows (Fernando 2005), as used in games: the mean blocker depth, from N
/// taps of a depth map, gives the penumbra width, and N more taps over that width give the
/// visibility. A depth map has only the nearest surface, so blockers behind others are missed. The
/// result is noisy when N is small for the width.
class ShadowPcss : public DepthMapTechnique {
public:
	ShadowPcss() :
			DepthMapTechnique("shadow_pcss/resolve.comp", "pcss_map_size",
					CachedViews::FilterReach::ADJACENT_VIEWS) {}
	ShadowLimits get_limits(const PropertyValues &p_properties) const override;
	void get_light_properties(PropertyList &r_list) const override;
	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	void get_quality_settings(
			const LightSnapshot &p_light, std::vector<QualitySetting> &r_settings) const override;

private:
	void filter(RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_empty_views,
			std::vector<PassBinding> p_bindings) override;
};

} // namespace gnomon
