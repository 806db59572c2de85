#pragma once

#include "modules/renderer/shadow_technique.h"

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
	/// Light properties the filter reads; names begin with the filter's id.
	virtual void get_light_properties(PropertyList & /*r_list*/) const {}
	/// False, with the reason in the plan, when the mask would stay as it is.
	virtual bool plan(const ShadowTechnique::Inputs &p_inputs, TechniquePlan &r_plan) = 0;
	/// Called when plan() returned true. Returns the new mask, of the same kind.
	virtual RGTexture apply(
			RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs, RGTexture p_mask) = 0;
	virtual std::vector<std::string> get_shader_files() const = 0;
};

struct MaskFilterInfo {
	std::string id;
	std::string name;
	std::string source;
	std::function<std::unique_ptr<MaskFilter>()> make;
};

/// All mask filters there are. Modules add and remove; main thread only.
class MaskFilterRegistry {
public:
	static void add(MaskFilterInfo p_info);
	static void remove(std::string_view p_id);
	static const std::vector<MaskFilterInfo> &get_filters();
	static uint64_t get_revision();
};

} // namespace gnomon
