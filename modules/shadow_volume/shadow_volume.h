#pragma once

#include "modules/shadow_volume/cached_edges.h"
#include "modules/shadow_volume/caster_culling.h"
#include "modules/shadow_volume/volume_casters.h"

namespace gnomon {

/// Pixel-exact hard shadows: stencil shadow volumes, extruded from each caster's silhouette away
/// from the light's centre to infinity (GPU Gems 3, chapter 11; DOOM 3). A pixel is in shadow when
/// its view ray does not leave as many volumes as it enters. They are counted in front of the
/// receiver (z-pass), or behind it where the camera may be inside a shadow volume (z-fail, with
/// caps).
///
/// Spaces: silhouettes in node space, float32 (on the CPU in double); volumes in the camera's clip
/// space; depths reversed, float32, compared with the receiver moved off its surface (by about
/// its offset, see receivers.frag).
class ShadowVolume : public ShadowTechnique {
public:
	enum class Silhouettes { GPU, CPU };
	explicit ShadowVolume(Silhouettes p_silhouettes) :
			is_on_cpu(p_silhouettes == Silhouettes::CPU),
			id(is_on_cpu ? "shadow_volume_cpu" : "shadow_volume") {}

	void get_light_properties(PropertyList &r_list) const override;
	void get_settings(PropertyList &r_list) const override;
	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	void get_debug_views(std::vector<DebugView> &r_views) const override;
	std::vector<std::string> get_shader_files() const override;

private:
	const bool is_on_cpu;
	const std::string id;

	CasterCulling culling;
	CachedEdges edges;

	// State of the current frame.
	VolumeSettings settings;
	VolumeCasters casters;
};

} // namespace gnomon
