#include "modules/shadow_edge_count/count_edges.h"

#include <cmath>

namespace gnomon {

namespace {

const double SIDE_TOLERANCE_SIZES = 2.5e-7; // of S: what rounding may move a face's plane
const double SIDE_TOLERANCE_COSINE = 1e-6;	// likewise, directional

/// +1 when the whole light lies in front of the face, -1 when behind it, 0 when it is divided.
int find_light_side(const CountSpace &p_space, const glm::dvec4 &p_plane) {
	const double reach =
			p_space.disc_radius * (p_space.is_directional ? glm::length(glm::dvec2(p_plane)) : 1.0);
	const double tolerance = p_space.is_directional ? SIDE_TOLERANCE_COSINE
													: SIDE_TOLERANCE_SIZES * p_space.scene_size_m;
	const double side = p_space.get_light_side(p_plane);
	return side > reach + tolerance ? 1 : side < -reach - tolerance ? -1 : 0;
}

int sum_weights(const CountEdge &p_edge, bool p_is_facing0, bool p_is_facing1) {
	const int first = p_is_facing0 ? 1 : -1;
	if (!p_edge.has_face1) {
		return first;
	}
	const int sum = first - (p_is_facing1 ? 1 : -1);
	return p_edge.is_double_sided ? sum : sum / 2;
}

/// Moves ends that lie before the near plane, or too far aside, to where they do no more. False
/// where nothing is left.
bool clip_edge(const CountSpace &p_space, glm::dvec3 &r_a, glm::dvec3 &r_b) {
	double begin = 0;
	double end = 1;
	const auto keep = [&](double p_at_a, double p_at_b) {
		if (p_at_a < 0 && p_at_b < 0) {
			begin = 2;
		} else if (p_at_a < 0) {
			begin = std::max(begin, p_at_a / (p_at_a - p_at_b));
		} else if (p_at_b < 0) {
			end = std::min(end, p_at_a / (p_at_a - p_at_b));
		}
	};
	keep(r_a.z - p_space.near_m, r_b.z - p_space.near_m);
	for (int axis = 0; axis < 2; ++axis) {
		for (const double slope : { -p_space.least_slope, p_space.least_slope }) {
			keep(r_a.z - slope * r_a[axis], r_b.z - slope * r_b[axis]);
		}
	}
	const glm::dvec3 a = r_a;
	if (begin > 0) {
		r_a = glm::mix(a, r_b, begin);
		r_a.z = p_space.get_least_z(r_a);
	}
	if (end < 1) {
		r_b = glm::mix(a, r_b, end);
		r_b.z = p_space.get_least_z(r_b);
	}
	return begin <= end;
}

} // namespace

int CountEdge::compute_weight(const glm::dvec3 &p_r) const {
	const auto is_facing = [&](const glm::dvec4 &p_plane) {
		return glm::dot(glm::dvec3(p_plane), p_r) + p_plane.w > 0.0;
	};
	return sum_weights(*this, is_facing(plane0), is_facing(plane1));
}

std::vector<glm::dvec4> compute_view_planes(
		const MeshTopology &p_topology, const glm::dmat4 &p_view_from_node) {
	std::vector<glm::dvec4> planes(p_topology.get_face_count(), glm::dvec4(0.0));
	const bool is_mirrored = glm::determinant(glm::dmat3(p_view_from_node)) < 0;
	for (size_t face = 0; face < planes.size(); ++face) {
		glm::dvec3 corners[3];
		for (size_t index = 0; index < 3; ++index) {
			corners[index] = glm::dvec3(p_view_from_node *
					glm::dvec4(
							p_topology
									.welded_positions_node[p_topology.triangles[3 * face + index]],
							1.0));
		}
		glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
		const double length = glm::length(normal);
		if (length > 0) {
			normal *= (is_mirrored ? -1.0 : 1.0) / length;
			planes[face] = glm::dvec4(normal, -glm::dot(normal, corners[0]));
		}
	}
	return planes;
}

void add_count_edges(const MeshTopology &p_topology, const glm::dmat4 &p_view_from_node,
		const CountSpace &p_space, std::vector<CountEdge> &r_edges) {
	const std::vector<glm::dvec4> planes = compute_view_planes(p_topology, p_view_from_node);
	const bool is_mirrored = glm::determinant(glm::dmat3(p_view_from_node)) < 0;
	const auto to_view = [&](uint32_t p_vertex) {
		return glm::dvec3(
				p_view_from_node * glm::dvec4(p_topology.welded_positions_node[p_vertex], 1.0));
	};
	for (const MeshEdge &mesh_edge : p_topology.edges) {
		CountEdge edge;
		edge.is_double_sided = p_topology.is_double_sided();
		edge.has_face1 = mesh_edge.face1 != NO_FACE;
		edge.plane0 = planes[mesh_edge.face0];
		if (edge.has_face1) {
			edge.plane1 = planes[mesh_edge.face1] * (mesh_edge.is_inconsistent ? -1.0 : 1.0);
			const int side = find_light_side(p_space, edge.plane0);
			// Where the faces continue each other no point off their plane sees a silhouette.
			if (mesh_edge.is_coplanar ||
					(side != 0 && side == find_light_side(p_space, edge.plane1))) {
				continue;
			}
		}
		edge.center_weight = sum_weights(edge, p_space.get_light_side(edge.plane0) > 0.0,
				p_space.get_light_side(edge.plane1) > 0.0);
		glm::dvec3 a = to_view(is_mirrored ? mesh_edge.b : mesh_edge.a);
		glm::dvec3 b = to_view(is_mirrored ? mesh_edge.a : mesh_edge.b);
		if (!p_space.is_directional && !clip_edge(p_space, a, b)) {
			continue;
		}
		edge.a = p_space.warp(a);
		edge.b = p_space.warp(b);
		r_edges.push_back(edge);
	}
}

} // namespace gnomon
