#pragma once

#include "tests/test_random.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon::test_meshes {

/// Splits a random side of a random triangle, p_count times: at a point within p_height of the
/// side, for the triangle on one side of it alone. A sliver with the side's two ends and the point
/// fills the gap, so that a closed mesh remains closed.
inline void add_slivers(uint32_t p_count, double p_height, TestRandom &r_random,
		std::vector<glm::vec3> &r_positions, std::vector<uint32_t> &r_indices) {
	for (uint32_t i = 0; i < p_count; ++i) {
		const uint32_t face = uint32_t(r_random.next() * double(r_indices.size() / 3));
		const uint32_t side = uint32_t(r_random.next(0, 3));
		const uint32_t a = r_indices[3 * face + side];
		const uint32_t b = r_indices[3 * face + (side + 1) % 3];
		const uint32_t c = r_indices[3 * face + (side + 2) % 3];
		const glm::dvec3 middle = glm::mix(
				glm::dvec3(r_positions[a]), glm::dvec3(r_positions[b]), r_random.next(0.2, 0.8));
		const uint32_t split = uint32_t(r_positions.size());
		r_positions.emplace_back(middle + p_height * r_random.next_unit());
		r_indices[3 * face] = a;
		r_indices[3 * face + 1] = split;
		r_indices[3 * face + 2] = c;
		r_indices.insert(r_indices.end(), { split, b, c, a, b, split });
	}
}

} // namespace gnomon::test_meshes
