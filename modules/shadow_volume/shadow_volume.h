#pragma once

#include "modules/shadow_volume/cached_edges.h"
#include "modules/shadow_volume/caster_culling.h"
#include "modules/shadow_volume/volume_casters.h"

namespace gnomon {

/// Hard shadows that are exact in every pixel: the space that each caster hides from the light's
/// centre is drawn into a stencil, as polygons from its silhouette to infinity (GPU Gems 3, chapter
/// 11; DOOM 3). A pixel whose count of entered less left volumes is not 0 is hidden. Counted before
/// the receiver (z-pass), or, where the camera may be in a volume, behind it (z-fail, with caps).
///
/// Spaces: silhouettes in node space, float32 (on the CPU in double); volumes in the camera's clip
/// space; depths reversed, float32, compared with the receiver moved off its surface by 5e-5 S.
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

	// This frame.
	VolumeSettings settings;
	VolumeCasters casters;
};

} // namespace gnomon
