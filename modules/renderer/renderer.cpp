#include "modules/renderer/renderer.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/render_graph/read_back.h"
#include "modules/renderer/gbuffer.h"
#include "modules/renderer/lighting.h"
#include "modules/renderer/present_pass.h"
#include "modules/shadows/camera_view.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/shadow_frame.h"

namespace gnomon {

namespace {

void check_request(const RenderRequest &p_request, const RenderingDevice &p_device) {
	GNOMON_ASSERT(p_request.scene, "a frame needs a scene");
	const uint32_t limit_px =
			std::min(MAX_IMAGE_SIZE_PX, p_device.get_features().max_texture_size_px);
	const glm::uvec2 size_px = p_request.size_px;
	if (size_px.x < 1 || size_px.y < 1 || size_px.x > limit_px || size_px.y > limit_px) {
		fail("Size is ", size_px.x, "x", size_px.y, ", must be 1x1..", limit_px, "x", limit_px,
				". Choose another --size.");
	}
	if (p_request.antialiasing < 1 || p_request.antialiasing > MAX_ANTIALIASING) {
		fail("Antialiasing is ", p_request.antialiasing, ", must be 1..", MAX_ANTIALIASING,
				". Choose another --antialiasing.");
	}
	const uint32_t drawn_px = std::max(size_px.x, size_px.y) * p_request.antialiasing;
	if (drawn_px > limit_px) {
		fail("Size is ", size_px.x, "x", size_px.y, " with antialiasing ", p_request.antialiasing,
				", must be at most ", limit_px / p_request.antialiasing, "x",
				limit_px / p_request.antialiasing, ". Choose a smaller --size or --antialiasing.");
	}
}

/// Returns the supersampling factor along each axis. Masks alone and debug views have 1.
uint32_t get_supersampling_factor(const RenderRequest &p_request) {
	return p_request.mask_light.empty() && p_request.debug_view.empty() ? p_request.antialiasing
																		: 1;
}

/// Returns whether the light named for the debug view exists and casts a shadow.
bool has_debug_light(const RenderRequest &p_request) {
	const LightSnapshot *light = p_request.scene->find_light(p_request.debug_light);
	return light != nullptr && light->casts_shadow;
}

} // namespace

struct Renderer::Frame {
	const RenderRequest &request;
	RenderResult &result;
	RenderGraph graph;
	ShadowFrame shadows;
	LitImage image;
	std::vector<ShadowTechnique::DebugView> debug_views; // available ones, if one is requested
	bool has_debug_view = false;
	MaskReadback mask;
	std::vector<uint8_t> material_texels;

	Frame(Renderer &r_renderer, const RenderRequest &p_request, RenderResult &r_result) :
			request(p_request), result(r_result), graph(r_renderer.device, r_renderer.transients),
			shadows(r_renderer.shadows, graph, result.plan, request.scene,
					request.size_px * get_supersampling_factor(request),
					{ request.technique_override, request.may_skip, request.may_reuse,
							request.wants_explanation }),
			image{ graph, r_renderer.device, {}, shadows.get_constants(),
				request.size_px * get_supersampling_factor(request),
				get_supersampling_factor(request),
				compute_exposure(*request.scene, shadows.get_scene_bounds()) } {}

	/// Returns whether this light's debug view is shown. Its passes are then not skipped.
	bool shows_debug_view(const LightSnapshot &p_light) const {
		return !request.debug_view.empty() && !has_debug_view && p_light.casts_shadow &&
				(p_light.name == request.debug_light || !has_debug_light(request));
	}
};

std::vector<PassTiming> RenderResult::find_light_passes(const std::string &p_light) const {
	const std::string prefix = p_light + ": ";
	std::vector<PassTiming> passes;
	for (const PassTiming &timing : timings) {
		if (timing.name.starts_with(prefix)) {
			passes.push_back(timing);
			passes.back().name.erase(0, prefix.size());
		} else if (timing.name == DEFORM_PASS_NAME) { // each light needs it
			passes.push_back(timing);
		}
	}
	return passes;
}

Renderer::Renderer(RenderingDevice &p_device) :
		device(p_device), transients(p_device), shadows(p_device), materials(p_device) {}

Renderer::~Renderer() = default;

LightShadow Renderer::add_light(Frame &r_frame, const LightSnapshot &p_light) {
	const RenderRequest &request = r_frame.request;
	const bool is_shown = r_frame.shows_debug_view(p_light);
	r_frame.has_debug_view |= is_shown;
	const LightShadow shadow = r_frame.shadows.add_light(p_light, is_shown);
	if (is_shown) {
		r_frame.debug_views = shadow.debug_views;
		if (request.reference) {
			r_frame.debug_views.push_back(
					add_error_view(r_frame.image, shadow, *request.reference));
		}
	}
	return shadow;
}

void Renderer::add_mask_only(Frame &r_frame) {
	const RenderRequest &request = r_frame.request;
	for (const LightSnapshot &light : request.scene->lights) {
		if (light.name != request.mask_light) {
			continue;
		}
		const LightShadow shadow = add_light(r_frame, light);
		r_frame.graph.set_pass_prefix("");
		if (request.wants_mask) {
			r_frame.mask.add(r_frame.graph, shadow.mask, shadow.receivers);
			if (request.wants_surfaces) {
				const HostSurfaces &surfaces = r_frame.shadows.get_surfaces();
				add_readback(r_frame.graph, surfaces.depth, r_frame.result.depth_texels);
				add_readback(
						r_frame.graph, surfaces.geometric_normal, r_frame.result.normal_texels);
				add_readback(r_frame.graph, surfaces.material, r_frame.material_texels);
			}
		} else {
			// An empty pass whose read keeps the mask's passes from being culled.
			r_frame.graph.add_pass("mask").reads(shadow.mask, Access::SHADER_READ_COMPUTE).keep();
		}
		return;
	}
	fail("Light \"", request.mask_light, "\" is not in the scene. Choose one of its lights.");
}

void Renderer::add_image(Frame &r_frame) {
	RenderGraph &graph = r_frame.graph;
	const RenderRequest &request = r_frame.request;
	FramePlan &plan = r_frame.result.plan;
	const RGTexture radiance = add_ambient_pass(r_frame.image);
	plan.run("ambient");
	for (const LightSnapshot &light : request.scene->lights) {
		plan.set_light(light.name);
		const bool may_skip = request.may_skip && !r_frame.shows_debug_view(light);
		const std::string unlit = r_frame.shadows.describe_unlit(light);
		if (may_skip && !unlit.empty()) {
			plan.skip("light", unlit);
			continue;
		}
		if (may_skip && (light.intensity <= 0.0f || light.color == glm::vec3(0.0f))) {
			plan.skip("light", "its intensity is 0");
			continue;
		}
		add_lighting_pass(r_frame.image, add_light(r_frame, light), radiance);
		plan.run("lighting");
	}
	graph.set_pass_prefix("");
	plan.set_light("");
	for (const ShadowTechnique::DebugView &view : r_frame.debug_views) {
		r_frame.result.debug_views.push_back(view.id);
	}
	RGTexture image;
	if (const ShadowTechnique::DebugView *view = choose_debug_view(r_frame.debug_views,
				{ request.debug_view, request.needs_debug_view, request.reference != nullptr })) {
		image = add_debug_view_pass(r_frame.image, *view);
		plan.run("debug view");
	} else {
		image = add_tone_map_pass(r_frame.image, radiance);
		plan.run("tone map");
	}
	if (!request.overlay.empty()) {
		add_overlay(r_frame, image);
	}
	if (request.acquire_window_image) {
		add_present_pass(graph, image, request.acquire_window_image);
	}
	if (request.image_target) {
		const RGTexture target =
				graph.import_texture(request.image_target, RenderGraph::ImportedContent::NONE);
		graph.add_pass("copy image to target")
				.reads(image, Access::COPY_READ)
				.writes(target, Access::COPY_WRITE)
				.execute([=](PassContext &p_context) {
					p_context.commands.copy_texture(p_context.get(image), p_context.get(target));
				});
	}
	if (request.wants_image) {
		add_readback(graph, image, r_frame.result.image);
	} else if (!request.acquire_window_image && !request.image_target) {
		// Keeps the image's passes from being culled.
		graph.add_pass("image").reads(image, Access::COPY_READ).keep();
	}
}

void Renderer::add_overlay(Frame &r_frame, RGTexture p_target) {
	RasterPipelineDesc desc;
	desc.name = "overlay";
	desc.vertex_shader = "renderer/overlay.vert";
	desc.fragment_shader = "renderer/overlay.frag";
	desc.attributes = { { 0, 0, Format::R32_SFLOAT, 2, 0 },
		{ 1, 0, Format::R32_SFLOAT, 4, offsetof(OverlayVertex, color) } };
	desc.vertex_strides_bytes = { sizeof(OverlayVertex) };
	desc.color_formats = { Format::RGBA8_UNORM };
	desc.blend = BlendMode::ALPHA;
	desc.has_depth = false;
	desc.writes_depth = false;
	const PipelineRID pipeline = device.get_raster_pipeline(desc);
	const std::vector<OverlayVertex> &vertices = r_frame.request.overlay;
	const RGBuffer buffer = r_frame.graph.upload("overlay vertices", BufferUsage::VERTEX,
			{ reinterpret_cast<const uint8_t *>(vertices.data()),
					vertices.size() * sizeof(OverlayVertex) });
	const glm::vec2 scale = 2.0f / glm::vec2(r_frame.request.size_px); // clip space per pixel
	const uint32_t vertex_count = static_cast<uint32_t>(vertices.size());
	r_frame.graph.add_pass("overlay")
			.reads(buffer, Access::VERTEX_READ)
			.color(p_target, LoadOp::KEEP)
			.execute([=](PassContext &p_context) {
				const BufferRID buffers[] = { p_context.get(buffer) };
				p_context.commands.bind_pipeline(pipeline);
				p_context.commands.push_constants(glm::vec4(scale, 0.0f, 0.0f));
				p_context.commands.bind_vertex_buffers(buffers);
				p_context.commands.draw(vertex_count);
			});
}

RenderResult Renderer::render(const RenderRequest &p_request) {
	check_request(p_request, device);
	const SceneSnapshot &scene = *p_request.scene;
	RenderResult result;
	Frame frame(*this, p_request, result);
	const CommandCounts counts_before = device.get_command_counts();
	gbuffer_instances.update(scene, frame.shadows.list_visible(), frame.image.size_px);
	const GBuffer &gbuffer = frame.image.gbuffer = add_gbuffer_pass(frame.graph, device,
			shadows.get_meshes(), materials, gbuffer_instances, frame.image.frame);
	const size_t drawn_count = gbuffer_instances.instances.size();
	result.plan.run("G-buffer");
	if (drawn_count < scene.instances.size()) {
		result.plan.skip(text(scene.instances.size() - drawn_count, " instances"),
				"outside the camera's view");
	}
	frame.shadows.set_surfaces({ gbuffer.depth,
			p_request.has_depth_only ? RGTexture() : gbuffer.geometric_normal, gbuffer.material });
	if (p_request.mask_light.empty()) {
		add_image(frame);
	} else {
		add_mask_only(frame);
	}
	frame.graph.execute(p_request.mode);
	frame.shadows.end();
	materials.collect_garbage();
	result.plan.set_light("");
	for (const std::string &pass : frame.graph.get_culled_passes()) {
		result.plan.skip(pass, "nothing uses its result");
	}
	result.timings = frame.graph.get_timings();
	for (const PassTiming &timing : result.timings) {
		result.gpu_ms += timing.gpu_ms;
	}
	result.commands = device.get_command_counts() - counts_before;
	result.wall_ms = frame.graph.get_wall_ms();
	result.dot = p_request.wants_graph ? frame.graph.to_dot() : std::string();
	result.unaliased_bytes = frame.graph.get_unaliased_bytes();
	result.aliased_bytes = frame.graph.get_aliased_bytes();
	if (!result.depth_texels.empty()) {
		result.surfaces =
				read_surfaces(compute_frame_constants(scene, p_request.size_px), p_request.size_px,
						{ result.depth_texels.data(), result.normal_texels.data(),
								frame.material_texels.data() });
	}
	result.counters = shadows.get_counters(p_request.mask_light);
	if (p_request.wants_mask && !p_request.mask_light.empty()) {
		result.standard_error = shadows.get_standard_error(p_request.mask_light);
		static_cast<MaskValues &>(result) = frame.mask.get_values();
	}
	return result;
}

} // namespace gnomon
