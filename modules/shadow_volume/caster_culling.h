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
	/// The setting "culling". AUTO culls where it probably saves time, see plan.
	enum class Mode { AUTO, ON, OFF };

	/// Returns p_instances (ascending) without the hidden ones, if an earlier result is still
	/// valid. Otherwise decides whether add_passes tests them in this frame, and returns all. AUTO
	/// culls from 64 casters on, and pauses for 60 frames after a result in which less than a tenth
	/// of the casters was hidden.
	std::vector<uint32_t> plan(const ShadowTechnique::Inputs &p_inputs, Mode p_mode,
			const std::vector<uint32_t> &p_instances, TechniquePlan &r_plan);
	/// Reports in the plan what add_passes will do. Call it only when add_passes will be called.
	void report(TechniquePlan &r_plan) const;
	/// Valid after plan. True when the predicates of add_passes will decide which casters are
	/// drawn.
	bool decides_draws(const ShadowTechnique::Inputs &p_inputs) const {
		return tested_instances && p_inputs.device.get_features().conditional_rendering;
	}
	/// Adds passes that test the casters this frame, when plan decided so, and returns the
	/// predicates of their draws. Without conditional rendering there are none, and only later
	/// frames use the result.
	DrawPredicates add_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs);
	/// Valid after add_passes: adds the depth map of the occluders, when they were drawn.
	void get_debug_views(std::vector<ShadowTechnique::DebugView> &r_views) const;

private:
	/// Predicate words that were read back from the GPU.
	struct Readback {
		uint64_t key = 0;
		std::vector<uint32_t> words; // per caster, 0 = hidden
	};
	/// The last result, as plan uses it.
	struct CullingResult {
		uint64_t key = 0;			 // hash of the views and casters
		std::vector<bool> is_hidden; // per caster, in the order of plan's p_instances
	};

	/// Takes over the latest readback, if there is one.
	void process_readback();
	/// Returns p_instances without hidden casters, and reports their number in the plan.
	std::vector<uint32_t> cull_hidden(
			const std::vector<uint32_t> &p_instances, TechniquePlan &r_plan) const;
	void add_readback(RenderGraph &r_graph, RGBuffer p_words);

	/// Latest readback since the last plan. Shared with pending readbacks, which may outlive this
	/// object.
	std::shared_ptr<std::optional<Readback>> latest_readback =
			std::make_shared<std::optional<Readback>>();
	std::optional<CullingResult> last_result;
	uint64_t frame = 0;				 // number of calls of plan
	uint64_t paused_until_frame = 0; // AUTO does not test casters before this frame

	// State of the current frame.
	uint64_t key = 0;
	std::shared_ptr<const std::vector<uint32_t>> tested_instances; // instances; null: no test
	std::vector<uint32_t> occluders;
	RGTexture map;
};

} // namespace gnomon
