#pragma once

#include "modules/render_graph/compute_pass.h"
#include "modules/rendering_device/rendering_device.h"
#include "modules/shadows/cached_views.h"

namespace gnomon {

/// Base of techniques that look each receiver up in depth maps of the light's views. They differ
/// only in the filter: what their shader does with the maps, and its properties. The maps are the
/// array layers of one texture (D32_SFLOAT, reversed depth), cached while neither a view nor its
/// casters change. CachedViews decides which views are skipped.
class DepthMapTechnique : public ShadowTechnique {
public:
	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	bool queries_receivers_only() const override { return true; }
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	void at_light_view(
			RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	void get_debug_views(std::vector<DebugView> &r_views) const override;
	std::vector<std::string> get_shader_files() const override { return { shader }; }

protected:
	/// p_shader: the filter's entry point, a path under shaders/. p_size_property: name of the
	/// light property for the map size, see add_size_property. p_filter_reach: whether the filter
	/// samples adjacent views too.
	DepthMapTechnique(std::string p_shader, std::string p_size_property,
			CachedViews::FilterReach p_filter_reach) :
			shader(std::move(p_shader)),
			size_property(std::move(p_size_property)), filter_reach(p_filter_reach) {}

	/// Adds the property for the width and height of a map in pixels, 16 to 8192.
	void add_size_property(PropertyList &r_list, const std::string &p_group) const;
	/// Width in texels of the border that the filter samples around the view's content.
	virtual uint32_t get_border_px(const PropertyValues & /*p_properties*/) const { return 1; }
	/// Records the filter's pass, with p_bindings (those of map_resolve_shared.h, the map and the
	/// mask) plus its own. Bit i of p_empty_views: view i was not drawn and must not be read.
	virtual void filter(RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_empty_views,
			std::vector<PassBinding> p_bindings) = 0;
	/// True when all views are empty (CachedViews): filter() is not called, everything is lit.
	bool is_all_empty() const { return views.is_all_empty(); }

	const std::string shader;

private:
	RGTexture import(RenderGraph &r_graph);

	std::string size_property;
	CachedViews::FilterReach filter_reach;
	OwnedTexture map;
	TextureDesc map_desc;
	CachedViews views;
	bool has_content = false; // the map holds content of earlier frames
	RGTexture frame_map;	  // this frame's handle; empty when no view is read
};

} // namespace gnomon
