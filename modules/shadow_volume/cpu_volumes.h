#pragma once

#include "modules/mesh_tools/silhouette.h"
#include "modules/shadow_volume/volume_shape.h"

#include <glm/glm.hpp>

#include <vector>

namespace gnomon {

/// The triangles of a caster's shadow volume, extruded from build_silhouette: the same as those of
/// the geometry shader, in double precision. Three vertices per triangle: xyz is a vertex of the
/// mesh in node space; w = 1: at that vertex, w = 0: its extrusion along the light's ray. Triangles
/// are counter-clockwise seen from outside. Empty when the light is not finite.
std::vector<glm::vec4> build_cpu_volume(const MeshTopology &p_topology,
		const glm::dvec4 &p_light_position_node, const VolumeShape &p_shape);

} // namespace gnomon
