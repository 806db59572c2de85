#pragma once

#include "modules/shadows/shadow_technique.h"

namespace gnomon {

/// A minimal technique to copy: draws depth from the light and compares each receiver with one
/// texel (hard shadows). doc/add_a_technique.md explains it step by step.
class ShadowTemplate : public ShadowTechnique {
public:
	void get_light_properties(PropertyList &r_list) const override;
	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	bool queries_receivers_only() const override { return true; }
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	void at_light_view(
			RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	void get_debug_views(std::vector<DebugView> &r_views) const override;
	std::vector<std::string> get_shader_files() const override;

private:
	RGTexture map; // of this frame; one layer per view
};

} // namespace gnomon
