#include "modules/godot_addon/view_shadows.h"

#include "modules/core/error.h"
#include "modules/render_graph/compute_pass.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/shadow_frame.h"

#include "godot_addon/godot_addon_shared.h"

#include <cmath>

namespace gnomon {

namespace {

/// Of the projection's elements: what rounding may leave of a 0 or of a ratio of 1.
const float PROJECTION_ROUNDING = 1e-5f;

RasterPipelineDesc make_depth_pipeline() {
	RasterPipelineDesc desc;
	desc.name = "depth of Godot";
	desc.vertex_shader = "shadows/screen.vert";
	desc.fragment_shader = "godot_addon/convert_depth.frag";
	desc.depth_compare = CompareOp::ALWAYS;
	return desc;
}

RasterPipelineDesc make_show_pipeline() {
	RasterPipelineDesc desc;
	desc.name = "show mask";
	desc.vertex_shader = "shadows/screen.vert";
	desc.fragment_shader = "godot_addon/show_mask.frag";
	desc.color_formats = { Format::RGBA16_SFLOAT };
	return desc;
}

std::string find_refusal(
		const glm::mat4 &p_projection, glm::uvec2 p_size_px, int64_t p_view_count) {
	if (p_view_count > 1) {
		return "has several views at once (XR)";
	}
	if (p_projection[3][3] != 0.0f) {
		return "has an orthogonal projection";
	}
	// Antialiasing over time shifts by less than a pixel.
	if (std::abs(p_projection[2][0]) * float(p_size_px.x) > 2.0f ||
			std::abs(p_projection[2][1]) * float(p_size_px.y) > 2.0f) {
		return "has a projection that is not centred";
	}
	const float aspect = float(p_size_px.x) / float(p_size_px.y);
	const float ratio = std::abs(p_projection[1][1] / p_projection[0][0]) / aspect;
	if (!(std::abs(ratio - 1.0f) < 0.01f)) {
		return "has pixels that are not square";
	}
	return {};
}

} // namespace

GodotView read_view(const godot::RenderData &p_data, const godot::RenderSceneBuffersRD &p_buffers) {
	const godot::RenderSceneData data = p_data.get_render_scene_data();
	GodotView view;
	view.size_px = glm::uvec2(p_buffers.get_internal_size());
	view.depth = p_buffers.get_depth_texture(false);
	view.color = p_buffers.get_color_texture(false);
	view.camera_transform = data.get_cam_transform();
	const glm::mat4 projection = data.get_cam_projection();
	view.refusal = find_refusal(projection, view.size_px, p_buffers.get_view_count());
	if (view.refusal.empty()) {
		const glm::dmat4 world_from_camera = view.camera_transform.to_matrix();
		view.camera.name = "Camera";
		view.camera.position_world = glm::dvec3(world_from_camera[3]);
		view.camera.world_from_camera =
				compute_orientation(world_from_camera, "Camera", view.camera.name);
		view.camera.vertical_fov_rad =
				static_cast<float>(2.0 * std::atan(1.0 / std::abs(double(projection[1][1]))));
		view.depth_offset = projection[2][2];
		view.camera.near_m = projection[3][2] / (1.0f + projection[2][2]);
	}
	return view;
}

TextureRID ImportedTexture::get(
		GodotDevice &r_device, godot::RID p_texture, const TextureDesc &p_desc) {
	if (p_texture != source) {
		free(r_device);
		imported = r_device.import_texture(p_texture, p_desc);
		source = p_texture;
	}
	return imported;
}

void ImportedTexture::free(GodotDevice &r_device) {
	if (source) {
		r_device.free(imported);
		source = {};
	}
}

ViewShadows::ViewShadows(GodotDevice &p_device, std::shared_ptr<MeshStore> p_meshes) :
		device(p_device), transients(p_device), shadows(p_device, std::move(p_meshes)) {}

ViewShadows::~ViewShadows() {
	depth.free(device);
	color.free(device);
}

RGTexture ViewShadows::add_depth_pass(RenderGraph &r_graph, const GodotView &p_view) {
	// Godot's own format differs; shaders read the same number from each.
	const TextureRID source = depth.get(device, p_view.depth,
			{ "depth of Godot", Format::D32_SFLOAT, p_view.size_px, 1, TextureUsage::SAMPLED });
	const RGTexture read = r_graph.import_texture(source, RenderGraph::ImportedContent::KEPT);
	const RGTexture converted = r_graph.create_texture({ "depth", Format::D32_SFLOAT,
			p_view.size_px, 1, TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED });
	const PipelineRID pipeline = device.get_raster_pipeline(make_depth_pipeline());
	shader::ConvertDepthPush push = {};
	push.offset = p_view.depth_offset;
	r_graph.add_pass("convert depth")
			.reads(read, Access::SHADER_READ_FRAGMENT)
			.depth(converted, LoadOp::CLEAR, 0.0f)
			.execute([=](PassContext &p_context) {
				p_context.commands.bind_pipeline(pipeline);
				p_context.commands.bind_resources(
						{ { CONVERT_BINDING_DEPTH, p_context.get(read) } });
				p_context.commands.push_constants(push);
				p_context.commands.draw(3);
			});
	return converted;
}

void ViewShadows::prepare_masks(glm::uvec2 p_size_px, uint32_t p_count) {
	if (masks) {
		const TextureDesc &desc = device.get_desc(masks.get());
		if (desc.size_px == p_size_px && desc.layer_count == p_count) {
			return;
		}
	}
	masks = OwnedTexture(device,
			device.create_texture({ "Gnomon's masks", Format::R16_SFLOAT, p_size_px, p_count,
					TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE,
					true }));
}

void ViewShadows::make_masks(const ScenarioFrame &p_frame, const GodotView &p_view) {
	layers.clear();
	const uint32_t count = static_cast<uint32_t>(p_frame.scene->lights.size());
	prepare_masks(p_view.size_px, count);
	auto scene = std::make_shared<SceneSnapshot>(*p_frame.scene);
	scene->camera = p_view.camera;
	RenderGraph graph(device, transients);
	FramePlan plan;
	ShadowFrame frame(shadows, graph, plan, scene, p_view.size_px);
	HostSurfaces surfaces;
	surfaces.depth = add_depth_pass(graph, p_view);
	frame.set_surfaces(surfaces);
	const RGTexture held = graph.import_texture(masks.get(), RenderGraph::ImportedContent::NONE);
	std::map<std::string, MaskReadback> reads;
	for (uint32_t layer = 0; layer < count; ++layer) {
		const LightSnapshot &light = scene->lights[layer];
		const LightShadow shadow = frame.add_light(light);
		frame.hold(shadow, held, layer);
		for (const std::shared_ptr<MaskRequest> &request : p_frame.requests) {
			if (request->light == light.name) {
				reads[light.name].add(graph, shadow.mask, shadow.receivers);
			}
		}
	}
	graph.execute(reads.empty() ? RenderGraph::Mode::QUEUE : RenderGraph::Mode::WAIT);
	frame.end();
	for (uint32_t layer = 0; layer < count; ++layer) {
		layers[scene->lights[layer].name] = layer;
	}
	for (const std::shared_ptr<MaskRequest> &request : p_frame.requests) {
		const auto read = reads.find(request->light);
		if (read == reads.end()) {
			continue;
		}
		const MaskValues values = read->second.get_values();
		ReadMask mask = { p_view.size_px, values.visibility, p_view.camera_transform };
		for (size_t pixel = 0; pixel < mask.visibility.size(); ++pixel) {
			mask.visibility[pixel] = values.receiver[pixel] > 0 ? mask.visibility[pixel] : -1.0f;
		}
		const std::lock_guard lock(request->mutex);
		request->masks.push_back(std::move(mask));
	}
}

void ViewShadows::show_masks(const ScenarioFrame &p_frame, const GodotView &p_view) {
	if (!masks || device.get_desc(masks.get()).size_px != p_view.size_px) {
		return;
	}
	RenderGraph graph(device, transients);
	const RGTexture target =
			graph.import_texture(color.get(device, p_view.color,
										 { "image of Godot", Format::RGBA16_SFLOAT, p_view.size_px,
												 1, TextureUsage::COLOR_ATTACHMENT }),
					RenderGraph::ImportedContent::KEPT);
	const RGTexture held = graph.import_texture(masks.get(), RenderGraph::ImportedContent::KEPT);
	const PipelineRID pipeline = device.get_raster_pipeline(make_show_pipeline());
	for (const std::string &light : p_frame.shown_lights) {
		const auto layer = layers.find(light);
		if (layer == layers.end()) {
			continue;
		}
		shader::ShowMaskPush push = {};
		push.layer = layer->second;
		graph.add_pass("show mask")
				.reads(held, Access::SHADER_READ_FRAGMENT)
				.color(target, LoadOp::KEEP)
				.keep()
				.execute([=](PassContext &p_context) {
					p_context.commands.bind_pipeline(pipeline);
					p_context.commands.bind_resources(
							{ { SHOW_BINDING_MASKS, p_context.get(held) } });
					p_context.commands.push_constants(push);
					p_context.commands.draw(3);
				});
	}
	graph.execute(RenderGraph::Mode::QUEUE);
}

} // namespace gnomon
