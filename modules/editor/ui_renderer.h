#pragma once

#include "modules/render_graph/render_graph.h"

#include <functional>
#include <vector>

struct ImDrawData;

namespace gnomon {

/// Renders Dear ImGui's draw data with the engine's RenderingDevice.
class UiRenderer {
public:
	/// Uploads the fonts of the current ImGui context, which must exist.
	explicit UiRenderer(RenderingDevice &p_device);

	using GetTexture = std::function<TextureRID()>;
	/// Registers a texture for ImGui::Image in this frame: RGBA8_UNORM, SAMPLED. p_get_texture is
	/// called later, by add_pass, so that the texture may be replaced after the panels are built;
	/// if it returns an empty RID, nothing is drawn. Returns the ImTextureID.
	void *add_texture(GetTexture p_get_texture);
	/// Adds a pass that draws over p_target, which must have the display's size. Unregisters this
	/// frame's textures.
	void add_pass(RenderGraph &r_graph, RGTexture p_target, const ImDrawData &p_data);

private:
	RenderingDevice &device;
	OwnedTexture font;
	OwnedSampler sampler;
	std::vector<GetTexture> textures; // by ImTextureID - 1; the first is the font's
};

} // namespace gnomon
