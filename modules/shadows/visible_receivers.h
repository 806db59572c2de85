#pragma once

#include "modules/shadows/light_view.h"

#include <vector>

namespace gnomon {

/// Where the camera may see an instance: all of its pixels' receivers are in these bounds.
struct VisibleReceiver {
	uint32_t instance_index = 0;
	/// Of the part of the instance's box that is in the camera's view, grown by what rounding on
	/// the GPU and the receiver's offset from its surface may add.
	Bounds bounds_world;
};

struct VisibleReceivers {
	std::vector<VisibleReceiver> list; // ascending
	Bounds bounds_world;			   // of all of them

	void add(const VisibleReceiver &p_receiver) {
		list.push_back(p_receiver);
		bounds_world.add(p_receiver.bounds_world);
	}
};

/// The instances that the camera may see.
VisibleReceivers find_visible_receivers(
		const SceneSnapshot &p_scene, const LightView &p_camera_view);

/// False only when nothing in the box receives light: it is certainly out of range, or out of the
/// cone. The box holds what rounding may add.
bool may_light_reach(const LightSnapshot &p_light, const Bounds &p_bounds_world);

/// Those that the light may reach: without any, the light changes no pixel.
VisibleReceivers find_lit_receivers(
		const LightSnapshot &p_light, const VisibleReceivers &p_receivers);

/// False only when no receiver is in the light view.
bool may_view_hold_any(const LightView &p_view, const VisibleReceivers &p_receivers);

} // namespace gnomon
