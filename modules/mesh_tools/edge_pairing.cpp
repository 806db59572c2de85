#include "modules/mesh_tools/edge_pairing.h"

#include "modules/mesh_tools/topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gnomon {

namespace {

/// Computes two unit vectors that form a right-handed orthogonal frame with p_direction.
void compute_frame(const glm::dvec3 &p_direction, glm::dvec3 &r_x, glm::dvec3 &r_y) {
	const glm::dvec3 size = glm::abs(p_direction);
	glm::dvec3 helper(0.0);
	helper[size.x <= size.y && size.x <= size.z ? 0 : (size.y <= size.z ? 1 : 2)] = 1.0;
	r_x = glm::normalize(glm::cross(helper, p_direction));
	r_y = glm::normalize(glm::cross(p_direction, r_x));
}

} // namespace

std::vector<FacePair> pair_faces_at_edge(
		const glm::dvec3 &p_edge_direction, std::span<const EdgeFace> p_faces) {
	glm::dvec3 x;
	glm::dvec3 y;
	compute_frame(p_edge_direction, x, y);
	std::vector<double> angles_rad(p_faces.size());
	for (size_t i = 0; i < p_faces.size(); ++i) {
		angles_rad[i] = std::atan2(
				glm::dot(p_faces[i].toward_face, y), glm::dot(p_faces[i].toward_face, x));
	}
	std::vector<uint32_t> order(p_faces.size());
	std::iota(order.begin(), order.end(), 0u);
	std::sort(order.begin(), order.end(), [&](uint32_t p_left, uint32_t p_right) {
		if (angles_rad[p_left] != angles_rad[p_right]) {
			return angles_rad[p_left] < angles_rad[p_right];
		}
		// Faces at the same angle, such as the two sides of a double-sided face, enclose an empty
		// wedge and not the full circle.
		if (p_faces[p_left].runs_along != p_faces[p_right].runs_along) {
			return !p_faces[p_left].runs_along;
		}
		return p_left < p_right;
	});

	// The front of a face that runs along the edge points toward larger angles, so the inside is at
	// smaller angles; for the other faces it is at larger angles. The others are therefore opening
	// brackets and the faces that run along the edge are closing brackets, on a circle: the second
	// round closes the wedges that contain the angle +-pi.
	std::vector<FacePair> pairs;
	std::vector<bool> is_paired(p_faces.size(), false);
	std::vector<uint32_t> open;
	for (int round = 0; round < 2; ++round) {
		for (const uint32_t face : order) {
			if (is_paired[face]) {
				continue;
			}
			if (!p_faces[face].runs_along) {
				if (round == 0) {
					open.push_back(face);
				}
			} else if (!open.empty()) {
				pairs.push_back({ std::min(open.back(), face), std::max(open.back(), face) });
				is_paired[face] = true;
				is_paired[open.back()] = true;
				open.pop_back();
			}
		}
	}
	uint32_t unpaired_face = NO_FACE;
	for (const uint32_t face : order) {
		if (is_paired[face]) {
			continue;
		}
		if (unpaired_face == NO_FACE) {
			unpaired_face = face;
		} else {
			pairs.push_back({ unpaired_face, face });
			unpaired_face = NO_FACE;
		}
	}
	if (unpaired_face != NO_FACE) {
		pairs.push_back({ unpaired_face, NO_FACE });
	}
	return pairs;
}

} // namespace gnomon
