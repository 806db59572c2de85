#include "modules/shadows/cached_views.h"

#include "modules/core/error.h"

namespace gnomon {

void CachedViews::begin(const ShadowTechnique::Inputs &p_inputs, FilterReach p_filter_reach) {
	const uint32_t view_count = static_cast<uint32_t>(p_inputs.views.size());
	GNOMON_ASSERT(view_count > 0 && view_count <= 32, view_count,
			" light views, must be 1..32: the bits of empty_views");
	empty_views = 0;
	unseen_views = 0;
	for (uint32_t index = 0; index < view_count; ++index) {
		if (p_inputs.may_skip && p_inputs.casters[index].instances.empty()) {
			empty_views |= 1u << index;
		} else if (p_inputs.may_skip && p_filter_reach == FilterReach::SINGLE_VIEW &&
				!p_inputs.casters[index].has_receivers) {
			empty_views |= 1u << index;
			unseen_views |= 1u << index;
		}
	}
	is_empty = empty_views == ~0u >> (32 - view_count);
}

void CachedViews::plan(
		const ShadowTechnique::Inputs &p_inputs, TechniquePlan &r_plan, bool p_has_content) {
	const uint32_t view_count = static_cast<uint32_t>(p_inputs.views.size());
	if (!p_has_content || drawn_hashes.size() != view_count) {
		drawn_hashes.assign(view_count, 0);
	}
	needed_views.clear();
	unseen_frame_count = is_empty && unseen_views != 0 ? unseen_frame_count + 1 : 0;
	const bool may_reuse = p_inputs.may_skip && p_inputs.may_reuse;
	for (uint32_t index = 0; index < view_count; ++index) {
		if ((unseen_views & (1u << index)) != 0) {
			// The cached map stays valid, in case the camera turns back.
			r_plan.skip_light_view(index, "the camera sees no receiver in it");
		} else if ((empty_views & (1u << index)) != 0) {
			drawn_hashes[index] = 0;
			r_plan.skip_light_view(index, "no casters");
		} else if (may_reuse && drawn_hashes[index] == p_inputs.casters[index].content_hash) {
			r_plan.skip_light_view(index, "cached: neither the light nor a caster moved");
		} else {
			drawn_hashes[index] = 0; // until it is drawn
			needed_views.push_back(index);
		}
	}
}

void CachedViews::set_drawn(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index) {
	drawn_hashes[p_view_index] = p_inputs.casters[p_view_index].content_hash;
}

} // namespace gnomon
