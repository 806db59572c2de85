#pragma once

#include "modules/mesh_tools/bvh.h"
#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>

namespace gnomon {

/// Finds where a ray hits a mesh's triangles. Meant for the few rays of an editor; for whole images
/// use Embree.
class RayTree {
public:
	explicit RayTree(std::shared_ptr<const Mesh> p_mesh);

	/// Returns the least t > p_begin with a triangle, front or back, at origin + t direction, in
	/// node space. The direction may have any length, and t is in units of it. Returns nothing for
	/// a direction that is zero or not finite.
	std::optional<double> find_nearest(const glm::dvec3 &p_origin_node,
			const glm::dvec3 &p_direction_node, double p_begin = 0.0) const;

private:
	std::shared_ptr<const Mesh> mesh;
	Bvh tree; // over the triangles
};

/// Intersects the ray with a box: returns where the ray enters it, or p_begin if it starts inside.
/// Nothing: the ray misses.
std::optional<double> find_box_entry(const Bounds &p_bounds, const glm::dvec3 &p_origin,
		const glm::dvec3 &p_direction, double p_begin, double p_end);

} // namespace gnomon
