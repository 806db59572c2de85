#pragma once

#include "modules/render_graph/render_graph.h"

#include <functional>
#include <vector>

struct ImDrawData;

namespace gnomon {

/// Renders Dear ImGui's draw data with the engine's own device.
class UiRenderer {
public:
	/// Uploads the fonts of the current ImGui context, which must exist.
	explicit UiRenderer(RenderingDevice &p_device);

	using GetTexture = std::function<TextureRID()>;
	/// Registers a texture for ImGui::Image in this frame: RGBA8_UNORM, SAMPLED. It is fetched when
	/// drawn, so that an image can show what the panels have just changed; an empty one is not
	/// drawn. Returns its ImTextureID.
	void *add_texture(GetTexture p_get_texture);
	/// Draws over a target of the display's size. Ends this frame's textures.
	void add_pass(RenderGraph &r_graph, RGTexture p_target, const ImDrawData &p_data);

private:
	RenderingDevice &device;
	OwnedTexture font;
	OwnedSampler sampler;
	std::vector<GetTexture> textures; // by ImTextureID - 1; the first is the font's
};

} // namespace gnomon
