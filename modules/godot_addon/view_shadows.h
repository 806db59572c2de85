#pragma once

#include "modules/godot_addon/receiver_textures.h"
#include "modules/render_graph/transient_pool.h"
#include "modules/shadows/shadow_system.h"

#include <atomic>
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
	/// p_receivers: shared by all views.
	ViewShadows(GodotDevice &p_device, std::shared_ptr<MeshStore> p_meshes,
			ReceiverTextures &p_receivers);
	~ViewShadows();
	ViewShadows(const ViewShadows &) = delete;
	ViewShadows &operator=(const ViewShadows &) = delete;

	/// Makes the masks of all lights: before the view's opaque objects are drawn.
	void make_masks(const ScenarioFrame &p_frame, const GodotView &p_view);
	/// Draws the shown lights' masks over the image, the last one's on top.
	void show_masks(const ScenarioFrame &p_frame, const GodotView &p_view);

	uint64_t last_use = 0; // the frame

private:
	GodotDevice &device;
	ReceiverTextures &receivers;
	TransientPool transients;
	ShadowSystem shadows;
	ImportedTexture depth;
	ImportedTexture color;
	std::map<std::string, uint32_t> layers; // by light
};

/// The masks of all views. Render thread only, but for its making.
class RenderSide {
public:
	/// From the callbacks of effects; what fails is logged once.
	void make_masks(const ScenarioFrame &p_frame, const godot::Variant &p_render_data);
	void show_masks(const ScenarioFrame &p_frame, const godot::Variant &p_render_data);
	/// Makes room for the masks of the frame about to be drawn: each is as large as the largest
	/// view.
	void reserve(glm::uvec2 p_size_px, uint32_t p_mask_count);
	/// Whether masks could not be made of a view since the last query. On any thread.
	bool take_failure() { return has_failed.exchange(false); }
	/// Frees all. The next frame makes it again.
	void clear();

private:
	enum class What { MAKE, SHOW };
	void run(What p_what, const ScenarioFrame &p_frame, const godot::Variant &p_render_data);
	void prepare_device();
	void forget_view();
	void note_failure(const std::exception &p_failure);
	void forget_unused(uint64_t p_frame);

	std::unique_ptr<GodotDevice> device;
	std::shared_ptr<MeshStore> meshes;
	std::unique_ptr<ReceiverTextures> receivers;
	std::map<uint64_t, std::unique_ptr<ViewShadows>> views; // by the id of Godot's buffers
	std::set<std::string> logged;
	std::atomic<bool> has_failed = false;
};

} // namespace gnomon
