#include "modules/mesh_tools/triangle_distance.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const double MOST_FLOAT = 3e38;

double compute_segment_distance(
		const glm::dvec3 &p_point, const glm::dvec3 &p_a, const glm::dvec3 &p_b) {
	const glm::dvec3 way = p_b - p_a;
	const double length2 = glm::dot(way, way);
	const double along =
			length2 > 0 ? std::clamp(glm::dot(p_point - p_a, way) / length2, 0.0, 1.0) : 0.0;
	return glm::distance(p_point, p_a + along * way);
}

} // namespace

double compute_triangle_distance(const glm::dvec3 &p_point, const glm::dvec3 &p_a,
		const glm::dvec3 &p_b, const glm::dvec3 &p_c) {
	const double to_rim = std::min({ compute_segment_distance(p_point, p_a, p_b),
			compute_segment_distance(p_point, p_b, p_c),
			compute_segment_distance(p_point, p_c, p_a) });
	const glm::dvec3 normal = glm::cross(p_b - p_a, p_c - p_a);
	const double area = glm::length(normal);
	if (area == 0.0) {
		return to_rim;
	}
	// The point is above the face if it is on the inner side of all three edges.
	const bool is_above = glm::dot(glm::cross(p_b - p_a, p_point - p_a), normal) >= 0 &&
			glm::dot(glm::cross(p_c - p_b, p_point - p_b), normal) >= 0 &&
			glm::dot(glm::cross(p_a - p_c, p_point - p_c), normal) >= 0;
	return is_above ? std::abs(glm::dot(p_point - p_a, normal)) / area : to_rim;
}

bool has_triangle_within(const Mesh &p_mesh, const glm::dmat4 &p_world_from_node,
		const glm::dvec3 &p_point_world, double p_distance) {
	const auto get_corner = [&](size_t p_index) {
		return glm::dvec3(p_world_from_node *
				glm::dvec4(glm::dvec3(p_mesh.positions_node[p_mesh.indices[p_index]]), 1.0));
	};
	// Bounds of the search sphere around the point, in the mesh's own space, where most triangles
	// are rejected without a transform. A flattened mesh has no such space.
	Bounds near_node;
	near_node.add(p_point_world - p_distance);
	near_node.add(p_point_world + p_distance);
	near_node = transform_bounds(near_node, glm::inverse(p_world_from_node));
	const bool is_flat = !std::isfinite(near_node.get_diagonal());
	const glm::vec3 least(glm::max(near_node.minimum, glm::dvec3(-MOST_FLOAT)));
	const glm::vec3 most(glm::min(near_node.maximum, glm::dvec3(MOST_FLOAT)));
	const auto is_far = [&](size_t p_index) {
		const glm::vec3 &a = p_mesh.positions_node[p_mesh.indices[p_index]];
		const glm::vec3 &b = p_mesh.positions_node[p_mesh.indices[p_index + 1]];
		const glm::vec3 &c = p_mesh.positions_node[p_mesh.indices[p_index + 2]];
		return glm::any(glm::greaterThan(glm::min(a, glm::min(b, c)), most)) ||
				glm::any(glm::lessThan(glm::max(a, glm::max(b, c)), least));
	};
	for (size_t index = 0; index < p_mesh.indices.size(); index += 3) {
		if (!is_flat && is_far(index)) {
			continue;
		}
		const glm::dvec3 a = get_corner(index);
		const glm::dvec3 b = get_corner(index + 1);
		const glm::dvec3 c = get_corner(index + 2);
		const glm::dvec3 low = glm::min(a, glm::min(b, c)) - p_distance;
		const glm::dvec3 high = glm::max(a, glm::max(b, c)) + p_distance;
		if (glm::all(glm::greaterThan(p_point_world, low)) &&
				glm::all(glm::lessThan(p_point_world, high)) &&
				compute_triangle_distance(p_point_world, a, b, c) < p_distance) {
			return true;
		}
	}
	return false;
}

} // namespace gnomon
