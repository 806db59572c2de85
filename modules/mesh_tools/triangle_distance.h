#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

namespace gnomon {

/// Returns the distance from a point to the nearest point of a triangle, which may have no area.
double compute_triangle_distance(const glm::dvec3 &p_point, const glm::dvec3 &p_a,
		const glm::dvec3 &p_b, const glm::dvec3 &p_c);

/// Returns whether a triangle of the mesh is closer than p_distance (m) to the point, in world
/// space. Visits every triangle, but usually tests only its bounds: takes some milliseconds per
/// million triangles.
bool has_triangle_within(const Mesh &p_mesh, const glm::dmat4 &p_world_from_node,
		const glm::dvec3 &p_point_world, double p_distance);

} // namespace gnomon
