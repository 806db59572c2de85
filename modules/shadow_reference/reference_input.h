#pragma once

#include "modules/scene/scene_snapshot.h"
#include "modules/shadow_reference/area_light_visibility.h"

#include <vector>

// A scene as the tracer takes it: relative to the camera, as the rasteriser places it.

namespace gnomon {

/// Triangles of all casters.
struct CasterTriangles {
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
};

CasterTriangles collect_triangles(const SceneSnapshot &p_scene);
AreaLight make_area_light(const SceneSnapshot &p_scene, const LightSnapshot &p_light);

} // namespace gnomon
