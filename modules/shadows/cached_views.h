#pragma once

#include "modules/core/limits.h"
#include "modules/shadows/shadow_technique.h"

#include <vector>

namespace gnomon {

/// Decides which of a light's views are drawn this frame, for a technique that caches its maps. A
/// view is empty when it has no casters or, with FilterReach::SINGLE_VIEW, no receivers; no view is
/// empty when Inputs::may_skip is false. A view is skipped when it is empty, or when neither the
/// view nor a caster changed since it was drawn. Each frame: call begin, then plan, then set_drawn
/// for each view that is drawn.
class CachedViews {
public:
	/// Whether the technique's filter reads only the view that holds the receiver, or beyond that
	/// view's sides into other views. Views without receivers are skipped only with SINGLE_VIEW.
	enum class FilterReach { SINGLE_VIEW, ADJACENT_VIEWS };
	/// There must be at least one view, at most 32.
	void begin(const ShadowTechnique::Inputs &p_inputs, FilterReach p_filter_reach);
	/// Skips views in the plan. p_has_content: the maps cached in earlier frames still exist and
	/// are valid for the technique's settings.
	void plan(const ShadowTechnique::Inputs &p_inputs, TechniquePlan &r_plan, bool p_has_content);
	/// Call when the view's passes have been recorded.
	void set_drawn(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index);

	/// Bit i is set when view i is empty: its cached map must not be read.
	uint32_t get_empty_views() const { return empty_views; }
	/// True when all views are empty: everything is lit.
	bool is_all_empty() const { return is_empty; }
	/// True when the cached maps may be freed: no view has casters, or all views have been empty
	/// for MAX_UNUSED_FRAMES frames.
	bool may_free_maps() const {
		return is_empty && (unseen_views == 0 || unseen_frame_count >= MAX_UNUSED_FRAMES);
	}
	/// Views that were not skipped, ascending.
	const std::vector<uint32_t> &get_needed_views() const { return needed_views; }

private:
	uint32_t unseen_frame_count = 0;	// frames in a row in which all views were empty, some
										// only because they have no receivers
	std::vector<uint64_t> drawn_hashes; // per view; 0 = no valid map is cached
	uint32_t empty_views = 0;
	uint32_t unseen_views = 0; // those of empty_views that have casters, but no receivers
	bool is_empty = false;
	std::vector<uint32_t> needed_views;
};

} // namespace gnomon
