#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace gnomon {

/// Disjoint sets of faces (union-find). The root of a set is its lowest index, so that every parent
/// comes before its children.
class FaceSets {
public:
	explicit FaceSets(uint32_t p_face_count) : parents(p_face_count) {
		std::iota(parents.begin(), parents.end(), 0u);
	}

	void join(uint32_t p_face0, uint32_t p_face1) {
		const uint32_t root0 = find_root(p_face0);
		const uint32_t root1 = find_root(p_face1);
		parents[std::max(root0, root1)] = std::min(root0, root1);
	}

	/// Assigns indices to the sets, in the order of their first face, and stores for each face the
	/// index of its set. Returns the count of sets.
	uint32_t assign_indices(std::vector<uint32_t> &r_indices) const {
		uint32_t count = 0;
		r_indices.resize(parents.size());
		for (uint32_t face = 0; face < parents.size(); ++face) {
			r_indices[face] = parents[face] == face ? count++ : r_indices[parents[face]];
		}
		return count;
	}

private:
	std::vector<uint32_t> parents;

	uint32_t find_root(uint32_t p_face) {
		while (parents[p_face] != p_face) {
			parents[p_face] = parents[parents[p_face]];
			p_face = parents[p_face];
		}
		return p_face;
	}
};

} // namespace gnomon
