#pragma once

#include "modules/shadows/draw_predicates.h"
#include "modules/shadows/shadow_technique.h"

#include <memory>
#include <optional>
#include <vector>

namespace gnomon {

/// Hierarchical occlusion culling in one light's views (GPU Gems 3, chapter 11): a caster that
/// other casters hide completely from the light adds no shadow. The largest casters are drawn from
/// the light into a coarse depth map, and the boxes of a tree over all casters are compared with it
/// on the GPU.
///
/// The chapter uses occlusion queries; here a compute shader compares. A query tests only the
/// centres of texels, so a box between them would count as hidden and the image would change. Here
/// a texel is occluded only when all its rays are blocked, and a box only when every texel that it
/// overlaps is occluded: the culling is conservative.
///
/// Results are read back some frames later. While neither the light nor the casters have moved
/// since, hidden casters are culled without a test. Otherwise the results only guide the choice of
/// occluders, and this frame's predicates decide on the GPU.
class CasterCulling {
public:
	enum class Wish { AUTO, ON, OFF };

	/// Returns those of p_instances (ascending) that are not known to be hidden. AUTO culls from 64
	/// casters on, and pauses for 60 frames when less than a tenth was hidden.
	std::vector<uint32_t> plan(const ShadowTechnique::Inputs &p_inputs, Wish p_wish,
			const std::vector<uint32_t> &p_instances, TechniquePlan &r_plan);
	/// Reports in the plan what add_passes will do. Call it only when add_passes will be called.
	void report(TechniquePlan &r_plan) const;
	/// Valid after plan. True when the predicates of add_passes will decide which casters are
	/// drawn.
	bool decides_draws(const ShadowTechnique::Inputs &p_inputs) const {
		return tested && p_inputs.device.get_features().conditional_rendering;
	}
	/// Adds passes that test the casters this frame, when plan decided so. Without conditional
	/// rendering their result is only used in later frames.
	DrawPredicates add_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs);
	/// Valid after add_passes: the map of the occluders, when they were drawn.
	void get_debug_views(std::vector<ShadowTechnique::DebugView> &r_views) const;

private:
	/// Predicate words that were read back from the GPU.
	struct Result {
		uint64_t key = 0;
		std::vector<uint32_t> words; // per caster, 0 = hidden
	};
	struct Known {
		uint64_t key = 0;			 // hash of the views and casters
		std::vector<bool> is_hidden; // per caster, in the order of plan's p_instances
	};

	void collect();
	std::vector<uint32_t> cull_hidden(
			const std::vector<uint32_t> &p_instances, TechniquePlan &r_plan) const;
	void add_readback(RenderGraph &r_graph, RGBuffer p_words);

	/// Result since the last plan; shared with readbacks that may outlive this object.
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
