// RenderSide, which view_shadows.h declares.

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/godot_addon/view_shadows.h"

namespace gnomon {

namespace {

const uint64_t MAX_UNUSED_VIEW_FRAMES = 120;

} // namespace

void RenderSide::prepare_device() {
	if (device) {
		return;
	}
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	device = std::make_unique<GodotDevice>(server.get_rendering_device(), GodotDevice::Kind::MAIN);
	meshes = std::make_shared<MeshStore>(*device);
	receivers = std::make_unique<ReceiverTextures>(*device);
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
			shadows->make_masks(p_frame, view);
			forget_unused(p_frame.number);
		} else {
			shadows->show_masks(p_frame, view);
		}
	} catch (const std::exception &failure) { // must not reach Godot
		record_failure(failure);
		forget_view();
	}
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
	views.clear();
	receivers.reset();
	meshes.reset();
	device.reset();
}

} // namespace gnomon
