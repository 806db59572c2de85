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
	/// Quality settings worth comparing, see ShadowTechnique; measured with the default technique.
	virtual void get_quality_settings(std::vector<QualitySetting> & /*r_settings*/) const {}
	/// False when the filter changes no mask of the scene, whatever its properties are.
	virtual bool may_change(const SceneSnapshot & /*p_scene*/, glm::uvec2 /*p_size_px*/) const {
		return true;
	}
	/// Returns false, and reports the reason in the plan, when the filter would not change the
	/// mask. p_properties: the filter's properties of the light, with defaults filled in, all in
	/// range.
	virtual bool plan(const ShadowTechnique::Inputs &p_inputs, const PropertyValues &p_properties,
			TechniquePlan &r_plan) = 0;
	/// Called when plan() returned true. Returns the new mask, of the same format and size.
	virtual RGTexture apply(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
			const PropertyValues &p_properties, RGTexture p_mask) = 0;
	virtual std::vector<std::string> get_shader_files() const = 0;
};

/// Description of a mask filter, which its module registers.
struct MaskFilterInfo {
	std::string id;
	std::string name;
	std::string source; // paper, book, section
	std::string color;	// "#rrggbb", unique: the filter's colour in all plots
	std::function<std::unique_ptr<MaskFilter>()> make;
	/// The exact form of what the filter approximates: the reference integrates it, so the filter
	/// does not run after the reference. Null: the filter also runs after the reference.
	std::shared_ptr<const SurfaceSpread> spread = nullptr;
};

/// All registered mask filters.
using MaskFilterRegistry = Registry<MaskFilterInfo>;

/// MaskFilterInfo::spread of the first filter that has one, for the reference; null: there is none.
/// Call on the main thread, or on the render thread while the main thread waits for the frame.
std::shared_ptr<const SurfaceSpread> find_surface_spread();
/// Hash of the ids of the registered filters, on which references and measured masks depend.
uint64_t compute_filter_hash();

} // namespace gnomon
