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

/// The size of the textures that all views share.
struct ReceiverSpace {
	glm::uvec2 size_px = glm::uvec2(0); // of the largest view
	uint32_t mask_count = 0;
	bool has_depth = false; // see ReceiverTextures::get_depth

	bool holds(const ReceiverSpace &p_other) const {
		return p_other.mask_count <= mask_count && (has_depth || !p_other.has_depth) &&
				glm::all(glm::lessThanEqual(p_other.size_px, size_px));
	}
	void add(const ReceiverSpace &p_other) {
		size_px = glm::max(size_px, p_other.size_px);
		mask_count = glm::max(mask_count, p_other.mask_count);
		has_depth = has_depth || p_other.has_depth;
	}
};

/// The textures of the global parameters that change with each view: its masks and its table of
/// lights. All views share them, because Godot draws one after the other. Render thread only.
class ReceiverTextures {
public:
	explicit ReceiverTextures(GodotDevice &p_device);
	~ReceiverTextures();
	ReceiverTextures(const ReceiverTextures &) = delete;
	ReceiverTextures &operator=(const ReceiverTextures &) = delete;

	/// Makes the textures at least this large. Call it before a frame is drawn: a new texture
	/// within a frame would make Godot skip draws of materials that read it.
	void reserve(const ReceiverSpace &p_space);
	/// Returns the mask texture: R16_SFLOAT, a layer for each light with the fraction of its light
	/// that reaches each pixel, below 0 without a receiver (see ShadowFrame::hold). Null before
	/// reserve().
	TextureRID get_masks() const { return masks.get(); }
	glm::uvec2 get_size_px() const { return space.size_px; }
	/// Returns the texture for near / z of the surface at each pixel's centre, R32_SFLOAT, by which
	/// fragments find whether the mask is of their surface, and in multisampled views which
	/// neighbour's is. Null before a reserve() with has_depth.
	TextureRID get_depth() const { return depth.get(); }
	/// Writes the table of lights, which also identifies the view of the masks. Call it before the
	/// view's opaque objects are drawn. p_has_masks: false: all lights keep Godot's shadow.
	void write_lights(
			const GodotView &p_view, const ScenarioFrame &p_frame, bool p_has_masks = true);

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
	ReceiverSpace space;
	OwnedTexture masks;
	Published published_masks;
	OwnedTexture depth;
	Published published_depth;
	OwnedBuffer rows;
	OwnedTexture lights;
	Published published_lights;
};

} // namespace gnomon
