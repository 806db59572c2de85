#pragma once

#include "modules/editor/scene_rays.h"
#include "modules/scene/scene_snapshot.h"

#include <vector>

namespace gnomon {

/// A line segment of a penumbra's edge on a receiver.
struct PenumbraLine {
	glm::dvec3 from_world = glm::dvec3(0.0);
	glm::dvec3 to_world = glm::dvec3(0.0);
	bool is_outer = false; // true: edge on the lit side; false: edge on the umbra side
};

/// Finds the edges of a light's penumbra. Casts rays from points beside the light's centre past the
/// silhouette edges, as seen from the centre, to the receivers. The points are at the distance r
/// (penumbra_outer_width) for the outer edge and t (penumbra_inner_width) for the inner one; for a
/// directional light, the rays are tilted by the angles with the tangents r / S and t / S instead,
/// where S is the scene size. With r = t = R, the light's radius, each silhouette edge gives the
/// edges of the exact penumbra. These are the widths of a light of a snapshot that sets none; the
/// fractions of R that its technique may derive are widths at the caster. Lines are omitted where
/// the camera does not see them, outside the light's cone or range, for edges that are hidden from
/// the light, and if a line is so long that its ends seem to be on different receivers. If there
/// are more than p_edge_count silhouette edges, an evenly spaced subset is used.
std::vector<PenumbraLine> find_penumbra_lines(SceneRays &r_rays, const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, size_t p_edge_count);

} // namespace gnomon
