#pragma once

#include "modules/render_graph/render_graph.h"

#include <functional>
#include <vector>

struct ImDrawData;

namespace gnomon {

/// Draws what Dear ImGui describes, with the engine's own device.
class UiRenderer {
public:
	/// Takes the fonts of the current ImGui context, which must be there.
	explicit UiRenderer(RenderingDevice &p_device);

	using GetTexture = std::function<TextureRID()>;
	/// A texture that ImGui::Image may show this frame: RGBA8_UNORM, SAMPLED. It is fetched when
	/// it is drawn, so that an image may show what the panels have just changed; an empty one is
	/// not shown. Returns its ImTextureID.
	void *add_texture(GetTexture p_get_texture);
	/// Draws into a target of the display's size, over what is there. Ends this frame's textures.
	void add_pass(RenderGraph &r_graph, RGTexture p_target, const ImDrawData &p_data);

private:
	RenderingDevice &device;
	OwnedTexture font;
	OwnedSampler sampler;
	std::vector<GetTexture> textures; // by ImTextureID - 1; the font's first
};

} // namespace gnomon
