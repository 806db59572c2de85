#pragma once

#include "modules/shadows/depth_map_technique.h"

namespace gnomon {

/// Percentage-closer soft shadows (Fernando 2005), as games use them: the mean depth of what is
/// between receiver and light, from N taps of a depth map, gives the penumbra's width, and N more
/// taps over that width the visibility. One depth map, so that what one caster hides from the light
/// is unknown; noise where N is small for the width.
class ShadowPcss : public DepthMapTechnique {
public:
	ShadowPcss() :
			DepthMapTechnique("shadow_pcss/resolve.comp", "pcss_map_size",
					CachedViews::Reads::ACROSS_VIEWS) {}
	ShadowLimits get_limits(const PropertyValues &p_properties) const override;
	void get_light_properties(PropertyList &r_list) const override;
	void get_quality_settings(
			const LightSnapshot &p_light, std::vector<QualitySetting> &r_settings) const override;

private:
	void filter(RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_empty_views,
			std::vector<PassBinding> p_bindings) override;
};

} // namespace gnomon
