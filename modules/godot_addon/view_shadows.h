#pragma once

#include "modules/godot_addon/receiver_textures.h"
#include "modules/render_graph/transient_pool.h"
#include "modules/shadows/shadow_system.h"

#include <atomic>
#include <map>

namespace gnomon {

/// The kinds of a scene's lights: those with the same pipelines, as far as is known before the
/// masks are made. A name for each kind.
std::set<std::string> list_light_kinds(const SceneSnapshot &p_scene);

/// A texture of Godot that is imported into the device. It is imported again when it changes.
class ImportedTexture {
public:
	TextureRID get(GodotDevice &r_device, godot::RID p_texture, const TextureDesc &p_desc);
	/// Call it before the device is destroyed.
	void free(GodotDevice &r_device);

private:
	godot::RID source;
	TextureRID imported;
};

/// The masks of one view, which is one viewport with render buffers. Render thread only.
class ViewShadows {
public:
	/// p_receivers: the textures that all views share.
	ViewShadows(GodotDevice &p_device, std::shared_ptr<MeshStore> p_meshes,
			ReceiverTextures &p_receivers);
	~ViewShadows();
	ViewShadows(const ViewShadows &) = delete;
	ViewShadows &operator=(const ViewShadows &) = delete;

	/// Makes the masks of all lights. Call it before the view's opaque objects are drawn.
	/// p_compile_only: if it has a value, up to this many pipelines are compiled instead, and
	/// NothingExecuted is thrown, see GodotDevice::compile_only.
	void make_masks(const ScenarioFrame &p_frame, const GodotView &p_view,
			std::optional<uint32_t> p_compile_only);
	/// Draws the masks of p_frame.shown_lights over the image, the last one on top.
	void show_masks(const ScenarioFrame &p_frame, const GodotView &p_view);

	uint64_t last_use = 0; // frame number

private:
	GodotDevice &device;
	ReceiverTextures &receivers;
	TransientPool transients;
	ShadowSystem shadows;
	ImportedTexture depth;
	ImportedTexture color;
	std::map<std::string, uint32_t> layers; // layer of the mask by light name
};

/// The masks of all views. Render thread only, except for the constructor and take_failure().
class RenderSide {
public:
	/// Called by the compositor effects. Each failure is logged once.
	void make_masks(const ScenarioFrame &p_frame, const godot::Variant &p_render_data);
	void show_masks(const ScenarioFrame &p_frame, const godot::Variant &p_render_data);
	/// Allocates masks for the frame about to be drawn.
	void reserve(const ReceiverSpace &p_space);
	/// Whether masks of a view could not be made since the last call. Can be called on any thread.
	bool take_failure() { return has_failed.exchange(false); }
	/// Whether the pipelines of all lights of such kinds are compiled. Can be called on any thread.
	bool are_compiled(const std::set<std::string> &p_light_kinds) const;
	/// Frees all GPU resources. The next frame creates them again.
	void clear();

private:
	enum class Action { MAKE, SHOW };
	void run(Action p_action, const ScenarioFrame &p_frame, const godot::Variant &p_render_data);
	void make(ViewShadows &r_shadows, const ScenarioFrame &p_frame, const GodotView &p_view);
	void prepare_device();
	/// Makes materials ignore the masks until those of the next view are made. Keeps `views`.
	void forget_view();
	void record_failure(const std::exception &p_failure);
	void forget_unused(uint64_t p_frame);

	/// Returns the device's texture for one that a vertex program reads, imported if it is new.
	TextureRID find_texture(const ProgramTexture &p_texture);

	std::unique_ptr<GodotDevice> device;
	std::shared_ptr<MeshStore> meshes;
	struct ProgramTextureEntry {
		ImportedTexture imported;
		uint64_t last_use = 0; // frame number
	};
	std::map<std::pair<uint64_t, bool>, ProgramTextureEntry> program_textures; // by id and is_srgb
	uint64_t frame_number = 0;												   // of the last frame
	std::unique_ptr<ReceiverTextures> receivers;
	std::map<uint64_t, std::unique_ptr<ViewShadows>> views; // by the id of Godot's buffers
	std::set<std::string> logged_failures;
	std::atomic<bool> has_failed = false;
	mutable std::mutex mutex;
	std::set<std::string> compiled_kinds; // of lights whose masks were made; guarded by `mutex`
};

} // namespace gnomon
