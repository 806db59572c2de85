#pragma once

#include "modules/rendering_device/rendering_device.h"
#include "modules/shadow_penumbra_fins/fin_passes.h"
#include "modules/shadows/shadow_technique.h"

#include <string>
#include <vector>

namespace gnomon {

/// The textures of one light, cached from frame to frame: depth layers and penumbra maps, each a
/// texture array with one array layer per light view.
class FinsMaps {
public:
	/// Creates the textures that are needed and missing, and frees the others. Returns false when
	/// the textures are new and hold nothing from earlier frames.
	bool prepare(RenderingDevice &p_device, const std::string &p_light, glm::uvec2 p_size_px,
			uint32_t p_view_count, uint32_t p_layer_count, bool p_has_fins);
	void reset();

	/// This frame's handles, imported on first use.
	void import(RenderGraph &r_graph);
	bool is_imported() const { return !frame_layers.empty(); }
	void forget_frame();
	const std::vector<RGTexture> &get_layers() const { return frame_layers; }
	/// layer_2 is empty when it was not peeled.
	FinTargets get_targets() const;
	/// The third depth layer. When it was not peeled: the first, only to fill the binding.
	RGTexture get_layer_3() const;

private:
	std::vector<OwnedTexture> layers;
	OwnedTexture color;
	OwnedTexture penumbra_depth;
	TextureDesc layer_desc;
	bool has_content = false;
	std::vector<RGTexture> frame_layers;
	RGTexture frame_color;
	RGTexture frame_penumbra_depth;
};

} // namespace gnomon
