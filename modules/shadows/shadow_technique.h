#pragma once

#include "modules/core/property.h"
#include "modules/render_graph/render_graph.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/frame_plan.h"
#include "modules/shadows/light_view.h"
#include "modules/shadows/visible_receivers.h"

#include <limits>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

class MeshStore;

/// The casters that one light view may see, culled to it.
struct CasterList {
	std::vector<uint32_t> instances; // indices into SceneSnapshot::instances
	/// Changes when the view, a caster or a caster's transform changes: equal hashes, equal map.
	uint64_t content_hash = 0;
	/// False: no receiver that the camera sees is in the view, so that only filters that look
	/// across into other views can read its map.
	bool has_receivers = true;
};

/// What a technique decides before any pass is recorded. Names the light in the frame's plan.
class TechniquePlan {
public:
	/// p_prefix: distinguishes the runs of one technique for one light, see
	/// sees_translucent_casters.
	explicit TechniquePlan(FramePlan &p_plan, std::string p_prefix = {}) :
			plan(p_plan), prefix(std::move(p_prefix)) {}

	void run(const std::string &p_pass) { plan.run(prefix + p_pass); }
	void skip(const std::string &p_pass, const std::string &p_reason) {
		plan.skip(prefix + p_pass, p_reason);
	}
	/// None of the view's three hooks is called then.
	void skip_light_view(uint32_t p_view_index, const std::string &p_reason);
	bool is_light_view_skipped(uint32_t p_view_index) const {
		return skipped_views.count(p_view_index) != 0;
	}

private:
	FramePlan &plan;
	std::string prefix;
	std::set<uint32_t> skipped_views;
};

/// Where the answer stays sensible, measured by the stability sweeps (doc/stability.md). Beyond it
/// there is light where all is dark, or shadow where all is lit.
struct ShadowLimits {
	/// From the light's centre to the nearest caster, over R; placed lights of some size only.
	/// Within 1 the light's sphere touches the caster, and part of it is inside.
	double least_caster_distance_radii = 1.0;
	/// Of r, over S; and of t.
	double most_outer_width_sizes = std::numeric_limits<double>::infinity();
	double most_inner_width_sizes = std::numeric_limits<double>::infinity();
};

/// Answers one question for one light: what fraction of it does each visible pixel see?
///
/// The shadow system owns one instance per shadow-casting light, and one more for each group of
/// translucent casters (see sees_translucent_casters), and calls it on the render thread, each
/// frame in the order in which the methods are declared here. The engine knows the id, never the
/// class.
class ShadowTechnique {
public:
	/// Valid from plan() to resolve() of one frame. All textures have the size `size_px`.
	struct Inputs {
		RenderingDevice &device;
		MeshStore &meshes; // GPU buffers of the casters
		const SceneSnapshot &scene;
		const LightSnapshot &light;
		/// Of the technique's light properties, with defaults filled in and every value in range.
		const PropertyValues &properties;
		const PropertyValues &settings; // of the technique, complete; see get_settings
		std::span<const LightView> views;
		std::span<const CasterList> casters; // one list per view
		glm::uvec2 size_px;
		RGTexture depth;			// D32_SFLOAT, reversed; 0 = background
		RGTexture geometric_normal; // R32_UINT, normal_inc.glsl; of the face, towards the viewer
		/// RGBA16_SFLOAT: scatter, its distance in metres. Empty where the host draws no materials:
		/// nothing scatters then.
		RGTexture material;
		RGTexture receivers; // R8_UNORM: 1 where the light can reach; the mask counts only there
		RGBuffer frame;		 // FrameConstants
		RGBuffer light_constants; // LightConstants
		/// False: nothing may be skipped (for the test that compares both bit for bit).
		bool may_skip = true;
		/// False: what was cached of earlier frames must not be used, as if everything had moved.
		bool may_reuse = true;
		/// True while one of the technique's debug views is shown.
		bool wants_debug_views = false;
		/// What the camera sees of the instances that the light may reach: all receivers are there.
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
		/// Values are depths of light views as maps hold them. The shadow system chooses
		/// shown_range: black the farthest caster, white a third of its distance; directional: all
		/// depths.
		bool is_light_depth = false;
	};

	virtual ~ShadowTechnique() = default;

	/// Within what the technique's results hold, see its page. Called once a frame, with
	/// p_properties as in Inputs; beyond a limit there is a warning.
	virtual ShadowLimits get_limits(const PropertyValues & /*p_properties*/) const { return {}; }

	/// Properties this technique adds to a light; names begin with the technique's id. Called on
	/// any instance, at any time; always the same list.
	virtual void get_light_properties(PropertyList & /*r_list*/) const {}
	/// Settings of the technique for all lights alike: how it computes, not what, so no property of
	/// a light. Names without the id. Called on any instance, at any time; always the same list.
	virtual void get_settings(PropertyList & /*r_list*/) const {}
	/// Settings worth comparing for that light, whose r and t are derived from its size. Cheapest
	/// first; empty: the defaults alone. Called on any instance, at any time.
	virtual void get_quality_settings(const LightSnapshot & /*p_light*/,
			std::vector<QualitySetting> & /*r_settings*/) const {}
	/// Called once a frame with p_properties as in Inputs. Leave empty when nothing is rendered
	/// from the light.
	virtual void get_light_views(const LightSnapshot & /*p_light*/, const LightScene & /*p_scene*/,
			const PropertyValues & /*p_properties*/, std::vector<LightView> & /*r_views*/) const {}
	/// True: directional views may be narrowed to what the camera sees and what is a penumbra
	/// from it, since the technique queries its maps for receivers only.
	virtual bool queries_receivers_only() const { return false; }
	/// Called once a frame before any pass: what will run, what is skipped and why.
	virtual void plan(const Inputs & /*p_inputs*/, TechniquePlan & /*r_plan*/) {}
	/// Around each light view that was not skipped, in this order; record passes only.
	virtual void before_light_view(RenderGraph &, const Inputs &, uint32_t /*p_view_index*/) {}
	virtual void at_light_view(RenderGraph &, const Inputs &, uint32_t /*p_view_index*/) {}
	virtual void after_light_view(RenderGraph &, const Inputs &, uint32_t /*p_view_index*/) {}
	/// Returns the visibility mask: R16_SFLOAT (R32_SFLOAT where the precision is needed), 0 =
	/// hidden, 1 = fully lit, one texel per camera pixel, ready to be sampled. Never NaN.
	virtual RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) = 0;
	/// True: resolve() sees translucent casters itself and returns a mask of three colours where
	/// there are any (RGBA16_SFLOAT or RGBA32_SFLOAT). False: it runs once for the opaque ones
	/// and once more for each group of others, as if they were opaque, and the mask is coloured
	/// behind it.
	virtual bool sees_translucent_casters() const { return false; }
	/// Called after resolve() while a debug view is shown.
	virtual void get_debug_views(std::vector<DebugView> & /*r_views*/) const {}
	/// Called after the frame ran: the standard error of its mask where the technique takes samples
	/// at random and knows it, else 0.
	virtual float get_standard_error() const { return 0.0f; }
	/// Entry points under shaders/; compiled by the tests and watched for hot reload.
	virtual std::vector<std::string> get_shader_files() const = 0;
};

} // namespace gnomon
