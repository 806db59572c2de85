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
	/// Supersampling, 1..4: the image and its masks are drawn at this many times the width and
	/// height, and each pixel is the mean of its texels. Masks alone and debug views are drawn at
	/// size_px.
	uint32_t antialiasing = 1;
	/// Replaces the technique of every light. Empty = each light's own.
	std::string technique_override;
	/// Shows an intermediate image of a light's technique: its id, or "mask", or "error" if there
	/// is a reference.
	std::string debug_view;
	/// Name of the light of the debug view. If empty, or if it casts no shadow: the first that
	/// does.
	std::string debug_light;
	/// Reference mask of that light for the same camera; of the frame's size.
	std::shared_ptr<const ReferenceMask> reference;
	/// False: if the debug view does not exist, the lit image is shown, as a user expects who
	/// changes the technique or the lights while looking at a view.
	bool needs_debug_view = true;
	bool wants_image = false; // RenderResult::image
	bool wants_graph = false; // RenderResult::dot
	/// If valid, also receives a copy of the image: RGBA8_UNORM, of the frame's size, COPY_TARGET.
	TextureRID image_target;
	/// Only this light's mask: no lighting, no image. Empty = all lights and the image.
	std::string mask_light;
	bool wants_mask = false;	 // with mask_light: RenderResult::visibility and receiver
	bool wants_surfaces = false; // with wants_mask: RenderResult::surfaces and their texels
	/// Acquires the window's next image to show the lit image in; see
	/// RenderGraph::import_window_image.
	std::function<std::optional<TextureRID>()> acquire_window_image;
	std::vector<OverlayVertex> overlay; // three per triangle
	RenderGraph::Mode mode = RenderGraph::Mode::WAIT;
	/// False: runs all passes, even those that the image does not need (for the test that compares
	/// both).
	bool may_skip = true;
	/// False: techniques use nothing cached from earlier frames, as if everything had moved.
	bool may_reuse = true;
	/// True: shadows derive geometric normals from the depth, for a host that draws none.
	bool has_depth_alone = false;
};

/// The mask's values are set if they were requested.
struct RenderResult : MaskValues {
	FramePlan plan;
	std::vector<PassTiming> timings;	  // QUEUE: of an earlier frame
	double gpu_ms = 0;					  // sum of the passes
	double wall_ms = 0;					  // of the frame's submission
	std::vector<uint8_t> image;			  // RGBA8, sRGB-encoded, rows from the top
	std::vector<std::string> debug_views; // available views, if one was requested
	float standard_error = 0;			  // of visibility, see ShadowTechnique
	std::vector<SurfacePoint> surfaces;	  // one per pixel
	std::vector<uint8_t> depth_texels;	  // in the format of HostSurfaces; with the surfaces
	std::vector<uint8_t> normal_texels;
	CommandCounts commands;		  // draws and dispatches of the frame
	std::string dot;			  // the frame's graph for Graphviz, when it was requested
	uint64_t unaliased_bytes = 0; // of transient textures, as if none shared memory
	uint64_t aliased_bytes = 0;

	/// Returns the passes of one light, without the light's name in their names.
	std::vector<PassTiming> find_light_passes(const std::string &p_light) const;
};

/// Draws frames of a scene: G-buffer, each light's shadow, lighting, tone map.
class Renderer {
public:
	explicit Renderer(RenderingDevice &p_device);
	~Renderer();

	/// An unknown technique, light or debug view, or a size out of range, is an Error.
	RenderResult render(const RenderRequest &p_request);
	/// Makes techniques discard their caches, as after shaders were replaced.
	void forget_cached() { shadows.forget_cached(); }
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
};

} // namespace gnomon
