#pragma once

#include "modules/core/limits.h"
#include "modules/shadows/shadow_technique.h"

#include <vector>

namespace gnomon {

/// Which of a light's views must be drawn this frame, for a technique that caches what it draws:
/// not those without casters or without receivers, nor those in which neither the view nor a caster
/// changed since they were drawn. Each frame: begin, then plan, then set_drawn for each view that
/// is drawn.
class CachedViews {
public:
	/// How far the technique's filter reads: in the view that holds the receiver alone, or across
	/// its sides in other views too. Views without receivers are skipped only with OWN_VIEW.
	enum class Reads { OWN_VIEW, ACROSS_VIEWS };
	/// There must be at least one view, at most 32.
	void begin(const ShadowTechnique::Inputs &p_inputs, Reads p_reads);
	/// Leaves views out of the plan. p_has_content: what was cached of earlier frames is still
	/// there, and of use for the technique's settings.
	void plan(const ShadowTechnique::Inputs &p_inputs, TechniquePlan &r_plan, bool p_has_content);
	/// The view's passes are recorded.
	void set_drawn(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index);

	/// Bit i: view i has no casters or no receivers; what is cached for it must not be read.
	uint32_t get_empty_views() const { return empty_views; }
	/// No view has casters and receivers: everything is lit.
	bool is_all_empty() const { return is_empty; }
	/// What is cached may go: no view has casters, or for long the camera saw no receiver in any.
	bool may_forget() const {
		return is_empty && (unseen_views == 0 || unseen_frame_count >= MAX_UNUSED_FRAMES);
	}
	/// Views that were not skipped, ascending.
	const std::vector<uint32_t> &get_needed_views() const { return needed_views; }

private:
	uint32_t unseen_frame_count = 0;	// in which nothing but receivers was missing
	std::vector<uint64_t> drawn_hashes; // per view; 0 = nothing of use is cached
	uint32_t empty_views = 0;
	uint32_t unseen_views = 0; // of them: those that have casters
	bool is_empty = false;
	std::vector<uint32_t> needed_views;
};

} // namespace gnomon
