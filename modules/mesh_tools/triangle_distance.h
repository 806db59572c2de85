#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

namespace gnomon {

/// Distance from a point to the nearest point of a triangle; triangles without area are allowed.
double compute_triangle_distance(const glm::dvec3 &p_point, const glm::dvec3 &p_a,
		const glm::dvec3 &p_b, const glm::dvec3 &p_c);

/// True when a triangle of the mesh comes nearer to the point, in the world, than that. Looks at
/// every triangle, at most of them only at their boxes: some milliseconds a million.
bool has_triangle_within(const Mesh &p_mesh, const glm::dmat4 &p_world_from_node,
		const glm::dvec3 &p_point_world, double p_distance);

} // namespace gnomon
