#include "modules/shadow_edge_count/layer_map.h"

#include <cmath>

namespace gnomon {

namespace {

const double BURIED_PX = 1.0 / 128.0; // twice the rasteriser's 8 bits of a texel

/// Distance of a point to a segment, all in texels.
double compute_distance(
		const glm::dvec2 &p_point, const glm::dvec2 &p_from, const glm::dvec2 &p_to) {
	const glm::dvec2 way = p_to - p_from;
	const double square = glm::dot(way, way);
	const double share =
			square > 0 ? glm::clamp(glm::dot(p_point - p_from, way) / square, 0.0, 1.0) : 0.0;
	return glm::length(p_point - p_from - way * share);
}

/// An edge that a texel's centre lies on belongs to one of its two triangles: the one that runs it
/// upwards, or to the left.
bool is_on_own_edge(const glm::dvec2 &p_way) {
	return p_way.y < 0 || (p_way.y == 0 && p_way.x < 0);
}

} // namespace

LayerMap::LayerMap(
		const CountSpace &p_space, const glm::dvec2 &p_half_extent, const glm::uvec2 &p_size_px) :
		space(p_space),
		half_extent(p_half_extent), size_px(p_size_px),
		fragments(size_t(p_size_px.x) * p_size_px.y), buried(fragments.size(), 0) {}

void LayerMap::add_triangle(
		const glm::dvec3 (&p_corners)[3], const glm::dvec4 &p_plane, bool p_is_double_sided) {
	glm::dvec2 points[3];
	for (int index = 0; index < 3; ++index) {
		points[index] = to_texels(glm::dvec2(space.warp(p_corners[index])));
	}
	const double area = cross(points[1] - points[0], points[2] - points[0]);
	if (area == 0) {
		return;
	}
	if (area < 0) {
		std::swap(points[1], points[2]);
	}
	glm::dvec2 lowest = glm::min(points[0], glm::min(points[1], points[2])) - 0.5;
	glm::dvec2 highest = glm::max(points[0], glm::max(points[1], points[2])) - 0.5;
	lowest = glm::max(glm::ceil(lowest), glm::dvec2(0.0));
	highest = glm::min(glm::floor(highest), glm::dvec2(size_px) - 1.0);
	const bool is_away = space.get_light_side(p_plane) <= 0.0;
	for (int y = int(lowest.y); y <= int(highest.y); ++y) {
		for (int x = int(lowest.x); x <= int(highest.x); ++x) {
			const glm::dvec2 center(x + 0.5, y + 0.5);
			bool is_covered = true;
			for (int index = 0; index < 3 && is_covered; ++index) {
				const glm::dvec2 way = points[(index + 1) % 3] - points[index];
				const double side = cross(way, center - points[index]);
				is_covered = side > 0 || (side == 0 && is_on_own_edge(way));
			}
			if (!is_covered) {
				continue;
			}
			// The face's plane, solved for w: exact at the centre, however steep the face.
			const glm::dvec2 point = get_center({ x, y });
			const glm::dvec3 normal(p_plane);
			const double w = space.is_directional
					? space.depth_far_m +
							(glm::dot(glm::dvec2(normal), point) + p_plane.w) / normal.z
					: -(glm::dot(glm::dvec2(normal), point) + normal.z) / p_plane.w;
			if (std::isfinite(w)) {
				fragments[get_index({ x, y })].push_back({ w, is_away, p_is_double_sided });
			}
		}
	}
}

void LayerMap::add_mesh(const MeshTopology &p_topology, const glm::dmat4 &p_view_from_node) {
	const std::vector<glm::dvec4> planes = compute_view_planes(p_topology, p_view_from_node);
	for (size_t face = 0; face < planes.size(); ++face) {
		// Cut at the near plane into at most four corners.
		std::vector<glm::dvec3> corners;
		glm::dvec3 own[3];
		for (size_t index = 0; index < 3; ++index) {
			const uint32_t vertex = p_topology.triangles[3 * face + index];
			own[index] = glm::dvec3(
					p_view_from_node * glm::dvec4(p_topology.welded_positions_node[vertex], 1.0));
		}
		for (size_t index = 0; index < 3; ++index) {
			const glm::dvec3 &from = own[index];
			const glm::dvec3 &to = own[(index + 1) % 3];
			const bool is_kept = space.is_directional || from.z >= space.near_m;
			const bool is_next_kept = space.is_directional || to.z >= space.near_m;
			if (is_kept) {
				corners.push_back(from);
			}
			if (is_kept != is_next_kept) {
				corners.push_back(glm::mix(from, to, (space.near_m - from.z) / (to.z - from.z)));
			}
		}
		for (size_t index = 2; index < corners.size(); ++index) {
			add_triangle({ corners[0], corners[index - 1], corners[index] }, planes[face],
					p_topology.is_double_sided());
		}
	}
}

void LayerMap::mark_buried(const std::vector<CountEdge> &p_edges) {
	for (const CountEdge &edge : p_edges) {
		if (!edge.is_center_silhouette()) {
			continue;
		}
		const glm::dvec2 from = to_texels(glm::dvec2(edge.a));
		const glm::dvec2 to = to_texels(glm::dvec2(edge.b));
		const glm::dvec2 lowest = glm::max(glm::floor(glm::min(from, to) - 1.0), glm::dvec2(0.0));
		const glm::dvec2 highest =
				glm::min(glm::ceil(glm::max(from, to)), glm::dvec2(size_px) - 1.0);
		for (int y = int(lowest.y); y <= int(highest.y); ++y) {
			for (int x = int(lowest.x); x <= int(highest.x); ++x) {
				if (compute_distance(glm::dvec2(x + 0.5, y + 0.5), from, to) <= BURIED_PX) {
					buried[get_index({ x, y })] = 1;
				}
			}
		}
	}
}

} // namespace gnomon
