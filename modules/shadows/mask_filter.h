#pragma once

#include "modules/shadows/registry.h"
#include "modules/shadows/shadow_technique.h"
#include "modules/shadows/surface_spread.h"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon {

/// Changes a visibility mask between a technique's resolve and the lighting, for example where
/// receivers are translucent. Every filter runs after every technique, in the registry's order.
class MaskFilter {
public:
	virtual ~MaskFilter() = default;
	/// Properties this filter adds to every light; names begin with the filter's id. Called on any
	/// instance, at any time; always the same list.
	virtual void get_light_properties(PropertyList & /*r_list*/) const {}
	/// Settings worth comparing, as ShadowTechnique's; measured behind the default technique.
	virtual void get_quality_settings(std::vector<QualitySetting> & /*r_settings*/) const {}
	/// False when it changes no mask of the scene, whatever its properties are.
	virtual bool may_change(const SceneSnapshot & /*p_scene*/, glm::uvec2 /*p_size_px*/) const {
		return true;
	}
	/// False, with the reason in the plan, when the mask would stay as it is. p_properties: the
	/// filter's own of the light, with defaults filled in and every value in range.
	virtual bool plan(const ShadowTechnique::Inputs &p_inputs, const PropertyValues &p_properties,
			TechniquePlan &r_plan) = 0;
	/// Called when plan() returned true. Returns the new mask, of the same format and size.
	virtual RGTexture apply(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
			const PropertyValues &p_properties, RGTexture p_mask) = 0;
	virtual std::vector<std::string> get_shader_files() const = 0;
};

struct MaskFilterInfo {
	std::string id;
	std::string name;
	std::string source;
	std::string color; // "#rrggbb", its own: it is drawn so in every plot
	std::function<std::unique_ptr<MaskFilter>()> make;
	/// What the filter approximates. A reference integrates it, and the filter does not run then.
	/// Null: it runs after the reference too.
	std::shared_ptr<const SurfaceSpread> spread = nullptr;
};

/// All mask filters there are.
using MaskFilterRegistry = Registry<MaskFilterInfo>;

/// What the first filter approximates that approximates something; null: there is none. A reference
/// integrates it. Main thread, or the render thread while the main thread waits for the frame.
std::shared_ptr<const SurfaceSpread> find_surface_spread();
/// Changes with what filters there are: part of what a reference, or a measured mask, depends on.
uint64_t compute_filter_hash();

} // namespace gnomon
