#pragma once

#include "modules/shadows/depth_map_technique.h"

namespace gnomon {

/// Shadow map from the light's centre, compared per pixel: hard, or percentage-closer filtered over
/// n x n texels. Ignores the light's size. The comparison uses the receiver's plane at the texel's
/// centre, so that no depth bias has to be tuned. A map is cached while neither its view nor its
/// casters change.
class ShadowMap : public DepthMapTechnique {
public:
	ShadowMap() :
			DepthMapTechnique("shadow_map/resolve.comp", "shadow_map_size",
					CachedViews::FilterReach::SINGLE_VIEW) {}
	void get_light_properties(PropertyList &r_list) const override;

private:
	uint32_t get_border_px(const PropertyValues &p_properties) const override;
	void filter(RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_empty_views,
			std::vector<PassBinding> p_bindings) override;
};

} // namespace gnomon
