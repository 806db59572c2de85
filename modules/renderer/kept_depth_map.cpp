#include "modules/renderer/kept_depth_map.h"

#include "modules/core/error.h"
#include "modules/renderer/caster_pass.h"

namespace gnomon {

void KeptDepthMap::plan(const ShadowTechnique::Inputs &p_inputs, TechniquePlan &r_plan) {
	const uint32_t view_count = static_cast<uint32_t>(p_inputs.views.size());
	GNOMON_ASSERT(view_count > 0 && view_count <= 32, view_count, " light views");
	const TextureDesc desc = { "depth map of " + p_inputs.light.name, Format::D32_SFLOAT,
		p_inputs.views[0].size_px, view_count,
		TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED };
	frame_map = {};
	empty_views = 0;
	has_content = bool(map) && map_desc == desc;
	if (!has_content) {
		drawn_hashes.assign(view_count, 0);
	}
	for (uint32_t index = 0; index < view_count; ++index) {
		const CasterList &casters = p_inputs.casters[index];
		if (p_inputs.may_leave_out && casters.instances.empty()) {
			empty_views |= 1u << index;
			drawn_hashes[index] = 0;
			r_plan.leave_out_light_view(index, "no casters");
		} else if (p_inputs.may_leave_out && p_inputs.may_keep &&
				drawn_hashes[index] == casters.content_hash) {
			r_plan.leave_out_light_view(index, "kept: neither the light nor a caster moved");
		}
	}
	is_empty = empty_views == ~0u >> (32 - view_count);
	if (!has_content && !is_empty) {
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
	const CasterList &casters = p_inputs.casters[p_view_index];
	add_depth_pass(r_graph, text("depth view ", p_view_index), p_inputs,
			p_inputs.views[p_view_index], casters, import(r_graph), p_view_index);
	drawn_hashes[p_view_index] = casters.content_hash;
}

} // namespace gnomon
