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

/// Moves an end that is nearer than the near plane onto it. False when both are.
bool clip_near(double p_near_m, glm::dvec3 &r_a, glm::dvec3 &r_b) {
	if (r_a.z < p_near_m && r_b.z < p_near_m) {
		return false;
	}
	const auto cut = [&](const glm::dvec3 &p_from, const glm::dvec3 &p_to) {
		glm::dvec3 point = glm::mix(p_from, p_to, (p_near_m - p_from.z) / (p_to.z - p_from.z));
		point.z = p_near_m;
		return point;
	};
	if (r_a.z < p_near_m) {
		r_a = cut(r_a, r_b);
	} else if (r_b.z < p_near_m) {
		r_b = cut(r_b, r_a);
	}
	return true;
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
		if (!p_space.is_directional && !clip_near(p_space.near_m, a, b)) {
			continue;
		}
		edge.a = p_space.warp(a);
		edge.b = p_space.warp(b);
		r_edges.push_back(edge);
	}
}

} // namespace gnomon
