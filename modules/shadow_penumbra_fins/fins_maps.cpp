#include "modules/shadow_penumbra_fins/fins_maps.h"

#include "modules/core/error.h"

namespace gnomon {

bool FinsMaps::prepare(RenderingDevice &p_device, const std::string &p_light, glm::uvec2 p_size_px,
		uint32_t p_view_count, uint32_t p_layer_count, bool p_has_fins) {
	forget_frame();
	const TextureDesc desc = { "depth layer of " + p_light, Format::D32_SFLOAT, p_size_px,
		p_view_count,
		TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED | TextureUsage::COPY_TARGET, true };
	has_content = layers.size() == p_layer_count && layer_desc == desc &&
			bool(color) == p_has_fins && bool(penumbra_depth) == p_has_fins;
	if (has_content) {
		return true;
	}
	reset();
	layer_desc = desc;
	for (uint32_t layer = 0; layer < p_layer_count; ++layer) {
		layers.emplace_back(p_device, p_device.create_texture(desc));
	}
	if (p_has_fins) {
		color = OwnedTexture(p_device,
				p_device.create_texture({ "penumbra color of " + p_light, Format::RG16_SFLOAT,
						p_size_px, p_view_count,
						TextureUsage::COLOR_ATTACHMENT | TextureUsage::SAMPLED, true }));
		penumbra_depth = OwnedTexture(p_device,
				p_device.create_texture({ "penumbra depth of " + p_light, Format::D32_SFLOAT,
						p_size_px, p_view_count,
						TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED, true }));
	}
	return false;
}

void FinsMaps::reset() {
	layers.clear();
	color.reset();
	penumbra_depth.reset();
}

void FinsMaps::import(RenderGraph &r_graph) {
	if (is_imported()) {
		return;
	}
	GNOMON_ASSERT(!layers.empty(), "the maps were not prepared");
	const auto import_one = [&](const OwnedTexture &p_texture) {
		return r_graph.import_texture(p_texture.get(),
				has_content ? RenderGraph::ImportedContent::PRESERVED
							: RenderGraph::ImportedContent::NONE);
	};
	for (const OwnedTexture &layer : layers) {
		frame_layers.push_back(import_one(layer));
	}
	if (color) {
		frame_color = import_one(color);
		frame_penumbra_depth = import_one(penumbra_depth);
	}
}

void FinsMaps::forget_frame() {
	frame_layers.clear();
	frame_color = {};
	frame_penumbra_depth = {};
}

FinTargets FinsMaps::get_targets() const {
	return { frame_color, frame_penumbra_depth, frame_layers[0],
		frame_layers.size() > 1 ? frame_layers[1] : RGTexture() };
}

RGTexture FinsMaps::get_layer_3() const {
	return frame_layers.size() > 2 ? frame_layers[2] : frame_layers[0];
}

} // namespace gnomon
