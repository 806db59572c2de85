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
	/// Recreates all textures unless they match the parameters already. Returns true when they
	/// match and hold the content of earlier frames. p_light: the light's name, for the textures'
	/// names. p_size_px: texels of one view. p_has_fins: whether penumbra maps are needed.
	bool prepare(RenderingDevice &p_device, const std::string &p_light, glm::uvec2 p_size_px,
			uint32_t p_view_count, uint32_t p_layer_count, bool p_has_fins);
	/// Frees the textures.
	void reset();

	/// Imports the textures into this frame's graph, unless that was done already.
	void import(RenderGraph &r_graph);
	bool is_imported() const { return !frame_layers.empty(); }
	/// Drops this frame's handles.
	void forget_frame();
	const std::vector<RGTexture> &get_layers() const { return frame_layers; }
	/// Returns this frame's handles; layer_2 is null when it was not peeled.
	FinTargets get_targets() const;
	/// Returns the third depth layer. When it was not peeled, returns the first one, which then
	/// only fills the binding.
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
