#pragma once

#include "modules/receiver_scatter/dipole_spread.h"
#include "modules/shadows/mask_filter.h"

namespace gnomon {

/// Blurs a visibility mask on translucent receivers, because light spreads below their surfaces:
/// averages the mask around each pixel whose material has a scatter coefficient s above 0. Two
/// methods: the disc of Wang and Xiao 2015, whose radius is in pixels, and samples in metres that
/// follow the dipole of Jensen et al. 2001.
class ReceiverScatter : public MaskFilter {
public:
	void get_light_properties(PropertyList &r_list) const override;
	void get_quality_settings(std::vector<QualitySetting> &r_settings) const override;
	/// Returns true if the camera may see a translucent surface, for either of the methods.
	bool may_change(const SceneSnapshot &p_scene, glm::uvec2 p_size_px) const override;
	bool plan(const ShadowTechnique::Inputs &p_inputs, const PropertyValues &p_properties,
			TechniquePlan &r_plan) override;
	RGTexture apply(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
			const PropertyValues &p_properties, RGTexture p_mask) override;
	std::vector<std::string> get_shader_files() const override;

private:
	const DipoleSpread spread;
	std::vector<glm::vec2> sample_offsets; // several sets, in radii; see make_scatter_samples
	uint32_t samples_per_set = 0;		   // for which sample_offsets were made
	bool needs_average = true; // whether the light that plan() saw last needs the averaging pass
};

} // namespace gnomon
