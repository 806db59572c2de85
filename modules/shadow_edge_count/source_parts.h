#pragma once

#include "modules/scene/mesh.h"

#include <cstdint>
#include <vector>

namespace gnomon {

/// The connected parts of a mesh before the alpha test.
struct SourceParts {
	std::vector<uint32_t> part_of_triangle;
	std::vector<glm::vec4> spheres; // centre and radius, one per part; at least one
};

/// Finds the parts, in which triangles are connected if they have an edge in common, by the
/// positions of its ends. Unlike MeshTopology::parts, they do not depend on winding, joints or
/// degenerate triangles: an edge of what is cut out of the mesh never joins two parts.
SourceParts find_source_parts(const Mesh &p_mesh);

} // namespace gnomon
