// Creates a local device of Godot, which shares no resources with the one that draws its frames.

#include "modules/core/error.h"
#include "modules/rendering_device_godot/godot_device.h"

namespace gnomon {

std::unique_ptr<RenderingDevice> create_rendering_device(const DeviceOptions &p_options) {
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	const godot::RenderingDevice local = server.create_local_rendering_device();
	if (!local) {
		fail("Godot draws without a RenderingDevice here. Start it with a display and with the "
			 "renderer Forward+: --rendering-method forward_plus, without --headless.");
	}
	return std::make_unique<GodotDevice>(local, GodotDevice::Kind::LOCAL, p_options);
}

std::vector<DeviceInfo> find_rendering_devices() {
	return {}; // Godot chooses the device
}

unsigned get_validation_message_count() {
	return 0; // Godot logs them
}

bool has_device_hung() {
	return false;
}

} // namespace gnomon
