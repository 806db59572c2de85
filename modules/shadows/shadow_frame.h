#pragma once

#include "modules/render_graph/render_graph.h"
#include "modules/shadows/frame_plan.h"
#include "modules/shadows/shadow_system.h"
#include "modules/shadows/translucent_casters.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// What the host has drawn of the scene as the snapshot's camera sees it: textures of the frame's
/// graph, all of the frame's size.
struct HostSurfaces {
	RGTexture depth; // D32_SFLOAT, reversed: near / z; 0 = background
	/// R32_UINT, packed as normal_inc.glsl does: of the face, towards the viewer, in the world's
	/// axes. Empty: made from the depth.
	RGTexture geometric_normal;
	/// RGBA16_SFLOAT: scatter in 0..1, its distance in metres, two more that shadows do not read.
	/// Empty: nothing scatters.
	RGTexture material;
};

/// What a host gets for one light.
struct LightShadow {
	/// 0 = hidden, 1 = fully lit: R16_SFLOAT or R32_SFLOAT; of three colours behind translucent
	/// casters: RGBA16_SFLOAT or RGBA32_SFLOAT (is_colored_mask). Counts where receivers is 1.
	RGTexture mask;
	RGTexture receivers; // R8_UNORM: 1 where the light can reach: faces it, inside cone and range
	RGBuffer light_constants; // shader::LightConstants
	/// Of the light's technique, when they were requested.
	std::vector<ShadowTechnique::DebugView> debug_views;
};

struct ShadowFrameOptions {
	/// Replaces the technique of every light. Empty = each light's own. Must be registered.
	std::string technique_override = {};
	/// False: runs everything, also what the masks do not need.
	bool may_skip = true;
	/// False: techniques use nothing that they cached of earlier frames.
	bool may_reuse = true;
};

/// Makes the masks of one frame: records their passes in the host's graph, one light after the
/// other, as often as the host calls it.
///
/// Use: make it, draw (get_constants() is the camera), set_surfaces, add_light for each light, use
/// the masks in passes of the same graph, execute the graph, end. A mask's memory is free again
/// behind the last pass that reads it, so that masks which are used one by one share it.
class ShadowFrame {
public:
	/// r_plan: gets what runs and what does not, and why. The graph, the plan and the system must
	/// live as long as this.
	ShadowFrame(ShadowSystem &r_system, RenderGraph &r_graph, FramePlan &r_plan,
			std::shared_ptr<const SceneSnapshot> p_scene, glm::uvec2 p_size_px,
			ShadowFrameOptions p_options = {});
	/// Without end(): techniques forget what they cached, as they may count on passes that never
	/// ran.
	~ShadowFrame();
	ShadowFrame(const ShadowFrame &) = delete;
	ShadowFrame &operator=(const ShadowFrame &) = delete;

	/// The camera: shader::FrameConstants, a uniform block.
	RGBuffer get_constants() const { return constants; }
	/// Before the first add_light.
	void set_surfaces(const HostSurfaces &p_surfaces);
	/// As set, with normals.
	const HostSurfaces &get_surfaces() const { return surfaces; }

	/// Why the light changes no pixel; empty when it may.
	std::string describe_unlit(const LightSnapshot &p_light) const;
	/// Records one light's passes. They, and what the host adds until the next light, are named
	/// after it in the graph and in the plan. p_light is one of the snapshot's.
	LightShadow add_light(const LightSnapshot &p_light, bool p_wants_debug_views = false);
	/// All lights of the snapshot, for a host that uses their masks together.
	std::vector<LightShadow> add_all_lights();
	/// Copies a light's mask into a layer of an array that outlives the frame: R16_SFLOAT (of a
	/// coloured mask its luminance) or RGBA16_SFLOAT, STORAGE, at least of the frame's size, made
	/// with TextureDesc::is_array. p_elsewhere: its value where there is no receiver, because
	/// nothing is there, the light does not reach it, or the surface faces away from it.
	void hold(const LightShadow &p_shadow, RGTexture p_array, uint32_t p_layer,
			float p_elsewhere = 0.0f);

	/// After the graph was executed.
	void end();

private:
	/// What the runs of one technique for one light share.
	struct Work;
	RGTexture add_receivers_pass(RGBuffer p_light_constants);
	RGTexture add_normals_pass();
	RGTexture add_shadow(const LightSnapshot &p_light, const VisibleReceivers &p_lit,
			LightShadow &r_shadow, bool p_wants_debug_views);
	ShadowTechnique::Inputs make_inputs(const Work &p_work, std::span<const LightView> p_views,
			std::span<const CasterList> p_casters, bool p_wants_debug_views) const;
	/// p_run: empty for the opaque casters, else the name of the translucent ones.
	RGTexture add_technique(const Work &p_work, ShadowTechnique &r_technique,
			const CasterFlags &p_casts, const std::string &p_run);
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
	VisibleReceivers receivers; // of any light
	/// Of lights that not all casters cast a shadow of.
	std::vector<std::shared_ptr<const SceneSnapshot>> selections;
	bool has_ended = false;
};

} // namespace gnomon
