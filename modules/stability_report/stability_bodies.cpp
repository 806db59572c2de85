#include "modules/stability_report/stability_draft.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace gnomon {

std::shared_ptr<const Mesh> make_sphere_mesh(double p_radius_m) {
	// An icosahedron whose triangles are split into four, twice: 20 * 4 * 4 triangles.
	const float golden = std::numbers::phi_v<float>;
	std::vector<glm::vec3> positions = { { -1, golden, 0 }, { 1, golden, 0 }, { -1, -golden, 0 },
		{ 1, -golden, 0 }, { 0, -1, golden }, { 0, 1, golden }, { 0, -1, -golden },
		{ 0, 1, -golden }, { golden, 0, -1 }, { golden, 0, 1 }, { -golden, 0, -1 },
		{ -golden, 0, 1 } };
	std::vector<uint32_t> indices = { 0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5,
		11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5,
		2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1 };
	for (int round = 0; round < 2; ++round) {
		std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
		const auto find_middle = [&](uint32_t p_a, uint32_t p_b) {
			const auto [entry, is_new] = middles.insert(
					{ { std::min(p_a, p_b), std::max(p_a, p_b) }, uint32_t(positions.size()) });
			if (is_new) {
				positions.push_back(
						glm::normalize(positions[p_a]) + glm::normalize(positions[p_b]));
			}
			return entry->second;
		};
		std::vector<uint32_t> finer;
		for (size_t index = 0; index < indices.size(); index += 3) {
			const uint32_t a = indices[index];
			const uint32_t b = indices[index + 1];
			const uint32_t c = indices[index + 2];
			const uint32_t ab = find_middle(a, b);
			const uint32_t bc = find_middle(b, c);
			const uint32_t ca = find_middle(c, a);
			finer.insert(finer.end(), { a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca });
		}
		indices = std::move(finer);
	}
	for (glm::vec3 &position : positions) {
		position = glm::normalize(position) * float(p_radius_m);
	}
	return make_mesh("globe", std::move(positions), {}, std::move(indices));
}

std::shared_ptr<const Mesh> make_cut_box(double p_half_size_m, double p_aspect_ratio) {
	const float half = float(p_half_size_m);
	const float strip = float(std::min(p_half_size_m, 2 * p_half_size_m / p_aspect_ratio));
	const float lines[] = { -half, half - strip, half };
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	for (int axis = 0; axis < 3; ++axis) {
		for (const float side : { -half, half }) {
			const uint32_t first = uint32_t(positions.size());
			for (int v = 0; v < 3; ++v) {
				for (int u = 0; u < 3; ++u) {
					glm::vec3 position;
					position[axis] = side;
					position[(axis + 1) % 3] = lines[u];
					position[(axis + 2) % 3] = lines[v];
					positions.push_back(position);
				}
			}
			for (const uint32_t corner : { 0u, 1u, 3u, 4u }) {
				// In the grid of 3 x 3 points, the next u is 1 further and the next v is 3 further.
				// The order of b and d makes the face point outwards on both sides.
				const uint32_t a = first + corner;
				const uint32_t b = side > 0 ? a + 1 : a + 3;
				const uint32_t c = a + 4;
				const uint32_t d = side > 0 ? a + 3 : a + 1;
				indices.insert(indices.end(), { a, b, c, a, c, d });
			}
		}
	}
	return make_mesh("cut box", std::move(positions), {}, std::move(indices));
}

std::shared_ptr<const Mesh> make_inside_out_box(double p_half_size_m) {
	const auto box = make_box_mesh("box", glm::vec3(float(p_half_size_m)));
	return make_mesh("inside out", box->positions_node, {},
			std::vector<uint32_t>(box->indices.rbegin(), box->indices.rend()));
}

std::shared_ptr<const Mesh> make_open_mesh() {
	return make_mesh(
			"open mesh", { { -0.3f, -1, 0 }, { 0.3f, -1, 0 }, { 0, 1.5f, 0.1f } }, {}, { 0, 1, 2 });
}

std::shared_ptr<const Mesh> make_degenerate_mesh() {
	const std::vector<glm::vec3> positions = { { 0, 0, 0 }, { 0.5f, 0, 0 }, { 1, 0, 0 },
		{ 0.25f, 0, 1e-7f }, { 0, 0, 0 }, { 0, 0, 0.5f } };
	// Triangles: on one line, a sliver, one point, two corners at one position, then a face, its
	// duplicate and its reverse.
	return make_mesh("odd", positions, std::vector<glm::vec3>(6, glm::vec3(0.0f)),
			{ 0, 1, 2, 0, 1, 3, 0, 0, 0, 0, 4, 5, 0, 1, 5, 0, 1, 5, 5, 1, 0 });
}

} // namespace gnomon
