#pragma once

#include "modules/core/property.h"
#include "modules/render_graph/render_graph.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/frame_plan.h"
#include "modules/shadows/light_view.h"
#include "modules/shadows/lit_tiles.h"
#include "modules/shadows/probe.h"
#include "modules/shadows/visible_receivers.h"

#include <limits>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

class MeshStore;
class SceneSummary;

/// The casters that one light view may see, culled to it.
struct CasterList {
	std::vector<uint32_t> instances; // indices into SceneSnapshot::instances
	/// Changes when the view, a caster, its transform or its pose changes: equal hashes, equal map.
	uint64_t content_hash = 0;
	/// False: no receiver that the camera sees is in the view, so that only filters that look
	/// across into other views can read its map.
	bool has_receivers = true;
};

/// What a technique decides before any pass is recorded: lines of the frame's plan, and light views
/// to skip. It prefixes pass names; the light is named by FramePlan::set_light.
class TechniquePlan {
public:
	/// p_prefix is put before each pass name, to distinguish the runs of one technique for one
	/// light, see sees_translucent_casters.
	explicit TechniquePlan(FramePlan &p_plan, std::string p_prefix = {}) :
			plan(p_plan), prefix(std::move(p_prefix)) {}

	void run(const std::string &p_pass) { plan.run(prefix + p_pass); }
	void skip(const std::string &p_pass, const std::string &p_reason) {
		plan.skip(prefix + p_pass, p_reason);
	}
	/// None of the view's three hooks is called for a skipped view.
	void skip_light_view(uint32_t p_view_index, const std::string &p_reason);
	bool is_light_view_skipped(uint32_t p_view_index) const {
		return skipped_views.count(p_view_index) != 0;
	}

private:
	FramePlan &plan;
	std::string prefix;
	std::set<uint32_t> skipped_views;
};

/// Limits within which a technique's masks are usable, measured by the stability sweeps
/// (doc/stability.md). Beyond them there is light in the umbra, or shadow where all is lit.
struct ShadowLimits {
	/// Minimum distance from the light's centre to a caster, as a multiple of the light's radius R.
	/// For spot and omni lights with R > 0 only. Below 1 the caster reaches into the light's
	/// sphere.
	double min_caster_distance_radii = 1.0;
	/// Maximum of the outer penumbra width r, and of the inner width t, as fractions of the scene
	/// size S.
	double max_outer_width_sizes = std::numeric_limits<double>::infinity();
	double max_inner_width_sizes = std::numeric_limits<double>::infinity();
};

/// An amount of work that a technique counted, such as entries of lists.
struct WorkCounter {
	std::string name; // "listed_edges"
	uint64_t value = 0;
};

/// Computes, for one light, the fraction of its area that is visible from each pixel's surface.
///
/// The shadow system owns one instance per shadow-casting light, and one more for each group of
/// translucent casters (see sees_translucent_casters), and calls it on the render thread: each
/// frame get_light_views() to get_debug_views() in the order in which they are declared, the others
/// when their comments say. Other modules know techniques by their ids only.
class ShadowTechnique {
public:
	/// Valid from plan() to resolve() of one frame. All textures have the size `size_px`.
	struct Inputs {
		RenderingDevice &device;
		MeshStore &meshes; // GPU buffers of the casters
		const SceneSnapshot &scene;
		const SceneSummary &summary; // of the scene
		/// With the technique's own derived widths (ShadowTechniqueInfo::derived_widths), unlike
		/// the lights of `scene`.
		const LightSnapshot &light;
		/// The technique's properties of the light, with defaults filled in and every value in
		/// range.
		const PropertyValues &properties;
		const PropertyValues &settings; // the technique's, complete; see get_settings
		std::span<const LightView> views;
		std::span<const CasterList> casters; // one list per view
		glm::uvec2 size_px;
		RGTexture depth;			// D32_SFLOAT, reversed; 0 = background
		RGTexture geometric_normal; // R32_UINT, packed by normal_inc.glsl; faces the viewer
		/// RGBA16_SFLOAT: scatter in 0..1, scatter distance in metres. Empty when the host draws no
		/// materials: then nothing scatters.
		RGTexture material;
		/// R8_UNORM: 1 where the light can reach. Other pixels of the mask are not used.
		RGTexture receivers;
		/// Contain all receivers. Passes over pixels need to process only these.
		LitTiles tiles;
		RGBuffer frame;			  // FrameConstants
		RGBuffer light_constants; // LightConstants
		/// False: nothing may be skipped. A test compares the masks of both cases bit for bit.
		bool may_skip = true;
		/// False: nothing cached in earlier frames may be used, as if everything had moved.
		bool may_reuse = true;
		/// True while one of the technique's debug views is shown.
		bool wants_debug_views = false;
		/// True: explain() will be called after the frame was executed.
		bool wants_explanation = false;
		/// Bounds of what the camera sees of the instances that the light may reach. They contain
		/// all receivers.
		std::span<const VisibleReceiver> lit_receivers;
	};
	/// An intermediate image of the last resolve().
	struct DebugView {
		std::string id; // "layer_1"
		RGTexture texture;
		glm::vec2 shown_range = glm::vec2(0.0f, 1.0f); // value shown black, value shown white
		uint32_t layer = 0;
		/// Above 0: values are classes 0 .. class_count - 1 (at most 8), shown in colours.
		uint32_t class_count = 0;
		bool is_color = false; // values are sRGB colours, shown as they are
		/// Values are depths as the light view's map stores them. The shadow system then sets
		/// shown_range: black is the distance of the farthest caster, white a third of it
		/// (directional: the whole depth range).
		bool is_light_depth = false;
	};

	virtual ~ShadowTechnique() = default;

	/// The limits within which the technique's masks are usable. Called once a frame, with
	/// p_properties as in Inputs; a light beyond a limit causes a warning.
	virtual ShadowLimits get_limits(const PropertyValues & /*p_properties*/) const { return {}; }

	/// Properties this technique adds to a light; names begin with the technique's id. Called on
	/// any instance, at any time; always the same list.
	virtual void get_light_properties(PropertyList & /*r_list*/) const {}
	/// Settings that the technique uses for all lights. They change how it computes a mask, not
	/// which mask it approximates, so they are not light properties. Names do not contain the id.
	/// Called on any instance, at any time; always the same list.
	virtual void get_settings(PropertyList & /*r_list*/) const {}
	/// Quality settings that the error report compares, for a light that sets no penumbra widths.
	/// Cheapest first. Empty: only the defaults. Called on any instance, at any time.
	virtual void get_quality_settings(const LightSnapshot & /*p_light*/,
			std::vector<QualitySetting> & /*r_settings*/) const {}
	/// Appends the views that are rendered from the light. Called once a frame with p_properties as
	/// in Inputs. Leave empty when nothing is rendered from the light.
	virtual void get_light_views(const LightSnapshot & /*p_light*/, const LightScene & /*p_scene*/,
			const PropertyValues & /*p_properties*/, std::vector<LightView> & /*r_views*/) const {}
	/// True: the technique queries its maps for receivers only, so directional views may be
	/// narrowed to what the camera sees plus the reach of the penumbras.
	virtual bool queries_receivers_only() const { return false; }
	/// Decides what will run, what is skipped and why. Called once a frame before any pass is
	/// recorded.
	virtual void plan(const Inputs & /*p_inputs*/, TechniquePlan & /*r_plan*/) {}
	/// Called in this order for each light view that was not skipped; may only record passes.
	virtual void before_light_view(RenderGraph &, const Inputs &, uint32_t /*p_view_index*/) {}
	virtual void at_light_view(RenderGraph &, const Inputs &, uint32_t /*p_view_index*/) {}
	virtual void after_light_view(RenderGraph &, const Inputs &, uint32_t /*p_view_index*/) {}
	/// Returns the visibility mask: R16_SFLOAT (R32_SFLOAT where the precision is needed), 0 =
	/// hidden, 1 = fully lit, one texel per camera pixel, ready to be sampled. Never NaN.
	virtual RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) = 0;
	/// Called at any time. True: resolve() handles translucent casters itself and returns an RGB
	/// mask when there are any (RGBA16_SFLOAT or RGBA32_SFLOAT). False: the technique runs once for
	/// the opaque casters and once more for each group of translucent ones, as if they were opaque;
	/// the shadow system then combines the masks into a coloured one (shadows/tint.comp).
	virtual bool sees_translucent_casters() const { return false; }
	/// Called after resolve() while a debug view is shown.
	virtual void get_debug_views(std::vector<DebugView> & /*r_views*/) const {}
	/// Returns the standard error of the last mask, for a technique that samples at random and can
	/// estimate it, otherwise 0. Called after the frame was executed.
	virtual float get_standard_error() const { return 0.0f; }
	/// Tells the technique the times of its light's passes in the newest frame that has finished,
	/// which may be an earlier one. Called after each frame was executed. On a device without
	/// timestamps the GPU times are 0.
	virtual void receive_times(std::span<const PassTiming> /*p_passes*/) {}
	/// Appends the work that the technique counted on the GPU in the last frame whose submission
	/// has finished. Called after the frame was executed.
	virtual void get_counters(std::vector<WorkCounter> & /*r_counters*/) const {}
	/// Adds what the technique knows of how a receiver's visibility came about, and compares it
	/// with more exact computations. Called after a frame with Inputs::wants_explanation was
	/// executed and has finished, for opaque casters.
	virtual void explain(
			const ProbedReceiver & /*p_receiver*/, ProbeEntry & /*r_explanation*/) const {}
	/// Entry points under shaders/; compiled by the tests and watched for hot reload.
	virtual std::vector<std::string> get_shader_files() const = 0;
};

} // namespace gnomon
