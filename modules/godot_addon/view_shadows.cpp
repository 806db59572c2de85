#include "modules/godot_addon/view_shadows.h"

#include "modules/core/error.h"
#include "modules/godot_addon/scaled_masks.h"
#include "modules/render_graph/compute_pass.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/shadow_frame.h"

#include "godot_addon/godot_addon_shared.h"
#include "shared/frame_shared.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const float NO_RECEIVER = -1.0f; // as gnomon.gdshaderinc expects

RasterPipelineDesc make_show_pipeline() {
	RasterPipelineDesc desc;
	desc.name = "show mask";
	desc.vertex_shader = "shadows/screen.vert";
	desc.fragment_shader = "godot_addon/show_mask.frag";
	desc.color_formats = { Format::RGBA16_SFLOAT };
	return desc;
}

/// Whether the light's shadow ends nearer to the camera than the light is (distance_fade_shadow).
bool is_faded_out(const ScenarioFrame &p_frame, uint32_t p_layer, const GodotView &p_view) {
	return std::any_of(p_frame.receiver_lights.begin(), p_frame.receiver_lights.end(),
			[&](const ReceiverLight &p_light) {
				return p_light.mask == int32_t(p_layer) && !p_light.is_directional &&
						compute_shadow_fade(p_light, p_view.camera.position_world) <= 0;
			});
}

} // namespace

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

ViewShadows::ViewShadows(
		GodotDevice &p_device, std::shared_ptr<MeshStore> p_meshes, ReceiverTextures &p_receivers) :
		device(p_device),
		receivers(p_receivers), transients(p_device), shadows(p_device, std::move(p_meshes)) {}

ViewShadows::~ViewShadows() {
	depth.free(device);
	color.free(device);
}

void ViewShadows::make_masks(const ScenarioFrame &p_frame, const GodotView &p_view,
		std::optional<uint32_t> p_compile_only) {
	layers.clear();
	receivers.write_lights(p_view, p_frame);
	const uint32_t count = static_cast<uint32_t>(p_frame.scene->lights.size());
	if (count == 0) {
		return;
	}
	if (glm::any(glm::greaterThan(p_view.size_px, receivers.get_size_px()))) {
		fail("A view has ", p_view.size_px.x, "x", p_view.size_px.y, " pixels, but the masks ",
				"were allocated for at most ", receivers.get_size_px().x, "x",
				receivers.get_size_px().y, ". It has no shadow masks in this frame.");
	}
	const bool publishes_depth = p_view.has_depth_samples() || p_frame.has_faded;
	if (publishes_depth && !receivers.get_depth()) {
		fail("A view is multisampled, but was not when this frame began. It has no shadow masks in "
			 "this frame. Set the viewport's msaa_3d.");
	}
	const ViewDetail detail = find_view_detail(p_frame, p_view);
	auto scene = std::make_shared<SceneSnapshot>(*p_frame.scene);
	scene->camera = p_view.camera;
	for (const auto &[index, instance] : detail.billboards) {
		scene->instances.edit(index) = instance;
	}
	for (const size_t hidden : detail.hidden_instances) {
		scene->instances.edit(hidden).casts_shadow = false;
	}
	RenderGraph graph(device, transients);
	FramePlan plan;
	// Created first, because it deforms the meshes whose depth is drawn below.
	ShadowFrame frame(shadows, graph, plan, scene,
			ScaledMasks::compute_size(p_view.size_px, p_frame.mask_scale));
	// Godot's actual format differs, but shaders read the same values.
	const RGTexture drawn_depth =
			graph.import_texture(depth.get(device, p_view.depth,
										 { "depth of Godot", Format::D32_SFLOAT, p_view.size_px, 1,
												 TextureUsage::SAMPLED }),
					RenderGraph::ImportedContent::PRESERVED);
	const RGTexture published_depth = publishes_depth
			? graph.import_texture(receivers.get_depth(), RenderGraph::ImportedContent::NONE)
			: RGTexture();
	const RGTexture full_depth = add_view_depth(graph, shadows.get_meshes(), p_view, drawn_depth,
			std::make_shared<const ReducedInstances>(
					find_reduced_instances(p_frame, *scene, p_view, detail)),
			published_depth);
	ScaledMasks scaled(graph, device, full_depth, p_frame.mask_scale, count);
	HostSurfaces surfaces;
	surfaces.depth = scaled.get_depth();
	frame.set_surfaces(surfaces);
	const RGTexture mask_texture =
			graph.import_texture(receivers.get_masks(), RenderGraph::ImportedContent::NONE);
	const RGTexture target = scaled.create_target(mask_texture);
	std::map<std::string, MaskReadback> reads;
	for (uint32_t layer = 0; layer < count; ++layer) {
		const LightSnapshot &light = scene->lights[layer];
		if (is_faded_out(p_frame, layer, p_view)) {
			continue;
		}
		const LightShadow shadow = frame.add_light(light);
		frame.hold(shadow, target, layer, NO_RECEIVER);
		for (const std::shared_ptr<MaskRequest> &request : p_frame.requests) {
			if (request->light == light.name) {
				reads[light.name].add(graph, shadow.mask, shadow.receivers);
			}
		}
	}
	scaled.write(mask_texture);
	device.compile_only(p_compile_only);
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
		ReadMask mask = { scaled.get_size_px(), values.visibility, p_view.camera_transform };
		for (size_t pixel = 0; pixel < mask.visibility.size(); ++pixel) {
			if (values.receiver[pixel] < RECEIVER_NEAR_SIDE) {
				mask.visibility[pixel] = NO_RECEIVER;
			}
		}
		const std::lock_guard lock(request->mutex);
		request->masks.push_back(std::move(mask));
	}
}

void ViewShadows::show_masks(const ScenarioFrame &p_frame, const GodotView &p_view) {
	if (layers.empty()) {
		return;
	}
	RenderGraph graph(device, transients);
	const RGTexture target =
			graph.import_texture(color.get(device, p_view.color,
										 { "image of Godot", Format::RGBA16_SFLOAT, p_view.size_px,
												 1, TextureUsage::COLOR_ATTACHMENT }),
					RenderGraph::ImportedContent::PRESERVED);
	const RGTexture mask_texture =
			graph.import_texture(receivers.get_masks(), RenderGraph::ImportedContent::PRESERVED);
	const PipelineRID pipeline = device.get_raster_pipeline(make_show_pipeline());
	for (const std::string &light : p_frame.shown_lights) {
		const auto layer = layers.find(light);
		if (layer == layers.end()) {
			continue;
		}
		shader::ShowMaskPush push = {};
		push.layer = layer->second;
		graph.add_pass("show mask")
				.reads(mask_texture, Access::SHADER_READ_FRAGMENT)
				.color(target, LoadOp::KEEP)
				.keep()
				.execute([=](PassContext &p_context) {
					p_context.commands.bind_pipeline(pipeline);
					p_context.commands.bind_resources(
							{ { SHOW_BINDING_MASKS, p_context.get(mask_texture) } });
					p_context.commands.push_constants(push);
					p_context.commands.draw(3);
				});
	}
	graph.execute(RenderGraph::Mode::QUEUE);
}

} // namespace gnomon
