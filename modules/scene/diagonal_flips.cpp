#include "modules/scene/diagonal_flips.h"

#include "modules/scene/polygon_triangulation.h"

#include <map>
#include <utility>

namespace gnomon {

namespace {

// Each flip reduces the sum of lengths, so flipping always ends; this bounds the time of hostile
// outlines. After it, triangles stay valid, but not all diagonals are short.
const size_t MAX_FLIPS_PER_POINT = 64;
const size_t NO_SIDE = SIZE_MAX;

/// Triangle t has the sides 3 t + i, from its corner i to the next one.
class DiagonalFlips {
public:
	DiagonalFlips(std::span<const glm::ivec2> p_points, std::vector<uint32_t> &r_triangles);
	void run();

private:
	/// Returns the side that follows p_side after p_steps in the same triangle.
	static size_t step(size_t p_side, size_t p_steps) {
		return p_side - p_side % 3 + (p_side + p_steps) % 3;
	}
	uint32_t get_corner(size_t p_side) const { return triangles[p_side]; }
	bool is_better_flipped(size_t p_side) const;
	void flip(size_t p_side);
	void set_side(size_t p_side, uint32_t p_corner, size_t p_opposite);

	std::span<const glm::ivec2> points;
	std::vector<uint32_t> &triangles;
	std::vector<size_t> opposite; // per side: the same diagonal in the other triangle, or NO_SIDE
	std::vector<size_t> pending;  // sides to check
};

DiagonalFlips::DiagonalFlips(
		std::span<const glm::ivec2> p_points, std::vector<uint32_t> &r_triangles) :
		points(p_points),
		triangles(r_triangles), opposite(r_triangles.size(), NO_SIDE) {
	std::map<std::pair<uint32_t, uint32_t>, size_t> sides;
	for (size_t side = 0; side < triangles.size(); ++side) {
		const uint32_t from = get_corner(side);
		const uint32_t to = get_corner(step(side, 1));
		sides[{ from, to }] = side;
		const auto found = sides.find({ to, from });
		if (found != sides.end()) {
			opposite[side] = found->second;
			opposite[found->second] = side;
			pending.push_back(side);
		}
	}
}

bool DiagonalFlips::is_better_flipped(size_t p_side) const {
	const size_t other = opposite[p_side];
	if (other == NO_SIDE) {
		return false;
	}
	const glm::ivec2 &from = points[get_corner(p_side)];
	const glm::ivec2 &to = points[get_corner(other)];
	const glm::ivec2 &left = points[get_corner(step(p_side, 2))];
	const glm::ivec2 &right = points[get_corner(step(other, 2))];
	const auto get_square = [](const glm::ivec2 &p_a, const glm::ivec2 &p_b) {
		const int64_t x = int64_t(p_a.x) - p_b.x;
		const int64_t y = int64_t(p_a.y) - p_b.y;
		return x * x + y * y;
	};
	return get_square(left, right) < get_square(from, to) &&
			compute_twice_signed_area(left, right, to) > 0 &&
			compute_twice_signed_area(right, left, from) > 0;
}

void DiagonalFlips::set_side(size_t p_side, uint32_t p_corner, size_t p_opposite) {
	triangles[p_side] = p_corner;
	opposite[p_side] = p_opposite;
	if (p_opposite != NO_SIDE) {
		opposite[p_opposite] = p_side;
		pending.push_back(p_side);
	}
}

/// Replaces the triangles (from, to, left) and (to, from, right) by (left, right, to) and (right,
/// left, from).
void DiagonalFlips::flip(size_t p_side) {
	const size_t other = opposite[p_side];
	const uint32_t from = get_corner(p_side);
	const uint32_t to = get_corner(other);
	const uint32_t left = get_corner(step(p_side, 2));
	const uint32_t right = get_corner(step(other, 2));
	const size_t beyond_to_left = opposite[step(p_side, 1)];
	const size_t beyond_left_from = opposite[step(p_side, 2)];
	const size_t beyond_from_right = opposite[step(other, 1)];
	const size_t beyond_right_to = opposite[step(other, 2)];
	set_side(p_side, left, other);
	set_side(step(p_side, 1), right, beyond_right_to);
	set_side(step(p_side, 2), to, beyond_to_left);
	set_side(other, right, p_side);
	set_side(step(other, 1), left, beyond_left_from);
	set_side(step(other, 2), from, beyond_from_right);
}

void DiagonalFlips::run() {
	size_t flips_left = MAX_FLIPS_PER_POINT * points.size();
	while (!pending.empty() && flips_left > 0) {
		const size_t side = pending.back();
		pending.pop_back();
		if (is_better_flipped(side)) {
			flip(side);
			--flips_left;
		}
	}
}

} // namespace

void shorten_diagonals(std::span<const glm::ivec2> p_points, std::vector<uint32_t> &r_triangles) {
	DiagonalFlips(p_points, r_triangles).run();
}

} // namespace gnomon
