#pragma once

#include "modules/mesh_tools/bvh.h"
#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>

namespace gnomon {

/// Finds where a ray meets a mesh's triangles. For the few rays of an editor; an image's worth of
/// them is Embree's.
class RayTree {
public:
	explicit RayTree(std::shared_ptr<const Mesh> p_mesh);

	/// The least t > p_begin with a triangle at origin + t direction, in node space; from either
	/// side. The direction may have any length, and t is in units of it. None for a direction of
	/// zero or one that is not finite.
	std::optional<double> find_nearest(const glm::dvec3 &p_origin_node,
			const glm::dvec3 &p_direction_node, double p_begin = 0.0) const;

private:
	std::shared_ptr<const Mesh> mesh;
	Bvh tree; // over the triangles
};

/// As above, of a box: where the ray enters it, or p_begin inside. None: it misses.
std::optional<double> find_box_entry(const Bounds &p_bounds, const glm::dvec3 &p_origin,
		const glm::dvec3 &p_direction, double p_begin, double p_end);

} // namespace gnomon
