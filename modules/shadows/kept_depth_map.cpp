#include "modules/shadows/kept_depth_map.h"

#include "modules/core/error.h"
#include "modules/shadows/caster_pass.h"

namespace gnomon {

void KeptDepthMap::plan(
		const ShadowTechnique::Inputs &p_inputs, KeptViews::Reads p_reads, TechniquePlan &r_plan) {
	const TextureDesc desc = { "depth map of " + p_inputs.light.name, Format::D32_SFLOAT,
		p_inputs.views[0].size_px, static_cast<uint32_t>(p_inputs.views.size()),
		TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED, true };
	frame_map = {};
	views.begin(p_inputs, p_reads);
	if (views.may_forget()) {
		map.reset(); // nobody reads it
	}
	has_content = bool(map) && map_desc == desc;
	views.plan(p_inputs, r_plan, has_content);
	if (!has_content && !views.is_all_empty()) {
		map.reset(); // before the new one takes memory
		map = OwnedTexture(p_inputs.device, p_inputs.device.create_texture(desc));
		map_desc = desc;
	}
}

RGTexture KeptDepthMap::import(RenderGraph &r_graph) {
	if (!frame_map) {
		frame_map = r_graph.import_texture(map.get(),
				has_content ? RenderGraph::ImportedContent::KEPT
							: RenderGraph::ImportedContent::NONE);
	}
	return frame_map;
}

void KeptDepthMap::add_view(
		RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index) {
	add_depth_pass(r_graph, text("depth view ", p_view_index), p_inputs,
			p_inputs.views[p_view_index], p_inputs.casters[p_view_index], import(r_graph),
			p_view_index);
	views.set_drawn(p_inputs, p_view_index);
}

} // namespace gnomon
