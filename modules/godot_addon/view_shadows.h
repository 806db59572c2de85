#pragma once

#include "modules/godot_addon/view_depth.h"
#include "modules/render_graph/transient_pool.h"
#include "modules/shadows/shadow_system.h"

#include <map>

namespace gnomon {

/// A texture of Godot as one of the device's, while it stays the same.
class ImportedTexture {
public:
	TextureRID get(GodotDevice &r_device, godot::RID p_texture, const TextureDesc &p_desc);
	/// Before the device ends.
	void free(GodotDevice &r_device);

private:
	godot::RID source;
	TextureRID imported;
};

/// The masks of one view: of one viewport, as Godot keeps buffers for it. Render thread only.
class ViewShadows {
public:
	ViewShadows(GodotDevice &p_device, std::shared_ptr<MeshStore> p_meshes);
	~ViewShadows();
	ViewShadows(const ViewShadows &) = delete;
	ViewShadows &operator=(const ViewShadows &) = delete;

	/// Makes the masks of all lights: before the view's opaque objects are drawn.
	void make_masks(const ScenarioFrame &p_frame, const GodotView &p_view);
	/// Draws the shown lights' masks over the image, the last one's on top.
	void show_masks(const ScenarioFrame &p_frame, const GodotView &p_view);

	uint64_t last_use = 0; // the frame

private:
	void prepare_masks(glm::uvec2 p_size_px, uint32_t p_count);

	GodotDevice &device;
	TransientPool transients;
	ShadowSystem shadows;
	ImportedTexture depth;
	ImportedTexture color;
	/// R16_SFLOAT, a layer for each light: what share of it each pixel gets.
	OwnedTexture masks;
	std::map<std::string, uint32_t> layers; // by light
};

/// The masks of all views. Render thread only, but for its making.
class RenderSide {
public:
	/// From the callbacks of effects; what fails is logged once.
	void make_masks(const ScenarioFrame &p_frame, const godot::Variant &p_render_data);
	void show_masks(const ScenarioFrame &p_frame, const godot::Variant &p_render_data);
	/// Frees all. The next frame makes it again.
	void clear();

private:
	enum class What { MAKE, SHOW };
	void run(What p_what, const ScenarioFrame &p_frame, const godot::Variant &p_render_data);
	void prepare_device();
	void forget_unused(uint64_t p_frame);

	std::unique_ptr<GodotDevice> device;
	std::shared_ptr<MeshStore> meshes;
	std::map<uint64_t, std::unique_ptr<ViewShadows>> views; // by the id of Godot's buffers
	std::set<std::string> logged;
};

} // namespace gnomon
