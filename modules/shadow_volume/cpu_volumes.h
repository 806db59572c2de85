#pragma once

#include "modules/mesh_tools/silhouette.h"
#include "modules/shadow_volume/volume_shape.h"

#include <glm/glm.hpp>

#include <vector>

namespace gnomon {

/// Builds the triangles of a caster's shadow volume from build_silhouette: the same as those of the
/// geometry shader, except that double precision decides which faces are light-facing. Three
/// vertices per triangle: xyz is a vertex of the mesh in node space; w = 1: at that vertex, w = 0:
/// its projection from the light to infinity. Triangles are counter-clockwise seen from outside.
/// Empty when the light is not finite.
std::vector<glm::vec4> build_cpu_volume(const MeshTopology &p_topology,
		const glm::dvec4 &p_light_position_node, const VolumeShape &p_shape);

} // namespace gnomon
