#pragma once

#include "modules/editor/scene_rays.h"
#include "modules/scene/scene_snapshot.h"

#include <vector>

namespace gnomon {

/// A segment of a penumbra's edge on a receiver.
struct PenumbraLine {
	glm::dvec3 from_world = glm::dvec3(0.0);
	glm::dvec3 to_world = glm::dvec3(0.0);
	bool is_outer = false; // the lit side, from r; otherwise the umbra side, from t
};

/// Finds the edges of a light's penumbra by casting rays from its rim, r (outer) and t (inner) from
/// its centre, through the silhouette edges seen from the light's centre, to the receivers. With r
/// = t = R these are the edges of the exact penumbra, per silhouette edge. Includes only what the
/// camera sees; of more than p_edge_count silhouette edges, an evenly spaced subset is used.
std::vector<PenumbraLine> find_penumbra_lines(SceneRays &r_rays, const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, size_t p_edge_count);

} // namespace gnomon
