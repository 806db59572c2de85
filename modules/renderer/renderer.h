#pragma once

#include "modules/render_graph/render_graph.h"
#include "modules/render_graph/transient_pool.h"
#include "modules/renderer/debug_view.h"
#include "modules/renderer/material_store.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/frame_plan.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/reference_source.h"
#include "modules/shadows/shadow_system.h"
#include "modules/shadows/surface_points.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// A corner of a triangle drawn over the image: text and gizmos.
struct OverlayVertex {
	glm::vec2 position_px; // from the top left
	glm::vec4 color;	   // sRGB-encoded, alpha not premultiplied
};

/// The inputs of one frame.
struct RenderRequest {
	std::shared_ptr<const SceneSnapshot> scene;
	glm::uvec2 size_px = glm::uvec2(512); // 1..16384 each
	/// Supersampling, 1..4: the image and its masks are drawn with this many times the width and
	/// height, and each pixel is the mean of its texels. Masks alone and debug views are drawn at
	/// size_px.
	uint32_t antialiasing = 1;
	/// Replaces the technique of every light. Empty = each light's own.
	std::string technique_override;
	/// The debug view to show instead of the lit image: the id of a technique's view, "mask", or
	/// "error", which needs `reference`. Empty = the lit image.
	std::string debug_view;
	/// Name of the light of the debug view. If no light has this name, or if that light casts no
	/// shadow: the first light that does.
	std::string debug_light;
	/// Reference mask of that light for the same camera, with the frame's size.
	std::shared_ptr<const ReferenceMask> reference;
	/// True: a debug view that does not exist is an Error. False: the lit image is shown then, for
	/// users who change techniques or lights while a view is shown.
	bool needs_debug_view = true;
	bool wants_image = false; // RenderResult::image
	bool wants_graph = false; // RenderResult::dot
	/// If valid, also receives a copy of the image: RGBA8_UNORM, of the frame's size, COPY_TARGET.
	TextureRID image_target;
	/// Only this light's mask: no lighting, no image. Empty = all lights and the image.
	std::string mask_light;
	bool wants_mask = false;	 // with mask_light: RenderResult::visibility and receiver
	bool wants_surfaces = false; // with wants_mask: RenderResult::surfaces and their texels
	/// If set, the image is shown in a window: returns the window's next image, see
	/// RenderGraph::import_window_image.
	std::function<std::optional<TextureRID>()> acquire_window_image;
	std::vector<OverlayVertex> overlay; // three per triangle
	RenderGraph::Mode mode = RenderGraph::Mode::WAIT;
	/// False: runs all passes, even those that the image does not need (for tests).
	bool may_skip = true;
	/// False: techniques use nothing cached from earlier frames, as if everything had moved.
	bool may_reuse = true;
	/// True: shadows derive geometric normals from the depth, as for a host that provides no
	/// normals.
	bool has_depth_only = false;
	bool wants_explanation = false; // Renderer::explain will be called after the frame
};

/// The results of one frame. The values of the mask (base class) are set if they were requested.
struct RenderResult : MaskValues {
	FramePlan plan;
	std::vector<PassTiming> timings;	  // QUEUE: of an earlier frame
	double gpu_ms = 0;					  // sum of the passes
	double wall_ms = 0;					  // see RenderGraph::get_wall_ms
	std::vector<uint8_t> image;			  // RGBA8, sRGB-encoded, rows from the top
	std::vector<std::string> debug_views; // available views, if one was requested
	float standard_error = 0;			  // of visibility, see ShadowTechnique
	std::vector<WorkCounter> counters;	  // of mask_light, of a finished frame
	std::vector<SurfacePoint> surfaces;	  // one per pixel
	std::vector<uint8_t> depth_texels;	  // in the format of HostSurfaces; with the surfaces
	std::vector<uint8_t> normal_texels;
	CommandCounts commands;		  // draws and dispatches of the frame
	std::string dot;			  // the frame's graph for Graphviz, when it was requested
	uint64_t unaliased_bytes = 0; // of transient textures, as if none shared memory
	uint64_t aliased_bytes = 0;

	/// Returns the passes of one light, without the light's name in their names, and the pass that
	/// deforms meshes for all lights.
	std::vector<PassTiming> find_light_passes(const std::string &p_light) const;
};

/// Draws frames of a scene: G-buffer, each light's shadow, lighting, tone map.
class Renderer {
public:
	explicit Renderer(RenderingDevice &p_device);
	~Renderer();

	/// An unknown technique, light or debug view, or a size out of range, is an Error.
	RenderResult render(const RenderRequest &p_request);
	/// See ShadowSystem::explain.
	void explain(const std::string &p_light, const ProbedReceiver &p_receiver,
			ProbeEntry &r_explanation) const {
		shadows.explain(p_light, p_receiver, r_explanation);
	}
	/// Destroys all techniques and their caches, for example after shaders were replaced.
	void clear_caches() { shadows.clear_caches(); }
	RenderingDevice &get_device() { return device; }

private:
	struct Frame;
	LightShadow add_light(Frame &r_frame, const LightSnapshot &p_light);
	void add_mask_only(Frame &r_frame);
	void add_image(Frame &r_frame);
	void add_overlay(Frame &r_frame, RGTexture p_target);

	RenderingDevice &device;
	TransientPool transients;
	ShadowSystem shadows;
	MaterialStore materials;
	GBufferInstances gbuffer_instances; // of the last frame
};

} // namespace gnomon
