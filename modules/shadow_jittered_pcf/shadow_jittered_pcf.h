#pragma once

#include "modules/shadows/kept_depth_map.h"

namespace gnomon {

/// A shadow map filtered over a disc of one radius for all pixels, with taps that differ from pixel
/// to pixel, so that banding becomes noise. The outermost ring of taps decides whether the rest is
/// needed: where it is all lit or all hidden, its answer stands. Blind to the light's size.
class ShadowJitteredPcf : public ShadowTechnique {
public:
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
	OwnedBuffer offsets;
	uint32_t offset_ring_count = 0; // of what `offsets` holds
};

} // namespace gnomon
