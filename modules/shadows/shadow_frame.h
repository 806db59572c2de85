#pragma once

#include "modules/render_graph/render_graph.h"
#include "modules/shadows/frame_plan.h"
#include "modules/shadows/shadow_system.h"
#include "modules/shadows/translucent_casters.h"

#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// The G-buffer that the host has drawn with the snapshot's camera: textures of the frame's graph,
/// all of the frame's size.
struct HostSurfaces {
	RGTexture depth; // D32_SFLOAT, reversed: near / z; 0 = background
	/// R32_UINT, the face's normal towards the viewer in world axes, packed by normal_inc.glsl.
	/// Empty: reconstructed from the depth (normals_from_depth.comp).
	RGTexture geometric_normal;
	/// RGBA16_SFLOAT: R is scatter in 0..1, G the scatter distance in metres; shadows do not read B
	/// and A. Empty: nothing scatters.
	RGTexture material;
};

/// The result for one light.
struct LightShadow {
	/// 0 = hidden, 1 = fully lit: R16_SFLOAT or R32_SFLOAT. With translucent casters an RGB mask:
	/// RGBA16_SFLOAT or RGBA32_SFLOAT (is_colored_mask). Valid only where `receivers` is 1.
	RGTexture mask;
	RGTexture receivers; // R8_UNORM: 1 where the light can reach: faces it, inside cone and range
	LitTiles tiles;		 // contain all receivers
	RGBuffer light_constants; // shader::LightConstants
	/// The debug views of the light's technique, when they were requested.
	std::vector<ShadowTechnique::DebugView> debug_views;
};

struct ShadowFrameOptions {
	/// Replaces the technique of every light. Empty = each light's own. Must be registered.
	std::string technique_override = {};
	/// False: runs every pass, even those that the masks do not need.
	bool may_skip = true;
	/// False: techniques use nothing that they cached in earlier frames.
	bool may_reuse = true;
	/// True: ShadowSystem::explain will be called after the frame.
	bool wants_explanation = false;
};

/// Computes the masks of one frame: records their passes in the host's graph, one light per call of
/// add_light.
///
/// Use: construct it, draw the G-buffer (get_constants() is the camera), set_surfaces, add_light
/// for each light, use the masks in passes of the same graph, execute the graph, end. A mask's
/// memory is reused after the last pass that reads it, so masks that are used in turn share it.
class ShadowFrame {
public:
	/// r_plan receives the passes that run, and those that are skipped and why. The graph, the plan
	/// and the system must outlive the ShadowFrame.
	ShadowFrame(ShadowSystem &r_system, RenderGraph &r_graph, FramePlan &r_plan,
			std::shared_ptr<const SceneSnapshot> p_scene, glm::uvec2 p_size_px,
			ShadowFrameOptions p_options = {});
	/// When end() was not called, techniques drop their caches, since these may rely on passes that
	/// never ran.
	~ShadowFrame();
	ShadowFrame(const ShadowFrame &) = delete;
	ShadowFrame &operator=(const ShadowFrame &) = delete;

	/// The camera, as a buffer that can be bound as uniform or storage buffer:
	/// shader::FrameConstants.
	RGBuffer get_constants() const { return constants; }
	/// All instances that the camera may see, in the snapshot's order.
	std::span<const VisibleReceiver> list_visible() const {
		return system.derived_camera.receivers.list;
	}
	/// Of all instances.
	const Bounds &get_scene_bounds() const { return system.derived_scene.summary.get_bounds(); }
	/// Call before the first add_light.
	void set_surfaces(const HostSurfaces &p_surfaces);
	/// The surfaces that were set, with normals added when the host gave none.
	const HostSurfaces &get_surfaces() const { return surfaces; }

	/// Returns why the light changes no pixel; empty when it may change some.
	std::string describe_unlit(const LightSnapshot &p_light) const;
	/// Records one light's passes. In the graph and the plan they, and the passes that the host
	/// adds before the next light, carry the light's name. p_light must be a light of the snapshot.
	LightShadow add_light(const LightSnapshot &p_light, bool p_wants_debug_views = false);
	/// Calls add_light for all lights of the snapshot, for a host that uses their masks together.
	std::vector<LightShadow> add_all_lights();
	/// Copies a light's mask into a layer of a texture array that outlives the frame: R16_SFLOAT
	/// (gets the luminance of a coloured mask) or RGBA16_SFLOAT, usage STORAGE and COPY_TARGET, at
	/// least of the frame's size, with TextureDesc::is_array. p_no_receiver_value: the value of
	/// pixels without a receiver: background, out of the light's reach, or facing away from it.
	/// Receivers on their far side with visibility v get p_no_receiver_value - 1 - v.
	void hold(const LightShadow &p_shadow, RGTexture p_array, uint32_t p_layer,
			float p_no_receiver_value = 0.0f);

	/// Call after the graph was executed.
	void end();

private:
	/// Data that the runs of one technique for one light share.
	struct Work;
	/// Sets the tiles and the receivers of a light.
	void add_receivers_pass(LightShadow &r_shadow, bool p_lists_all_tiles);
	RGTexture add_normals_pass();
	RGTexture add_shadow(const LightSnapshot &p_light, const VisibleReceivers &p_lit,
			LightShadow &r_shadow, bool p_wants_debug_views);
	ShadowTechnique::Inputs make_inputs(const Work &p_work, std::span<const LightView> p_views,
			std::span<const CasterList> p_casters, bool p_wants_debug_views) const;
	/// p_group: null for the opaque casters. p_run: empty for these, else the group's name.
	RGTexture add_technique(const Work &p_work, ShadowSystem::Slot &r_slot,
			const TranslucentCasters &p_translucent, const TranslucentGroup *p_group,
			const std::string &p_run);
	void derive_run(const Work &p_work, const ShadowTechnique &p_technique,
			const TranslucentCasters &p_translucent, const TranslucentGroup *p_group,
			bool p_wants_debug_views, ShadowSystem::DerivedRun &r_run) const;
	RGTexture add_translucent_casters(
			const Work &p_work, const TranslucentCasters &p_casters, RGTexture p_opaque);
	RGTexture add_filters(const Work &p_work, RGTexture p_mask);

	ShadowSystem &system;
	RenderGraph &graph;
	FramePlan &plan;
	std::shared_ptr<const SceneSnapshot> scene;
	glm::uvec2 size_px;
	ShadowFrameOptions options;
	RGBuffer constants;
	HostSurfaces surfaces;
	RGBuffer tile_depths; // see add_tile_depths_pass
	/// Copies of lights, with the widths that their technique derives.
	std::deque<LightSnapshot> lights;
	bool has_ended = false;
};

} // namespace gnomon
