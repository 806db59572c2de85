#pragma once

#include "modules/rendering_device/rendering_device.h"
#include "modules/shadows/kept_views.h"

namespace gnomon {

/// Depth maps of one light, one texture layer per view, kept from frame to frame while neither a
/// view nor its casters change. A technique that looks receivers up in such maps forwards its
/// plan and at_light_view, and binds import() in its resolve.
class KeptDepthMap {
public:
	/// Decides which views are drawn and leaves the others out of the plan: those without casters,
	/// those without receivers, and those whose layer is still right. There must be a view, and all
	/// have one size.
	void plan(const ShadowTechnique::Inputs &p_inputs, KeptViews::Reads p_reads,
			TechniquePlan &r_plan);
	/// Draws one view; only for views that were not left out.
	void add_view(
			RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index);
	/// This frame's handle: D32_SFLOAT, reversed. Not when is_all_empty().
	RGTexture import(RenderGraph &r_graph);
	/// For debug views; empty before import().
	RGTexture get_imported() const { return frame_map; }

	/// Bit i: view i has no casters or no receivers; its layer must not be read.
	uint32_t get_empty_views() const { return views.get_empty_views(); }
	/// No view has casters and receivers: everything is lit.
	bool is_all_empty() const { return views.is_all_empty(); }

private:
	OwnedTexture map;
	TextureDesc map_desc;
	KeptViews views;
	bool has_content = false; // of the map, before this frame
	RGTexture frame_map;
};

} // namespace gnomon
