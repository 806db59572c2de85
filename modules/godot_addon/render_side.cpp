// RenderSide, which view_shadows.h declares.

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/core/text.h"
#include "modules/godot_addon/view_shadows.h"

#include <algorithm>

namespace gnomon {

namespace {

const uint64_t MAX_UNUSED_VIEW_FRAMES = 120;

} // namespace

std::set<std::string> list_light_kinds(const SceneSnapshot &p_scene) {
	std::set<std::string> kinds;
	for (const LightSnapshot &light : p_scene.lights) {
		std::string kind = text(light.technique_id, " ", get_light_type_name(light.type));
		for (const auto &[name, value] : light.properties) {
			if (const auto *choice = std::get_if<std::string>(&value)) {
				kind += text(" ", name, "=", *choice); // a method or a quality
			}
		}
		kinds.insert(std::move(kind));
	}
	return kinds;
}

void RenderSide::prepare_device() {
	if (device) {
		return;
	}
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	device = std::make_unique<GodotDevice>(server.get_rendering_device(), GodotDevice::Kind::MAIN);
	meshes = std::make_shared<MeshStore>(*device);
	meshes->set_texture_source(
			[this](const ProgramTexture &p_texture) { return find_texture(p_texture); });
	receivers = std::make_unique<ReceiverTextures>(*device);
}

TextureRID RenderSide::find_texture(const ProgramTexture &p_texture) {
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	const godot::RID texture =
			server.texture_get_rd_texture(godot::RID{ p_texture.id }, p_texture.is_srgb);
	if (!texture) {
		return {};
	}
	ProgramTextureEntry &entry = program_textures[{ p_texture.id, p_texture.is_srgb }];
	entry.last_use = frame_number;
	// Size and format are unknown, and nothing here depends on them.
	return entry.imported.get(*device, texture, { .name = "texture of a vertex program" });
}

void RenderSide::make_masks(const ScenarioFrame &p_frame, const godot::Variant &p_render_data) {
	run(Action::MAKE, p_frame, p_render_data);
}

void RenderSide::show_masks(const ScenarioFrame &p_frame, const godot::Variant &p_render_data) {
	run(Action::SHOW, p_frame, p_render_data);
}

void RenderSide::run(
		Action p_action, const ScenarioFrame &p_frame, const godot::Variant &p_render_data) {
	try {
		const auto data =
				godot::cast<godot::RenderData>(godot::ObjectHandle(p_render_data.to_object()));
		if (!data) {
			return;
		}
		const godot::Ref<godot::RenderSceneBuffers> any_buffers = data.get_render_scene_buffers();
		const auto buffers = godot::cast<godot::RenderSceneBuffersRD>(any_buffers);
		if (!buffers) {
			return;
		}
		prepare_device();
		const GodotView view = read_view(*device, data, buffers);
		if (view.is_orthogonal) { // SceneReader has warned
			forget_view();
			return;
		}
		if (!view.unsupported_reason.empty()) {
			fail("A camera ", view.unsupported_reason, ". Gnomon makes no shadow masks for it.");
		}
		if (!view.depth || !view.color) {
			return;
		}
		std::unique_ptr<ViewShadows> &shadows = views[godot::get_instance_id(buffers.get_object())];
		if (!shadows) {
			shadows = std::make_unique<ViewShadows>(*device, meshes, *receivers);
		}
		shadows->last_use = p_frame.number;
		if (p_action == Action::MAKE) {
			make(*shadows, p_frame, view);
			forget_unused(p_frame.number);
		} else {
			shadows->show_masks(p_frame, view);
		}
	} catch (const std::exception &failure) { // must not reach Godot
		if (device) {
			device->compile_only({});
		}
		record_failure(failure);
		forget_view();
	}
}

void RenderSide::make(
		ViewShadows &r_shadows, const ScenarioFrame &p_frame, const GodotView &p_view) {
	const std::set<std::string> kinds = list_light_kinds(*p_frame.scene);
	// Lights that are shown already get what they need now, even if the frame takes longer.
	try {
		r_shadows.make_masks(
				p_frame, p_view, are_compiled(kinds) ? std::nullopt : p_frame.max_compilations);
	} catch (const NothingExecuted &) {
		const bool has_compiled_all = device->has_compiled_all();
		device->compile_only({});
		// Materials need the sizes of the lights.
		receivers->write_lights(p_view, p_frame, /*p_has_masks=*/false);
		if (!has_compiled_all) {
			return;
		}
	}
	const std::lock_guard lock(mutex);
	compiled_kinds.insert(kinds.begin(), kinds.end());
}

bool RenderSide::are_compiled(const std::set<std::string> &p_light_kinds) const {
	const std::lock_guard lock(mutex);
	return std::includes(compiled_kinds.begin(), compiled_kinds.end(), p_light_kinds.begin(),
			p_light_kinds.end());
}

void RenderSide::forget_view() {
	try {
		if (receivers) {
			receivers->forget_view();
		}
	} catch (const std::exception &failure) {
		record_failure(failure);
	}
}

void RenderSide::record_failure(const std::exception &p_failure) {
	has_failed = true;
	const std::string description = describe_failure(p_failure);
	if (logged_failures.insert(description).second) {
		log_error(description);
	}
}

void RenderSide::forget_unused(uint64_t p_frame) {
	std::erase_if(views, [&](const auto &p_entry) {
		return p_frame - p_entry.second->last_use > MAX_UNUSED_VIEW_FRAMES ||
				godot::get_instance(p_entry.first) == nullptr;
	});
	frame_number = p_frame;
	for (auto entry = program_textures.begin(); entry != program_textures.end();) {
		if (p_frame - entry->second.last_use > MAX_UNUSED_VIEW_FRAMES) {
			entry->second.imported.free(*device);
			entry = program_textures.erase(entry);
		} else {
			++entry;
		}
	}
}

void RenderSide::reserve(const ReceiverSpace &p_space) {
	try {
		prepare_device();
		receivers->reserve(p_space);
	} catch (const std::exception &failure) {
		record_failure(failure);
	}
}

void RenderSide::clear() {
	{
		const std::lock_guard lock(mutex);
		compiled_kinds.clear();
	}
	views.clear();
	for (auto &[id, entry] : program_textures) {
		entry.imported.free(*device);
	}
	program_textures.clear();
	receivers.reset();
	meshes.reset();
	device.reset();
}

} // namespace gnomon
