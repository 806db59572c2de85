#pragma once

#include "modules/receiver_scatter/dipole_spread.h"
#include "modules/shadows/mask_filter.h"

namespace gnomon {

/// Spreads a mask over translucent receivers, as light spreads below their surfaces: the mean of
/// the mask about each pixel, for materials with s > 0. Two methods: the source's disc in pixels
/// (Wang, Xiao 2015), and one in metres whose samples follow the dipole of Jensen et al. 2001.
class ReceiverScatter : public MaskFilter {
public:
	void get_light_properties(PropertyList &r_list) const override;
	void get_quality_settings(std::vector<QualitySetting> &r_settings) const override;
	/// Is there a translucent surface that the camera may see, of whichever method?
	bool may_change(const SceneSnapshot &p_scene, glm::uvec2 p_size_px) const override;
	bool plan(const ShadowTechnique::Inputs &p_inputs, const PropertyValues &p_properties,
			TechniquePlan &r_plan) override;
	RGTexture apply(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
			const PropertyValues &p_properties, RGTexture p_mask) override;
	std::vector<std::string> get_shader_files() const override;

private:
	const DipoleSpread spread;
	std::vector<glm::vec2> points; // for points_count samples, see make_scatter_samples
	uint32_t points_count = 0;
	bool may_average = true; // of the light that is planned
};

} // namespace gnomon
