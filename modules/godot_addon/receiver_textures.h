#pragma once

#include "modules/godot_addon/scenario_frame.h"
#include "modules/godot_addon/view_depth.h"

#include "godot_addon/godot_addon_shared.h"

#include <array>

namespace gnomon {

using ReceiverRow = std::array<glm::vec4, RECEIVER_COLUMN_COUNT>;

/// The shader globals that materials read, gnomon.gdshaderinc. Main thread only.
class ReceiverGlobals {
public:
	/// Before shaders that name them are compiled.
	ReceiverGlobals();
	~ReceiverGlobals();
	ReceiverGlobals(const ReceiverGlobals &) = delete;
	ReceiverGlobals &operator=(const ReceiverGlobals &) = delete;

private:
	godot::RenderingServer server;
	godot::RID albedo;
};

/// The textures of those globals that change: the masks of the view that is drawn, and its table of
/// lights. All views share them, as Godot draws one after the other. Render thread only.
class ReceiverTextures {
public:
	explicit ReceiverTextures(GodotDevice &p_device);
	~ReceiverTextures();
	ReceiverTextures(const ReceiverTextures &) = delete;
	ReceiverTextures &operator=(const ReceiverTextures &) = delete;

	/// Makes room for masks. Before a frame is drawn: within it Godot would lose materials' draws.
	void reserve(glm::uvec2 p_size_px, uint32_t p_layer_count);
	/// R16_SFLOAT, a layer for each light: what share of it each pixel gets; below 0
	/// where there is no receiver. Null: no room was made.
	TextureRID get_masks() const { return masks.get(); }
	glm::uvec2 get_size_px() const { return size_px; }
	/// Sets which view the masks are of, and its lights. Before its opaque objects are drawn.
	void write_lights(const GodotView &p_view, std::span<const ReceiverLight> p_lights);

	/// Materials take no mask until the next view's: those of this one could not be made.
	void forget_view();

private:
	using Table = std::array<ReceiverRow, RECEIVER_ROW_COUNT>;
	void write(const Table &p_table);
	/// One of the textures as Godot's materials have it.
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
