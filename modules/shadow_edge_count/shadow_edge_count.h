#pragma once

#include "modules/shadow_edge_count/count_probe.h"
#include "modules/shadow_edge_count/count_time_budget.h"
#include "modules/shadow_edge_count/leaf_passes.h"
#include "modules/shadow_edge_count/shadowing_casters.h"
#include "modules/shadows/cached_views.h"

#include <optional>
#include <vector>

// A light's frame, pass by pass, with the buffers that each writes. n faces and e edges of the
// light's casters, l leaves: 1.5 for each 8 x 8 pixels. Numbers are bytes.
//
//     meshes of all lights: faces 32, edges 16, vertices 16        casters of the light: 112 each
//                         |                                              |
//  1 caster faces ----> planes 16 n, faces 48 n <------------------------+
//  2 mark edges ------> words: a bit an edge; runs: 4 for 2,048 edges
//  3 list edges ------> edges 32 e
//  4 bound clusters --> nodes: 32 for 14 faces or edges, the two trees
//  5 list cut faces --> cut faces 4 n, if a caster comes within R of the light's centre
//                         |  (1, 2 for casters that moved; 3 to 5 if any did)
//  6 clear leaves ----> counts, arguments, status, counts of rounds
//  7 find leaves -----> leaves 112 l
//  8 list leaves -----> results 32 l; lists: 4 an entry, 23 MB at most; leaves by kind 24 l
//  9 choose rungs ----> ladder 4, with a time budget
// 10 resolve dark, count solids, resolve smooth, resolve, resolve without lists --> mask 2 a pixel
// 11 resolve unfinished -> states 2.5 MB at most, slots; then the mask
// 12 filter ----------> mask; reads the depth maps, with a budget
// 13 read status
//
// 1 to 5 are in find_passes.h and count_casters.h, 6 to 12 in leaf_passes.h and count_rounds.h.
// Based on: Laine et al. 2005 (soft shadow volumes: silhouettes and one reference ray), Johnson et
// al. 2009 (lists for receivers), Aila and Laine 2009 (walks through trees), Olsson et al. 2012
// (clusters of pixels); doc/techniques/edge_count.md has the sources in full.

namespace gnomon {

/// Soft shadows by counting: the exact number of solids between a receiver and the light's centre,
/// plus the silhouette edges crossed between the centre and each sample point of the light. No
/// noise, and no bias to tune. See doc/techniques/edge_count.md.
class ShadowEdgeCount : public ShadowTechnique {
public:
	void get_light_properties(PropertyList &r_list) const override;
	void get_quality_settings(
			const LightSnapshot &p_light, std::vector<QualitySetting> &r_settings) const override;
	void get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
			const PropertyValues &p_properties, std::vector<LightView> &r_views) const override;
	bool queries_receivers_only() const override { return true; }
	ShadowLimits get_limits(const PropertyValues & /*p_properties*/) const override {
		return { .min_caster_distance_radii = 0 }; // a caster may cut the disc
	}
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override;
	void at_light_view(
			RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) override;
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override;
	void get_debug_views(std::vector<DebugView> &r_views) const override;
	void receive_times(std::span<const PassTiming> p_passes) override;
	void get_counters(std::vector<WorkCounter> &r_counters) const override {
		status.get_counters(r_counters);
	}
	void explain(const ProbedReceiver &p_receiver, ProbeEntry &r_explanation) const override;
	std::vector<std::string> get_shader_files() const override;

protected:
	/// Called between the passes that write the lists of leaves and those that read them. Tests
	/// damage lists here.
	virtual void after_lists(RenderGraph & /*r_graph*/, const CountFrameBuffers & /*p_light*/,
			const CountLeaves & /*p_leaves*/) {}
	/// With a time budget: the cost for which there is time in this frame. Tests choose it.
	virtual uint32_t find_cost_limit() const {
		return time_budget->find_cost_limit(settings.time_budget_ms);
	}

	/// Tests choose them.
	virtual CasterLimits find_caster_limits(const RenderingDevice &p_device) const;

private:
	/// The light and casters for which the buffers were last filled.
	struct CachedState {
		LightView first_view; // its axes are those of light space
		double disc_radius = -1;
		CountCasters casters;
		uint64_t casters_hash = 0; // of what they were built from
		uint64_t light_hash = 0;   // the same without the casters
		bool has_depth_map = false;
	};

	void plan_casters(TechniquePlan &r_plan);
	void plan_filter(TechniquePlan &r_plan);
	void plan_rungs(TechniquePlan &r_plan);
	/// The mask tables of all sample sets of so many points.
	static OwnedBuffer make_masks(const Inputs &p_inputs, uint32_t p_point_count);
	/// Creates what a frame of these settings needs, and frees what it does not need.
	void prepare_masks(const Inputs &p_inputs);
	/// The depth map for leaves over budget; one texture array for all views.
	RGTexture import_depth_map(RenderGraph &r_graph, const Inputs &p_inputs);

	ChosenCasters chosen;
	CasterOrder order;
	CountBuffers buffers;
	CachedViews views;
	CachedState cached;
	OwnedBuffer masks;			   // see make_masks
	uint32_t mask_point_count = 0; // of the points in masks
	OwnedBuffer few_masks;		   // with a time budget: of EDGE_COUNT_SAMPLE_COUNT points
	OwnedBuffer ladder;			   // with a time budget: see CountLeafPasses
	std::optional<CountTimeBudget> time_budget;
	OwnedTexture depth_map;
	CountStatus status;
	std::optional<CountProbe> probe; // of a frame with Inputs::wants_explanation

	// State of this frame.
	CountSettings settings;
	bool has_casters = false;		// some caster has faces
	bool may_exceed_budget = false; // leaves may have more edges than the budget
	bool may_filter = false;		// and, or there may be no time for them
	bool are_casters_found = false; // the passes of add_find_passes were added
	RGTexture frame_depth_map;
	RGTexture debug_image;
};

} // namespace gnomon
