#include "modules/renderer/renderer.h"

#include "modules/core/error.h"
#include "modules/renderer/gbuffer.h"
#include "modules/renderer/lighting.h"
#include "modules/renderer/mask_texels.h"

namespace gnomon {

namespace {

constexpr uint32_t MAX_SIZE_PX = 16384;

void check_request(const RenderRequest &p_request, const RenderingDevice &p_device) {
	GNOMON_ASSERT(p_request.scene, "a frame needs a scene");
	const uint32_t limit_px = std::min(MAX_SIZE_PX, p_device.get_features().max_texture_size_px);
	const glm::uvec2 size_px = p_request.size_px;
	if (size_px.x < 1 || size_px.y < 1 || size_px.x > limit_px || size_px.y > limit_px) {
		fail("Size is ", size_px.x, "x", size_px.y, ", must be 1x1..", limit_px, "x", limit_px,
				". Choose another --size.");
	}
	if (!p_request.technique_override.empty()) {
		ShadowRegistry::get(p_request.technique_override);
	}
}

/// True when the request names a light whose technique can be looked at.
bool has_debug_light(const RenderRequest &p_request) {
	const LightSnapshot *light = p_request.scene->find_light(p_request.debug_light);
	return light != nullptr && light->casts_shadow;
}

/// Why a light that reaches no receiver changes nothing.
std::string describe_unlit(const LightSnapshot &p_light) {
	return text("the camera sees no surface",
			p_light.type == LightType::SPOT			  ? " in its cone and range"
					: p_light.type == LightType::OMNI ? " in its range"
													  : "");
}

} // namespace

struct Renderer::Frame {
	const RenderRequest &request;
	RenderResult &result;
	RenderGraph graph;
	RGBuffer constants;
	GBuffer gbuffer;
	VisibleReceivers receivers;							 // of any light
	std::vector<ShadowTechnique::DebugView> debug_views; // those there are, when one is asked for
	bool has_asked_for_debug_view = false;
	std::vector<uint8_t> mask_bytes;
	std::vector<uint8_t> receiver_bytes;
	std::vector<uint8_t> depth_bytes;
	std::vector<uint8_t> normal_bytes;
	std::vector<uint8_t> material_bytes;
	Format mask_format = Format::R16_SFLOAT;

	/// The light whose intermediate images are shown: nothing of it is left out.
	bool asks_for_debug_view(const LightSnapshot &p_light) const {
		return !request.debug_view.empty() && !has_asked_for_debug_view && p_light.casts_shadow &&
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
		}
	}
	return passes;
}

Renderer::Renderer(RenderingDevice &p_device) :
		device(p_device), transients(p_device), meshes(p_device), shadows(p_device, meshes) {}

Renderer::~Renderer() = default;

void Renderer::add_readback(Frame &r_frame, RGTexture p_texture, std::vector<uint8_t> &r_bytes) {
	const TextureDesc desc = r_frame.graph.get_desc(p_texture);
	const uint64_t size_bytes =
			uint64_t(desc.size_px.x) * desc.size_px.y * get_texel_size_bytes(desc.format);
	const RGBuffer buffer = r_frame.graph.create_buffer({ desc.name + " readback", size_bytes,
			BufferUsage::COPY_TARGET, MemoryKind::READBACK });
	r_frame.graph.add_pass("read back " + desc.name)
			.reads(p_texture, Access::COPY_READ)
			.writes(buffer, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.copy_texture_to_buffer(
						p_context.get(p_texture), p_context.get(buffer));
			});
	r_frame.graph.add_pass("copy " + desc.name)
			.reads(buffer, Access::HOST_READ)
			.keep()
			.execute_on_host([=, &r_bytes](HostContext &p_context) {
				const uint8_t *mapped = p_context.get_mapped(buffer);
				r_bytes.assign(mapped, mapped + size_bytes);
			});
}

RGTexture Renderer::add_light(Frame &r_frame, const LightSnapshot &p_light, RGTexture &r_receivers,
		RGBuffer &r_light_constants) {
	RenderGraph &graph = r_frame.graph;
	const RenderRequest &request = r_frame.request;
	FramePlan &plan = r_frame.result.plan;
	graph.set_pass_prefix(p_light.name + ": ");
	plan.set_light(p_light.name);
	r_light_constants = graph.upload_constants(
			"light constants", compute_light_constants(p_light, request.scene->camera));
	r_receivers = add_receivers_pass(
			graph, device, r_frame.gbuffer, r_frame.constants, r_light_constants, request.size_px);
	plan.run("receivers");
	RGTexture mask;
	const bool asks = r_frame.asks_for_debug_view(p_light);
	const VisibleReceivers lit = find_lit_receivers(p_light, r_frame.receivers);
	if (!p_light.casts_shadow) {
		plan.leave_out("shadow", "shadow_enabled is false");
		mask = add_constant_mask(graph, request.size_px, 1.0f);
	} else if (request.may_leave_out && lit.list.empty() && !asks) {
		plan.leave_out("shadow", describe_unlit(p_light));
		mask = add_constant_mask(graph, request.size_px, 1.0f);
	} else {
		r_frame.has_asked_for_debug_view |= asks;
		mask = shadows.add_passes(graph,
				{ *request.scene, p_light, r_frame.gbuffer, r_receivers, r_frame.constants,
						r_light_constants, request.size_px, request.technique_override,
						request.may_leave_out, request.may_keep, asks, lit },
				plan, r_frame.debug_views);
		if (asks && request.truth) {
			r_frame.debug_views.push_back(add_error_view(
					graph, device, r_receivers, mask, *request.truth, request.size_px));
		}
	}
	return mask;
}

void Renderer::add_mask_only(Frame &r_frame) {
	const RenderRequest &request = r_frame.request;
	for (const LightSnapshot &light : request.scene->lights) {
		if (light.name != request.mask_light) {
			continue;
		}
		RGTexture receivers;
		RGBuffer constants;
		const RGTexture mask = add_light(r_frame, light, receivers, constants);
		r_frame.graph.set_pass_prefix("");
		r_frame.mask_format = r_frame.graph.get_desc(mask).format;
		if (request.wants_mask) {
			add_readback(r_frame, mask, r_frame.mask_bytes);
			add_readback(r_frame, receivers, r_frame.receiver_bytes);
			if (request.wants_surfaces) {
				add_readback(r_frame, r_frame.gbuffer.depth, r_frame.depth_bytes);
				add_readback(r_frame, r_frame.gbuffer.geometric_normal, r_frame.normal_bytes);
				add_readback(r_frame, r_frame.gbuffer.material, r_frame.material_bytes);
			}
		} else {
			r_frame.graph.add_pass("mask").reads(mask, Access::SHADER_READ_COMPUTE).keep();
		}
		return;
	}
	fail("Light \"", request.mask_light, "\" is not in the scene.");
}

void Renderer::add_picture(Frame &r_frame) {
	RenderGraph &graph = r_frame.graph;
	const RenderRequest &request = r_frame.request;
	FramePlan &plan = r_frame.result.plan;
	const RGTexture radiance =
			add_ambient_pass(graph, device, r_frame.gbuffer, r_frame.constants, request.size_px);
	plan.run("ambient");
	for (const LightSnapshot &light : request.scene->lights) {
		plan.set_light(light.name);
		const bool may_leave_out = request.may_leave_out && !r_frame.asks_for_debug_view(light);
		if (may_leave_out && find_lit_receivers(light, r_frame.receivers).list.empty()) {
			plan.leave_out("light", describe_unlit(light));
			continue;
		}
		if (may_leave_out && (light.intensity <= 0.0f || light.color == glm::vec3(0.0f))) {
			plan.leave_out("light", "its intensity is 0");
			continue;
		}
		RGTexture receivers;
		RGBuffer constants;
		const RGTexture mask = add_light(r_frame, light, receivers, constants);
		add_lighting_pass(graph, device, r_frame.gbuffer, r_frame.constants, constants, receivers,
				mask, radiance, request.size_px);
		plan.run("lighting");
	}
	graph.set_pass_prefix("");
	plan.set_light("");
	for (const ShadowTechnique::DebugView &view : r_frame.debug_views) {
		r_frame.result.debug_views.push_back(view.id);
	}
	RGTexture picture;
	if (const ShadowTechnique::DebugView *view = choose_debug_view(r_frame.debug_views,
				{ request.debug_view, request.needs_debug_view, request.truth != nullptr })) {
		picture = add_debug_view_pass(graph, device, r_frame.constants, *view, request.size_px);
		plan.run("debug view");
	} else {
		picture = add_tone_map_pass(graph, device, r_frame.constants, radiance, request.size_px);
		plan.run("tone map");
	}
	if (!request.overlay.empty()) {
		add_overlay(r_frame, picture);
	}
	if (request.acquire_window_image) {
		const RGTexture shown = graph.import_window_image(request.acquire_window_image);
		graph.add_pass("present")
				.reads(picture, Access::COPY_READ)
				.writes(shown, Access::COPY_WRITE)
				.execute([=](PassContext &p_context) {
					p_context.commands.blit_texture(p_context.get(picture), p_context.get(shown));
				});
	}
	if (request.picture_target) {
		const RGTexture target =
				graph.import_texture(request.picture_target, RenderGraph::ImportedContent::NONE);
		graph.add_pass("copy picture to target")
				.reads(picture, Access::COPY_READ)
				.writes(target, Access::COPY_WRITE)
				.execute([=](PassContext &p_context) {
					p_context.commands.copy_texture(p_context.get(picture), p_context.get(target));
				});
	}
	if (request.wants_image) {
		add_readback(r_frame, picture, r_frame.result.image);
	} else if (!request.acquire_window_image && !request.picture_target) {
		graph.add_pass("picture").reads(picture, Access::COPY_READ).keep();
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
	const glm::vec2 scale = 2.0f / glm::vec2(r_frame.request.size_px);
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
	shadows.collect_garbage(scene);
	Frame frame{ p_request, result, RenderGraph(device, transients), {}, {}, {}, {}, false, {}, {},
		{}, {}, {}, Format::R16_SFLOAT };
	frame.receivers =
			find_visible_receivers(scene, make_camera_view(scene.camera, p_request.size_px));
	frame.constants = frame.graph.upload_constants(
			"frame constants", compute_frame_constants(scene, p_request.size_px));
	const CommandCounts counts_before = device.get_command_counts();
	try {
		uint32_t drawn_count = 0;
		frame.gbuffer = add_gbuffer_pass(frame.graph, device, meshes, scene, p_request.size_px,
				frame.constants, drawn_count);
		result.plan.run("G-buffer");
		if (drawn_count < scene.instances.size()) {
			result.plan.leave_out(text(scene.instances.size() - drawn_count, " instances"),
					"outside the camera's view");
		}
		if (p_request.mask_light.empty()) {
			add_picture(frame);
		} else {
			add_mask_only(frame);
		}
		frame.graph.execute(p_request.mode);
	} catch (...) {
		shadows.drop_techniques(); // they may count on passes that never ran
		throw;
	}
	result.plan.set_light("");
	for (const std::string &pass : frame.graph.get_culled_passes()) {
		result.plan.leave_out(pass, "nothing uses its result");
	}
	result.timings = frame.graph.get_timings();
	for (const PassTiming &timing : result.timings) {
		result.gpu_ms += timing.gpu_ms;
	}
	result.commands = device.get_command_counts() - counts_before;
	result.wall_ms = frame.graph.get_wall_ms();
	result.dot = frame.graph.to_dot();
	result.unaliased_bytes = frame.graph.get_unaliased_bytes();
	result.aliased_bytes = frame.graph.get_aliased_bytes();
	if (!frame.depth_bytes.empty()) {
		result.surfaces =
				read_surfaces(compute_frame_constants(scene, p_request.size_px), p_request.size_px,
						{ frame.depth_bytes.data(), frame.normal_bytes.data(),
								frame.material_bytes.data() });
	}
	if (!frame.mask_bytes.empty()) {
		result.standard_error = shadows.get_standard_error(p_request.mask_light);
		const size_t pixel_count = size_t(p_request.size_px.x) * p_request.size_px.y;
		result.colors = read_mask_colors(frame.mask_bytes, frame.mask_format, pixel_count);
		for (const glm::vec3 &color : result.colors) {
			result.visibility.push_back(compute_mask_luminance(color));
		}
		if (result.colors.empty()) {
			result.visibility = read_mask(frame.mask_bytes, frame.mask_format, pixel_count);
		}
		result.receiver.resize(pixel_count);
		for (size_t index = 0; index < pixel_count; ++index) {
			result.receiver[index] = frame.receiver_bytes[index] != 0 ? 1.0f : 0.0f;
			if (result.receiver[index] == 0.0f) {
				result.visibility[index] = 0.0f;
				if (!result.colors.empty()) {
					result.colors[index] = glm::vec3(0.0f);
				}
			}
		}
	}
	meshes.collect_garbage();
	return result;
}

} // namespace gnomon
