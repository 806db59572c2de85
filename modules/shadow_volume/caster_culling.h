#pragma once

#include "modules/shadows/draw_predicates.h"
#include "modules/shadows/shadow_technique.h"

#include <memory>
#include <optional>
#include <vector>

namespace gnomon {

/// Hierarchical occlusion culling in one light's views (GPU Gems 3, chapter 11): a caster that
/// others hide from the light has no shadow of its own. The largest casters are drawn from the
/// light into a coarse map, which the boxes of a tree over all casters are compared with on the
/// GPU.
///
/// Where the chapter uses occlusion queries, a compute shader compares: a query sees only the
/// centres of texels, so that a box between them counts as hidden, and the image would change.
/// Here a texel counts only where all its rays are stopped, and a box only with every texel that it
/// touches: what is culled is hidden with certainty.
///
/// What was found comes back some frames later. While neither light nor casters have moved since,
/// it holds, and hidden casters are culled without a test; otherwise it only leads the choice of
/// occluders, and this frame's words decide on the GPU.
class CasterCulling {
public:
	enum class Wish { AUTO, ON, OFF };

	/// Returns those of p_instances (ascending) that are not known to be hidden. AUTO: not below 64
	/// casters, and not for 60 frames after less than a tenth was hidden.
	std::vector<uint32_t> plan(const ShadowTechnique::Inputs &p_inputs, Wish p_wish,
			const std::vector<uint32_t> &p_instances, TechniquePlan &r_plan);
	/// Reports in the plan what add_passes will do, where it is called.
	void report(TechniquePlan &r_plan) const;
	/// After plan: words that add_passes makes will decide which casters are drawn.
	bool decides_draws(const ShadowTechnique::Inputs &p_inputs) const {
		return tested && p_inputs.device.get_features().conditional_rendering;
	}
	/// Passes that look at the casters this frame, where plan found that to be of use. Without
	/// conditional rendering their result serves later frames only.
	DrawPredicates add_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs);
	/// After add_passes: the map that the occluders were drawn into, where they were.
	void get_debug_views(std::vector<ShadowTechnique::DebugView> &r_views) const;

private:
	/// Words that have come back from the GPU.
	struct Result {
		uint64_t key = 0;
		std::vector<uint32_t> words; // per caster, 0 = hidden
	};
	struct Known {
		uint64_t key = 0;			 // of the views and casters
		std::vector<bool> is_hidden; // per caster, in the order of plan's p_instances
	};

	void collect();
	std::vector<uint32_t> cull_hidden(
			const std::vector<uint32_t> &p_instances, TechniquePlan &r_plan) const;
	void add_readback(RenderGraph &r_graph, RGBuffer p_words);

	/// Since the last plan; shared with what comes back when this object is gone.
	std::shared_ptr<std::optional<Result>> newest = std::make_shared<std::optional<Result>>();
	std::optional<Known> known;
	uint64_t frame = 0;
	uint64_t rests_until_frame = 0;

	// This frame.
	uint64_t key = 0;
	std::shared_ptr<const std::vector<uint32_t>> tested;
	std::vector<uint32_t> occluders;
	RGTexture map;
};

} // namespace gnomon
