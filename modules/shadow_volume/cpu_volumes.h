#pragma once

#include "modules/mesh_tools/silhouette.h"
#include "modules/shadow_volume/volume_shape.h"

#include <glm/glm.hpp>

#include <vector>

namespace gnomon {

/// The triangles of a caster's shadow volume, made from build_silhouette: what a geometry shader
/// makes, in double precision. Three corners each, xyz a vertex of the mesh in node space, w = 1:
/// at the vertex, 0: where the light's ray through it ends. They turn counter-clockwise seen from
/// outside. A light that is not finite has no volume.
std::vector<glm::vec4> build_cpu_volume(
		const MeshTopology &p_topology, const glm::dvec4 &p_light_node, const VolumeShape &p_shape);

} // namespace gnomon
