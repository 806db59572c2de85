#pragma once

#include "modules/godot_addon/scenario_frame.h"
#include "modules/godot_addon/view_depth.h"

#include "godot_addon/godot_addon_shared.h"

#include <array>

namespace gnomon {

/// A row of the table of lights; gnomon.gdshaderinc describes its columns.
using ReceiverRow = std::array<glm::vec4, RECEIVER_COLUMN_COUNT>;

/// Owns the global shader parameters that gnomon.gdshaderinc and receiver_light.gdshaderinc
/// declare. Main thread only.
class ReceiverGlobals {
public:
	/// Must be created before shaders that use the parameters are compiled.
	ReceiverGlobals();
	~ReceiverGlobals();
	ReceiverGlobals(const ReceiverGlobals &) = delete;
	ReceiverGlobals &operator=(const ReceiverGlobals &) = delete;

private:
	godot::RenderingServer server;
	godot::RID albedo; // texture of get_directional_albedo()
};

/// The textures of the global parameters that change with each view: its masks and its table of
/// lights. All views share them, because Godot draws one after the other. Render thread only.
class ReceiverTextures {
public:
	explicit ReceiverTextures(GodotDevice &p_device);
	~ReceiverTextures();
	ReceiverTextures(const ReceiverTextures &) = delete;
	ReceiverTextures &operator=(const ReceiverTextures &) = delete;

	/// Makes the mask texture at least this large. Call it before a frame is drawn: a new texture
	/// within a frame would make Godot skip draws of materials that read it.
	void reserve(glm::uvec2 p_size_px, uint32_t p_layer_count);
	/// Returns the mask texture: R16_SFLOAT, a layer for each light with the fraction of its light
	/// that reaches each pixel, below 0 without a receiver (see ShadowFrame::hold). Null before
	/// reserve().
	TextureRID get_masks() const { return masks.get(); }
	glm::uvec2 get_size_px() const { return size_px; }
	/// Writes the table of lights, which also identifies the view of the masks. Call it before the
	/// view's opaque objects are drawn.
	void write_lights(const GodotView &p_view, std::span<const ReceiverLight> p_lights);

	/// Makes materials ignore the masks until the next write_lights(), because those of the view
	/// could not be made.
	void forget_view();

private:
	using Table = std::array<ReceiverRow, RECEIVER_ROW_COUNT>;
	void write(const Table &p_table);
	/// One of the textures as a global shader parameter of Godot.
	class Published {
	public:
		void publish(
				const godot::RenderingServer &p_server, const char *p_global, godot::RID p_texture);
		void free(const godot::RenderingServer &p_server);

	private:
		godot::RID texture;
	};
	GodotDevice &device;
	godot::RenderingServer server;
	glm::uvec2 size_px = glm::uvec2(0);
	uint32_t layer_count = 0;
	OwnedTexture masks;
	Published published_masks;
	OwnedBuffer rows;
	OwnedTexture lights;
	Published published_lights;
};

} // namespace gnomon
