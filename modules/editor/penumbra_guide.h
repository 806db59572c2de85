#pragma once

#include "modules/editor/scene_rays.h"
#include "modules/scene/scene_snapshot.h"

#include <vector>

namespace gnomon {

/// A piece of where a penumbra ends on a receiver.
struct PenumbraLine {
	glm::dvec3 from_world = glm::dvec3(0.0);
	glm::dvec3 to_world = glm::dvec3(0.0);
	bool is_outer = false; // towards the light, by r; else towards the umbra, by t
};

/// Where the penumbra of a light whose rim is r (outer) and t (inner) from its centre ends: rays
/// from the rim through the silhouette edges that the light's centre sees, to the receiver that
/// they meet. With r = t = R that is where the exact penumbra ends, edge by edge. Only what the
/// camera sees; of a scene with more silhouette edges than p_edge_count, an even choice of them.
std::vector<PenumbraLine> find_penumbra_lines(SceneRays &r_rays, const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, size_t p_edge_count);

} // namespace gnomon
