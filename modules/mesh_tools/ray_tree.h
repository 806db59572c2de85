#pragma once

#include "modules/mesh_tools/bvh.h"
#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>

namespace gnomon {

/// Finds where a ray hits a mesh. Meant for a few rays, such as those of an editor; use Embree for
/// whole images.
class RayTree {
public:
	explicit RayTree(std::shared_ptr<const Mesh> p_mesh);

	/// Returns the smallest t > p_begin at which the ray p_origin_node + t * p_direction_node hits
	/// the front or back of a triangle, or nothing if there is none. The direction is in node space
	/// and may have any length. Returns nothing for a direction that is zero or not finite.
	std::optional<double> find_nearest(const glm::dvec3 &p_origin_node,
			const glm::dvec3 &p_direction_node, double p_begin = 0.0) const;

private:
	std::shared_ptr<const Mesh> mesh;
	Bvh tree; // over the triangles
};

/// Intersects a ray with a box, for t in p_begin..p_end. Returns the t at which the ray
/// p_origin + t * p_direction enters the box, p_begin if it starts inside, or nothing if it misses.
std::optional<double> find_box_entry(const Bounds &p_bounds, const glm::dvec3 &p_origin,
		const glm::dvec3 &p_direction, double p_begin, double p_end);

} // namespace gnomon
