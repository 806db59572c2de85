#include "modules/mesh_tools/ray_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace gnomon {

namespace {

glm::dvec3 get_corner(const Mesh &p_mesh, uint32_t p_triangle, uint32_t p_corner) {
	return glm::dvec3(p_mesh.positions_node[p_mesh.indices[3 * size_t(p_triangle) + p_corner]]);
}

std::vector<Bounds> compute_triangle_bounds(const Mesh &p_mesh) {
	std::vector<Bounds> bounds(p_mesh.get_triangle_count());
	for (uint32_t triangle = 0; triangle < bounds.size(); ++triangle) {
		for (uint32_t corner = 0; corner < 3; ++corner) {
			bounds[triangle].add(get_corner(p_mesh, triangle, corner));
		}
	}
	return bounds;
}

/// Intersects a ray with both sides of a triangle (Moeller and Trumbore 1997) and returns t. On an
/// edge shared by two triangles, either of them may be hit or, because of rounding, neither.
std::optional<double> find_triangle_hit(const Mesh &p_mesh, uint32_t p_triangle,
		const glm::dvec3 &p_origin, const glm::dvec3 &p_direction) {
	const glm::dvec3 corner = get_corner(p_mesh, p_triangle, 0);
	const glm::dvec3 side_1 = get_corner(p_mesh, p_triangle, 1) - corner;
	const glm::dvec3 side_2 = get_corner(p_mesh, p_triangle, 2) - corner;
	const glm::dvec3 across = glm::cross(p_direction, side_2);
	const double determinant = glm::dot(side_1, across);
	if (determinant == 0.0) {
		return std::nullopt;
	}
	const glm::dvec3 from_corner = p_origin - corner;
	const double u = glm::dot(from_corner, across) / determinant;
	const glm::dvec3 other = glm::cross(from_corner, side_1);
	const double v = glm::dot(p_direction, other) / determinant;
	if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0)) {
		return std::nullopt;
	}
	return glm::dot(side_2, other) / determinant;
}

} // namespace

std::optional<double> find_box_entry(const Bounds &p_bounds, const glm::dvec3 &p_origin,
		const glm::dvec3 &p_direction, double p_begin, double p_end) {
	for (int axis = 0; axis < 3; ++axis) {
		if (p_direction[axis] == 0.0) {
			if (p_origin[axis] < p_bounds.minimum[axis] ||
					p_origin[axis] > p_bounds.maximum[axis]) {
				return std::nullopt;
			}
			continue;
		}
		const double first = (p_bounds.minimum[axis] - p_origin[axis]) / p_direction[axis];
		const double second = (p_bounds.maximum[axis] - p_origin[axis]) / p_direction[axis];
		p_begin = std::max(p_begin, std::min(first, second));
		p_end = std::min(p_end, std::max(first, second));
	}
	return p_begin <= p_end ? std::optional<double>(p_begin) : std::nullopt;
}

RayTree::RayTree(std::shared_ptr<const Mesh> p_mesh) :
		mesh(std::move(p_mesh)), tree(compute_triangle_bounds(*mesh)) {}

std::optional<double> RayTree::find_nearest(
		const glm::dvec3 &p_origin_node, const glm::dvec3 &p_direction_node, double p_begin) const {
	const double length = glm::length(p_direction_node);
	if (!(length > 0.0 && std::isfinite(length)) || tree.get_nodes().empty()) {
		return std::nullopt;
	}
	double nearest = std::numeric_limits<double>::infinity();
	std::vector<uint32_t> stack = { 0 };
	while (!stack.empty()) {
		const Bvh::Node &node = tree.get_nodes()[stack.back()];
		stack.pop_back();
		if (!find_box_entry(node.bounds, p_origin_node, p_direction_node, p_begin, nearest)) {
			continue;
		}
		if (node.item_count == 0) {
			stack.push_back(node.first);
			stack.push_back(node.first + 1);
			continue;
		}
		for (uint32_t item = 0; item < node.item_count; ++item) {
			const std::optional<double> hit = find_triangle_hit(
					*mesh, tree.get_items()[node.first + item], p_origin_node, p_direction_node);
			if (hit && *hit > p_begin && *hit < nearest) {
				nearest = *hit;
			}
		}
	}
	return std::isfinite(nearest) ? std::optional<double>(nearest) : std::nullopt;
}

} // namespace gnomon
