#pragma once

#include "modules/shadows/depth_map_technique.h"

namespace gnomon {

/// A shadow map filtered over a disc of one radius for all pixels, with taps that differ from pixel
/// to pixel, so that banding becomes noise. The outermost ring of taps decides whether the others
/// are needed: where it is all lit or all hidden, that is the result. Ignores the light's size.
class ShadowJitteredPcf : public DepthMapTechnique {
public:
	ShadowJitteredPcf() :
			DepthMapTechnique("shadow_jittered_pcf/resolve.comp", "jittered_pcf_map_size",
					CachedViews::FilterReach::ADJACENT_VIEWS) {}
	void get_light_properties(PropertyList &r_list) const override;
	void get_quality_settings(
			const LightSnapshot &p_light, std::vector<QualitySetting> &r_settings) const override;
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;

private:
	void filter(RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_empty_views,
			std::vector<PassBinding> p_bindings) override;

	OwnedBuffer offsets;
	uint32_t offset_ring_count = 0; // number of rings in `offsets`
};

} // namespace gnomon
