#pragma once

#include "modules/shadows/light_view.h"

#include <array>
#include <span>
#include <vector>

namespace gnomon {

/// The part of an instance that the camera may see: the bounds contain all of its receivers.
struct VisibleReceiver {
	uint32_t instance_index = 0;
	/// Bounds of the part of the instance's box that is in the camera's view, grown by a margin for
	/// rounding on the GPU and for the receiver's offset from its surface.
	Bounds bounds_world;
};

/// The receivers in the camera's view, or only those of them that a light may reach.
struct VisibleReceivers {
	std::vector<VisibleReceiver> list; // ascending by instance_index
	Bounds bounds_world;			   // union of the list's bounds

	void add(const VisibleReceiver &p_receiver) {
		list.push_back(p_receiver);
		bounds_world.add(p_receiver.bounds_world);
	}
};

/// Inside: dot(normal, p) + offset >= 0. The normal has any length.
struct ViewPlane {
	glm::dvec3 normal;
	double offset;
	double compute_side(const glm::dvec3 &p_point) const {
		return glm::dot(normal, p_point) + offset;
	}
};
/// A perspective view's four sides and the plane behind which nothing is seen, in the world.
using ViewPlanes = std::array<ViewPlane, 5>;
ViewPlanes find_view_planes(const LightView &p_view);

/// The instances that the camera may see.
VisibleReceivers find_visible_receivers(
		const SceneSnapshot &p_scene, const LightView &p_camera_view);
/// As above, from what the same camera view saw of a scene that differs only in these pages of
/// instances. p_before: of that scene. p_changed_pages: ascending.
VisibleReceivers find_visible_receivers(const SceneSnapshot &p_scene,
		const LightView &p_camera_view, const VisibleReceivers &p_before,
		std::span<const uint32_t> p_changed_pages);

/// False only when the box is certainly outside the light's range or cone, so that nothing in it
/// receives light. The box must include the margin for rounding.
bool may_light_reach(const LightSnapshot &p_light, const Bounds &p_bounds_world);

/// The receivers that the light may reach. When there are none, the light changes no pixel.
VisibleReceivers find_lit_receivers(
		const LightSnapshot &p_light, const VisibleReceivers &p_receivers);

/// False only when no receiver is in the light view.
bool may_view_contain_any(const LightView &p_view, const VisibleReceivers &p_receivers);

} // namespace gnomon
