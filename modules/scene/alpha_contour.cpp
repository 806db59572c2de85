#include "modules/scene/alpha_contour.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace gnomon {

namespace {

const double MIN_BULGE = 4; // units from a segment: 1/64 texel, where a point is worth it
const double FULL_ALPHA_SUM = 4 * 255.0; // sum over four texels whose alpha is 1

/// The grid nodes along one axis, where alpha is sampled: the tile's two borders, the texel centres
/// between them, and one empty node outside each border, which closes contours that reach it.
class NodeAxis {
public:
	NodeAxis(uint32_t p_texel_count, TextureWrap p_wrap) :
			texel_count(p_texel_count), wrap(p_wrap) {}

	int64_t get_count() const { return int64_t(texel_count) + 4; }
	bool is_outside(int64_t p_node) const { return p_node == 0 || p_node == get_count() - 1; }
	bool is_border(int64_t p_node) const { return p_node == 1 || p_node == get_count() - 2; }
	/// Returns a node's position in units; nodes outside are at the same position as the border.
	int32_t get_position(int64_t p_node) const {
		const int64_t end = int64_t(texel_count) * CONTOUR_UNITS_PER_TEXEL;
		return static_cast<int32_t>(std::clamp<int64_t>(
				(p_node - 2) * CONTOUR_UNITS_PER_TEXEL + CONTOUR_UNITS_PER_TEXEL / 2, 0, end));
	}
	/// Returns one of the two texels whose mean is the alpha at a node: at a border those on both
	/// sides of it, otherwise twice the node's own. p_side: 0 or 1.
	uint32_t get_texel(int64_t p_node, int p_side) const {
		const int64_t first = p_node == 1 ? -1 : p_node - 2;
		return wrap_texel(first + (is_border(p_node) ? p_side - (p_node == 1 ? 0 : 1) : 0),
				texel_count, wrap);
	}

private:
	uint32_t texel_count;
	TextureWrap wrap;
};

/// Marching squares over the nodes of one tile.
class ContourFinder {
public:
	explicit ContourFinder(const AlphaTest &p_test) :
			image(*p_test.image), threshold(p_test.cutoff * FULL_ALPHA_SUM),
			columns(image.size_px.x, p_test.wrap_u), rows(image.size_px.y, p_test.wrap_v) {}

	/// Returns nullopt if there are more segments than allowed.
	std::optional<std::vector<PolygonLoop>> find(size_t p_max_segments);

private:
	struct Link {
		uint64_t to = 0;				  // edge of the grid where the segment ends
		glm::ivec2 point = glm::ivec2(0); // where the segment begins
		/// A point of the contour between its ends, which bulges from the segment.
		std::optional<glm::ivec2> middle = std::nullopt;
	};

	/// Returns four times the alpha at a node, the sum over the texels around it: 0..1020; below 0
	/// outside the border.
	int get_alpha(int64_t p_x, int64_t p_y) const;
	bool is_inside(int p_alpha) const { return p_alpha >= 0 && p_alpha >= threshold; }
	void read_row(int64_t p_y, std::vector<int> &r_row) const;
	/// Adds the contour's segments in a cell. p_alphas: of its corners.
	void add_cell(int64_t p_x, int64_t p_y, const int p_alphas[4]);
	/// Returns the index, in the whole grid, of a side of the cell whose first node is (p_x, p_y).
	uint64_t get_edge(int64_t p_x, int64_t p_y, int p_side) const;
	glm::ivec2 compute_crossing(int64_t p_x, int64_t p_y, int p_side, const int p_alphas[4]) const;
	/// Finds the contour's point on the perpendicular bisector of a segment: interpolated alpha has
	/// hyperbolas as contours. Returns nullopt if it is nearer than MIN_BULGE. p_saddle: where the
	/// asymptotes cross, 0..1 within the cell, if both branches of the hyperbola are in it.
	std::optional<glm::ivec2> find_middle(int64_t p_x, int64_t p_y, const int p_alphas[4],
			const glm::ivec2 &p_begin, const glm::ivec2 &p_end,
			const std::optional<glm::dvec2> &p_saddle) const;
	std::vector<PolygonLoop> link_loops();

	const Image &image;
	double threshold; // of the sum of four texels
	NodeAxis columns;
	NodeAxis rows;
	std::unordered_map<uint64_t, Link> links; // by the edge of the grid where they begin
};

// Corners and sides of a cell: side i goes from corner i to corner i + 1.
const int CORNER_X[] = { 0, 1, 1, 0 };
const int CORNER_Y[] = { 0, 0, 1, 1 };

int ContourFinder::get_alpha(int64_t p_x, int64_t p_y) const {
	if (columns.is_outside(p_x) || rows.is_outside(p_y)) {
		return -1;
	}
	if (!columns.is_border(p_x) && !rows.is_border(p_y)) { // at a texel's centre
		return 4 *
				image.get_texel(static_cast<uint32_t>(p_x - 2), static_cast<uint32_t>(p_y - 2))[3];
	}
	int sum = 0;
	for (const int side_y : { 0, 1 }) {
		for (const int side_x : { 0, 1 }) {
			sum += image.get_texel(columns.get_texel(p_x, side_x), rows.get_texel(p_y, side_y))[3];
		}
	}
	return sum;
}

void ContourFinder::read_row(int64_t p_y, std::vector<int> &r_row) const {
	for (int64_t x = 0; x < columns.get_count(); ++x) {
		r_row[x] = get_alpha(x, p_y);
	}
}

uint64_t ContourFinder::get_edge(int64_t p_x, int64_t p_y, int p_side) const {
	const int64_t x = p_x + (p_side == 1 ? 1 : 0);
	const int64_t y = p_y + (p_side == 2 ? 1 : 0);
	return (uint64_t(y) * uint64_t(columns.get_count()) + uint64_t(x)) * 2 + (p_side % 2);
}

glm::ivec2 ContourFinder::compute_crossing(
		int64_t p_x, int64_t p_y, int p_side, const int p_alphas[4]) const {
	// Goes from the lower node to the upper one, so that both cells at an edge compute the same.
	int from = p_side;
	int to = (p_side + 1) % 4;
	if (CORNER_X[from] + CORNER_Y[from] > CORNER_X[to] + CORNER_Y[to]) {
		std::swap(from, to);
	}
	const glm::ivec2 a(
			columns.get_position(p_x + CORNER_X[from]), rows.get_position(p_y + CORNER_Y[from]));
	const glm::ivec2 b(
			columns.get_position(p_x + CORNER_X[to]), rows.get_position(p_y + CORNER_Y[to]));
	const int length = (b.x - a.x) + (b.y - a.y);
	if (length == 0 || p_alphas[from] < 0 || p_alphas[to] < 0) { // closes the contour at a border
		return p_alphas[from] < 0 ? b : a;
	}
	const double fraction =
			(threshold - p_alphas[from]) / (double(p_alphas[to]) - double(p_alphas[from]));
	// Never at a node, where lines could touch.
	const int offset = std::clamp(static_cast<int>(std::lround(fraction * length)), 1, length - 1);
	return b.x > a.x ? glm::ivec2(a.x + offset, a.y) : glm::ivec2(a.x, a.y + offset);
}

std::optional<glm::ivec2> ContourFinder::find_middle(int64_t p_x, int64_t p_y,
		const int p_alphas[4], const glm::ivec2 &p_begin, const glm::ivec2 &p_end,
		const std::optional<glm::dvec2> &p_saddle) const {
	const glm::ivec2 low(columns.get_position(p_x), rows.get_position(p_y));
	const glm::ivec2 high(columns.get_position(p_x + 1), rows.get_position(p_y + 1));
	if (std::min({ p_alphas[0], p_alphas[1], p_alphas[2], p_alphas[3] }) < 0 ||
			glm::any(glm::lessThanEqual(high - low, glm::ivec2(2)))) {
		return std::nullopt; // beyond a border
	}
	const glm::dvec2 chord(p_end - p_begin);
	const glm::dvec2 middle = glm::dvec2(p_begin + p_end) * 0.5;
	const glm::dvec2 across = glm::dvec2(-chord.y, chord.x) / std::max(glm::length(chord), 1.0);
	const auto compute_alpha = [&](const glm::dvec2 &p_point) {
		const glm::dvec2 at = (p_point - glm::dvec2(low)) / glm::dvec2(high - low);
		return glm::mix(glm::mix(double(p_alphas[0]), double(p_alphas[1]), at.x),
				glm::mix(double(p_alphas[3]), double(p_alphas[2]), at.x), at.y);
	};
	const int MAX_STEPS = 4; // Newton's method, with the slope of a step of one unit
	double offset = 0;
	for (int step = 0; step < MAX_STEPS; ++step) {
		const double alpha = compute_alpha(middle + across * offset);
		const double slope = compute_alpha(middle + across * (offset + 1)) - alpha;
		offset += std::abs(slope) > 0.01 ? (threshold - alpha) / slope : 0;
	}
	glm::dvec2 position = middle + across * offset;
	if (p_saddle) { // the hyperbola's two branches must not meet when they are rounded
		const glm::dvec2 saddle = glm::mix(glm::dvec2(low), glm::dvec2(high), *p_saddle);
		const glm::dvec2 side = glm::sign(middle - saddle);
		position = saddle + side * glm::max((position - saddle) * side, glm::dvec2(2));
	}
	const glm::ivec2 point(glm::round(position));
	const bool is_inside_cell =
			glm::all(glm::greaterThan(point, low)) && glm::all(glm::lessThan(point, high));
	return is_inside_cell && std::abs(offset) >= MIN_BULGE ? std::optional(point) : std::nullopt;
}

void ContourFinder::add_cell(int64_t p_x, int64_t p_y, const int p_alphas[4]) {
	bool inside[4];
	for (int corner = 0; corner < 4; ++corner) {
		inside[corner] = is_inside(p_alphas[corner]);
	}
	const bool is_saddle =
			inside[0] == inside[2] && inside[1] == inside[3] && inside[0] != inside[1];
	// The alpha where the hyperbola's asymptotes cross decides (Nielson and Hamann 1991).
	std::optional<glm::dvec2> saddle;
	bool is_joined = false;
	if (is_saddle) {
		const double bend = double(p_alphas[0]) + p_alphas[2] - p_alphas[1] - p_alphas[3];
		saddle = glm::dvec2(p_alphas[0] - p_alphas[3], p_alphas[0] - p_alphas[1]) / bend;
		const double alpha =
				(double(p_alphas[0]) * p_alphas[2] - double(p_alphas[1]) * p_alphas[3]) / bend;
		is_joined = alpha >= threshold;
	}
	for (int side = 0; side < 4; ++side) {
		if (!inside[side] || inside[(side + 1) % 4]) {
			continue;
		}
		// The segment begins where a run of inside corners ends. It ends where that run began or,
		// in a joined saddle, where the next run begins.
		int end = side;
		do {
			end = (end + (is_joined ? 1 : 3)) % 4;
		} while (inside[end] || !inside[(end + 1) % 4]);
		Link &link = links[get_edge(p_x, p_y, side)];
		link.to = get_edge(p_x, p_y, end);
		link.point = compute_crossing(p_x, p_y, side, p_alphas);
		link.middle = find_middle(
				p_x, p_y, p_alphas, link.point, compute_crossing(p_x, p_y, end, p_alphas), saddle);
	}
}

std::optional<std::vector<PolygonLoop>> ContourFinder::find(size_t p_max_segments) {
	std::vector<int> lower(columns.get_count());
	std::vector<int> upper(columns.get_count());
	read_row(0, lower);
	for (int64_t y = 0; y + 1 < rows.get_count(); ++y) {
		read_row(y + 1, upper);
		for (int64_t x = 0; x + 1 < columns.get_count(); ++x) {
			const int alphas[4] = { lower[x], lower[x + 1], upper[x + 1], upper[x] };
			const bool first = is_inside(alphas[0]);
			if (is_inside(alphas[1]) != first || is_inside(alphas[2]) != first ||
					is_inside(alphas[3]) != first) {
				add_cell(x, y, alphas);
			}
		}
		if (links.size() > p_max_segments) {
			return std::nullopt;
		}
		lower.swap(upper);
	}
	return link_loops();
}

std::vector<PolygonLoop> ContourFinder::link_loops() {
	std::vector<uint64_t> begins;
	for (const auto &[begin, link] : links) {
		begins.push_back(begin);
	}
	std::sort(begins.begin(), begins.end()); // the order of the map is not deterministic
	std::vector<PolygonLoop> loops;
	for (const uint64_t begin : begins) {
		PolygonLoop loop;
		uint64_t at = begin;
		for (auto found = links.find(at); found != links.end(); found = links.find(at)) {
			if (loop.empty() || loop.back() != found->second.point) {
				loop.push_back(found->second.point);
			}
			if (found->second.middle) {
				loop.push_back(*found->second.middle);
			}
			at = found->second.to;
			links.erase(found);
		}
		while (loop.size() > 1 && loop.front() == loop.back()) {
			loop.pop_back();
		}
		if (loop.size() >= 3) {
			loops.push_back(std::move(loop));
		}
	}
	return loops;
}

/// Traces the borders of a nearest sampler's region, along the sides of texels.
class TexelBorderFinder {
public:
	explicit TexelBorderFinder(const AlphaTest &p_test) :
			image(*p_test.image), threshold(p_test.cutoff * 255.0) {}

	std::optional<std::vector<PolygonLoop>> find(size_t p_max_segments);

private:
	bool is_inside(int64_t p_x, int64_t p_y) const {
		return p_x >= 0 && p_y >= 0 && p_x < image.size_px.x && p_y < image.size_px.y &&
				image.get_texel(static_cast<uint32_t>(p_x), static_cast<uint32_t>(p_y))[3] >=
				threshold;
	}
	/// Whether the region's border runs from a texel's corner in DIRECTIONS[p_direction], with the
	/// region to its left (y upwards, as in PolygonLoop).
	bool is_border(const glm::ivec2 &p_corner, int p_direction) const;
	/// Traces a loop from a corner with a border in DIRECTIONS[0]. r_visited_directions: see find.
	PolygonLoop trace_loop(glm::ivec2 p_corner, std::vector<uint8_t> &r_visited_directions) const;
	size_t get_index(const glm::ivec2 &p_corner) const {
		return size_t(p_corner.y) * (image.size_px.x + 1) + p_corner.x;
	}

	const Image &image;
	double threshold;
};

const glm::ivec2 DIRECTIONS[] = { { 1, 0 }, { 0, 1 }, { -1, 0 }, { 0, -1 } };

bool TexelBorderFinder::is_border(const glm::ivec2 &p_corner, int p_direction) const {
	// Offset from the corner to the texel on the left, by direction.
	const glm::ivec2 LEFT[] = { { 0, 0 }, { -1, 0 }, { -1, -1 }, { 0, -1 } };
	const glm::ivec2 left = p_corner + LEFT[p_direction];
	const glm::ivec2 right = p_corner + LEFT[(p_direction + 3) % 4];
	return is_inside(left.x, left.y) && !is_inside(right.x, right.y);
}

PolygonLoop TexelBorderFinder::trace_loop(
		glm::ivec2 p_corner, std::vector<uint8_t> &r_visited_directions) const {
	PolygonLoop loop;
	int direction = 0; // every loop has a side in that direction, or it would not close
	while (!(r_visited_directions[get_index(p_corner)] & (1 << direction))) {
		r_visited_directions[get_index(p_corner)] |= static_cast<uint8_t>(1 << direction);
		p_corner += DIRECTIONS[direction];
		const int left = (direction + 1) % 4;
		const int right = (direction + 3) % 4;
		const glm::ivec2 position = p_corner * CONTOUR_UNITS_PER_TEXEL;
		if (is_border(p_corner, left)) {
			if (is_border(p_corner, right)) { // two texels touch at a corner: separate them
				loop.push_back(position - DIRECTIONS[direction]);
				loop.push_back(position + DIRECTIONS[left]);
			} else {
				loop.push_back(position);
			}
			direction = left;
		} else if (is_border(p_corner, right)) {
			loop.push_back(position);
			direction = right;
		}
	}
	return loop;
}

std::optional<std::vector<PolygonLoop>> TexelBorderFinder::find(size_t p_max_segments) {
	const glm::ivec2 size(image.size_px);
	// Per corner: bit i is set if the border that leaves it in DIRECTIONS[i] has been traced.
	std::vector<uint8_t> visited_directions(size_t(size.x + 1) * size_t(size.y + 1));
	std::vector<PolygonLoop> loops;
	size_t segment_count = 0;
	for (int y = 0; y < size.y; ++y) {
		for (int x = 0; x < size.x; ++x) {
			const glm::ivec2 corner(x, y);
			if (!is_border(corner, 0) || visited_directions[get_index(corner)] & 1) {
				continue;
			}
			loops.push_back(trace_loop(corner, visited_directions));
			segment_count += loops.back().size();
			if (segment_count > p_max_segments) {
				return std::nullopt;
			}
		}
	}
	return loops;
}

} // namespace

std::optional<std::vector<PolygonLoop>> find_alpha_contour(
		const AlphaTest &p_test, size_t p_max_segments) {
	return ContourFinder(p_test).find(p_max_segments);
}

std::optional<std::vector<PolygonLoop>> find_alpha_squares(
		const AlphaTest &p_test, size_t p_max_segments) {
	return TexelBorderFinder(p_test).find(p_max_segments);
}

} // namespace gnomon
