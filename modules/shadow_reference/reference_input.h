#pragma once

#include "modules/renderer/truth_source.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/shadow_reference/area_light_visibility.h"

#include <functional>
#include <span>
#include <vector>

// A scene as the tracer takes it: relative to the camera, as the rasteriser places it.

namespace gnomon {

/// Triangles of all casters.
struct CasterTriangles {
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
};

/// p_is_receiver: of a pixel, does the light reach there?
std::vector<ReceiverPoint> make_receiver_points(
		std::span<const SurfacePoint> p_surfaces, const std::function<bool(size_t)> &p_is_receiver);
CasterTriangles collect_triangles(const SceneSnapshot &p_scene);
AreaLight make_area_light(const SceneSnapshot &p_scene, const LightSnapshot &p_light);

} // namespace gnomon
