#include "modules/mesh_tools/triangle_distance.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const double MAX_FLOAT = 3e38; // just below FLT_MAX, so that the conversion to float is finite

double compute_segment_distance(
		const glm::dvec3 &p_point, const glm::dvec3 &p_a, const glm::dvec3 &p_b) {
	const glm::dvec3 edge = p_b - p_a;
	const double length2 = glm::dot(edge, edge);
	const double along =
			length2 > 0 ? std::clamp(glm::dot(p_point - p_a, edge) / length2, 0.0, 1.0) : 0.0;
	return glm::distance(p_point, p_a + along * edge);
}

} // namespace

double compute_triangle_distance(const glm::dvec3 &p_point, const glm::dvec3 &p_a,
		const glm::dvec3 &p_b, const glm::dvec3 &p_c) {
	const double edge_distance = std::min({ compute_segment_distance(p_point, p_a, p_b),
			compute_segment_distance(p_point, p_b, p_c),
			compute_segment_distance(p_point, p_c, p_a) });
	const glm::dvec3 normal = glm::cross(p_b - p_a, p_c - p_a);
	const double normal_length = glm::length(normal); // twice the area
	if (normal_length == 0.0) {
		return edge_distance;
	}
	// The point projects into the triangle if it is on the inner side of all three edges.
	const bool projects_inside = glm::dot(glm::cross(p_b - p_a, p_point - p_a), normal) >= 0 &&
			glm::dot(glm::cross(p_c - p_b, p_point - p_b), normal) >= 0 &&
			glm::dot(glm::cross(p_a - p_c, p_point - p_c), normal) >= 0;
	return projects_inside ? std::abs(glm::dot(p_point - p_a, normal)) / normal_length
						   : edge_distance;
}

bool has_triangle_within(const Mesh &p_mesh, const glm::dmat4 &p_world_from_node,
		const glm::dvec3 &p_point_world, double p_distance) {
	const auto get_corner = [&](size_t p_index) {
		return glm::dvec3(p_world_from_node *
				glm::dvec4(glm::dvec3(p_mesh.positions_node[p_mesh.indices[p_index]]), 1.0));
	};
	// Bounds of the search sphere in node space, against which triangles are tested first, without
	// transforming them. The matrix of a mesh that is scaled to zero along an axis has no inverse.
	Bounds search_bounds_node;
	search_bounds_node.add(p_point_world - p_distance);
	search_bounds_node.add(p_point_world + p_distance);
	search_bounds_node = transform_bounds(search_bounds_node, glm::inverse(p_world_from_node));
	const bool is_flat = !std::isfinite(search_bounds_node.get_diagonal());
	const glm::vec3 search_min(glm::max(search_bounds_node.minimum, glm::dvec3(-MAX_FLOAT)));
	const glm::vec3 search_max(glm::min(search_bounds_node.maximum, glm::dvec3(MAX_FLOAT)));
	const auto is_far = [&](size_t p_index) {
		const glm::vec3 &a = p_mesh.positions_node[p_mesh.indices[p_index]];
		const glm::vec3 &b = p_mesh.positions_node[p_mesh.indices[p_index + 1]];
		const glm::vec3 &c = p_mesh.positions_node[p_mesh.indices[p_index + 2]];
		return glm::any(glm::greaterThan(glm::min(a, glm::min(b, c)), search_max)) ||
				glm::any(glm::lessThan(glm::max(a, glm::max(b, c)), search_min));
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
