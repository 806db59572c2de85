#pragma once

#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// The mean of N hard shadow maps from N points of the light, as a brute-force baseline. Converges
/// to the exact mask as N and the map size grow (for a spot light only nearly, because its points
/// are on one disc for all receivers). Costs N times as much as a hard shadow map, every frame.
class Views : public ShadowTechnique {
public:
	void get_light_properties(PropertyList &r_list) const override;
	void get_quality_settings(
			const LightSnapshot &p_light, std::vector<QualitySetting> &r_settings) const override;
	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	bool queries_receivers_only() const override { return true; }
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	std::vector<std::string> get_shader_files() const override;

private:
	uint32_t views_per_point = 1;
	std::vector<bool> is_empty; // per view, this frame
	bool is_all_empty = false;
};

} // namespace gnomon
