#include "modules/scene/alpha_outline.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/scene/loop_simplification.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

namespace gnomon {

namespace {

const int32_t UNITS = AlphaOutline::UNITS_PER_TEXEL;
// For masks that have more edges than their budget.
const double COARSE_TOLERANCES_PX[] = { 0.5, 1.0 };
const double ALPHA_SUM_OF_ONE = 4 * 255.0;
const float BLEND_CUTOFF = 0.5f;

double wrap(double p_coordinate, TextureWrap p_wrap) {
	switch (p_wrap) {
		case TextureWrap::CLAMP:
			return std::clamp(p_coordinate, 0.0, 1.0);
		case TextureWrap::REPEAT:
			return p_coordinate - std::floor(p_coordinate);
		case TextureWrap::MIRROR:
			break;
	}
	const double twice = p_coordinate / 2 - std::floor(p_coordinate / 2);
	return twice < 0.5 ? 2 * twice : 2 - 2 * twice;
}

/// The texel in place of one beyond the image's edge; p_index: -1 .. p_count.
uint32_t wrap_texel(int64_t p_index, uint32_t p_count, TextureWrap p_wrap) {
	if (p_wrap == TextureWrap::REPEAT) {
		return static_cast<uint32_t>((p_index + p_count) % p_count);
	}
	return static_cast<uint32_t>(std::clamp<int64_t>(p_index, 0, p_count - 1));
}

/// The places along one axis where alpha is looked up: the tile's border and the texels' centres,
/// and one beyond either end where nothing is there, which closes what reaches the border.
class NodeAxis {
public:
	NodeAxis(uint32_t p_texel_count, TextureWrap p_wrap) :
			texel_count(p_texel_count), wrap(p_wrap) {}

	int64_t get_count() const { return int64_t(texel_count) + 4; }
	bool is_beyond(int64_t p_node) const { return p_node == 0 || p_node == get_count() - 1; }
	bool is_border(int64_t p_node) const { return p_node == 1 || p_node == get_count() - 2; }
	int32_t get_place(int64_t p_node) const {
		const int64_t end = int64_t(texel_count) * UNITS;
		return static_cast<int32_t>(std::clamp<int64_t>((p_node - 2) * UNITS + UNITS / 2, 0, end));
	}
	/// Alpha at a node is the mean of these two texels.
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
			image(*p_test.image), threshold(p_test.cutoff * ALPHA_SUM_OF_ONE),
			columns(image.size_px.x, p_test.wrap_u), rows(image.size_px.y, p_test.wrap_v) {}

	/// Nothing: more than so many segments.
	std::optional<std::vector<PolygonLoop>> find(size_t p_most_segments);

private:
	struct Link {
		uint64_t to = 0;
		glm::ivec2 point = glm::ivec2(0); // where it begins
	};

	/// Below 0 beyond the border.
	int get_alpha(int64_t p_x, int64_t p_y) const;
	bool is_inside(int p_alpha) const { return p_alpha >= 0 && p_alpha >= threshold; }
	void read_row(int64_t p_y, std::vector<int> &r_row) const;
	void add_cell(int64_t p_x, int64_t p_y, const int p_alphas[4]);
	uint64_t get_edge(int64_t p_x, int64_t p_y, int p_side) const;
	glm::ivec2 get_crossing(int64_t p_x, int64_t p_y, int p_side, const int p_alphas[4]) const;
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
	if (columns.is_beyond(p_x) || rows.is_beyond(p_y)) {
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

glm::ivec2 ContourFinder::get_crossing(
		int64_t p_x, int64_t p_y, int p_side, const int p_alphas[4]) const {
	// From the lower node to the upper one, so that both cells at an edge find the same.
	int from = p_side;
	int to = (p_side + 1) % 4;
	if (CORNER_X[from] + CORNER_Y[from] > CORNER_X[to] + CORNER_Y[to]) {
		std::swap(from, to);
	}
	const glm::ivec2 a(
			columns.get_place(p_x + CORNER_X[from]), rows.get_place(p_y + CORNER_Y[from]));
	const glm::ivec2 b(columns.get_place(p_x + CORNER_X[to]), rows.get_place(p_y + CORNER_Y[to]));
	const int length = (b.x - a.x) + (b.y - a.y);
	if (length == 0 || p_alphas[from] < 0 || p_alphas[to] < 0) {
		return p_alphas[from] < 0 ? b : a;
	}
	const double share =
			(threshold - p_alphas[from]) / (double(p_alphas[to]) - double(p_alphas[from]));
	// Never at a node, where lines could touch.
	const int offset = std::clamp(static_cast<int>(std::lround(share * length)), 1, length - 1);
	return b.x > a.x ? glm::ivec2(a.x + offset, a.y) : glm::ivec2(a.x, a.y + offset);
}

void ContourFinder::add_cell(int64_t p_x, int64_t p_y, const int p_alphas[4]) {
	bool inside[4];
	int sum = 0;
	for (int corner = 0; corner < 4; ++corner) {
		inside[corner] = is_inside(p_alphas[corner]);
		sum += p_alphas[corner];
	}
	const bool is_saddle =
			inside[0] == inside[2] && inside[1] == inside[3] && inside[0] != inside[1];
	const bool is_joined = is_saddle && sum >= 4 * threshold;
	for (int side = 0; side < 4; ++side) {
		if (!inside[side] || inside[(side + 1) % 4]) {
			continue;
		}
		// From where the inside is left to where it began, or, across a saddle, to where it begins
		// again.
		int end = side;
		do {
			end = (end + (is_joined ? 1 : 3)) % 4;
		} while (inside[end] || !inside[(end + 1) % 4]);
		links[get_edge(p_x, p_y, side)] = { get_edge(p_x, p_y, end),
			get_crossing(p_x, p_y, side, p_alphas) };
	}
}

std::optional<std::vector<PolygonLoop>> ContourFinder::find(size_t p_most_segments) {
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
		if (links.size() > p_most_segments) {
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
	std::sort(begins.begin(), begins.end()); // the map's order is not the same everywhere
	std::vector<PolygonLoop> loops;
	for (const uint64_t begin : begins) {
		PolygonLoop loop;
		uint64_t at = begin;
		for (auto found = links.find(at); found != links.end(); found = links.find(at)) {
			if (loop.empty() || loop.back() != found->second.point) {
				loop.push_back(found->second.point);
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

/// The borders of a nearest sampler's region: along texels' sides.
class SquareFinder {
public:
	explicit SquareFinder(const AlphaTest &p_test) :
			image(*p_test.image), threshold(p_test.cutoff * 255.0) {}

	std::optional<std::vector<PolygonLoop>> find(size_t p_most_segments);

private:
	bool is_inside(int64_t p_x, int64_t p_y) const {
		return p_x >= 0 && p_y >= 0 && p_x < image.size_px.x && p_y < image.size_px.y &&
				image.get_texel(static_cast<uint32_t>(p_x), static_cast<uint32_t>(p_y))[3] >=
				threshold;
	}
	/// Whether the region's border goes from a texel's corner in a direction: it is to the left.
	bool is_border(const glm::ivec2 &p_corner, int p_direction) const;
	PolygonLoop walk(glm::ivec2 p_corner, std::vector<uint8_t> &r_is_walked) const;
	size_t get_index(const glm::ivec2 &p_corner) const {
		return size_t(p_corner.y) * (image.size_px.x + 1) + p_corner.x;
	}

	const Image &image;
	double threshold;
};

const glm::ivec2 DIRECTIONS[] = { { 1, 0 }, { 0, 1 }, { -1, 0 }, { 0, -1 } };

bool SquareFinder::is_border(const glm::ivec2 &p_corner, int p_direction) const {
	// The texels to the left and right of the way.
	const glm::ivec2 LEFT[] = { { 0, 0 }, { -1, 0 }, { -1, -1 }, { 0, -1 } };
	const glm::ivec2 left = p_corner + LEFT[p_direction];
	const glm::ivec2 right = p_corner + LEFT[(p_direction + 3) % 4];
	return is_inside(left.x, left.y) && !is_inside(right.x, right.y);
}

PolygonLoop SquareFinder::walk(glm::ivec2 p_corner, std::vector<uint8_t> &r_is_walked) const {
	PolygonLoop loop;
	int direction = 0; // every loop has a side in that direction, or it would not close
	while (!(r_is_walked[get_index(p_corner)] & (1 << direction))) {
		r_is_walked[get_index(p_corner)] |= static_cast<uint8_t>(1 << direction);
		p_corner += DIRECTIONS[direction];
		const int left = (direction + 1) % 4;
		const int right = (direction + 3) % 4;
		const glm::ivec2 place = p_corner * UNITS;
		if (is_border(p_corner, left)) {
			if (is_border(p_corner, right)) { // two texels meet in a point: they are parted there
				loop.push_back(place - DIRECTIONS[direction]);
				loop.push_back(place + DIRECTIONS[left]);
			} else {
				loop.push_back(place);
			}
			direction = left;
		} else if (is_border(p_corner, right)) {
			loop.push_back(place);
			direction = right;
		}
	}
	return loop;
}

std::optional<std::vector<PolygonLoop>> SquareFinder::find(size_t p_most_segments) {
	const glm::ivec2 size(image.size_px);
	std::vector<uint8_t> is_walked(size_t(size.x + 1) * size_t(size.y + 1));
	std::vector<PolygonLoop> loops;
	size_t segment_count = 0;
	for (int y = 0; y < size.y; ++y) {
		for (int x = 0; x < size.x; ++x) {
			const glm::ivec2 corner(x, y);
			if (!is_border(corner, 0) || is_walked[get_index(corner)] & 1) {
				continue;
			}
			loops.push_back(walk(corner, is_walked));
			segment_count += loops.back().size();
			if (segment_count > p_most_segments) {
				return std::nullopt;
			}
		}
	}
	return loops;
}

size_t count_points(const std::vector<PolygonLoop> &p_loops) {
	size_t count = 0;
	for (const PolygonLoop &loop : p_loops) {
		count += loop.size();
	}
	return count;
}

/// False: the loops have more edges than that, or cannot be filled.
bool fill(std::vector<PolygonLoop> p_loops, uint32_t p_edge_budget, AlphaOutline &r_outline) {
	const size_t count = count_points(p_loops);
	if (count > p_edge_budget) {
		return false;
	}
	r_outline.triangles = triangulate(p_loops);
	r_outline.edge_count = static_cast<uint32_t>(count);
	for (const PolygonLoop &loop : p_loops) {
		r_outline.points.insert(r_outline.points.end(), loop.begin(), loop.end());
	}
	return count == 0 || !r_outline.triangles.empty();
}

const uint32_t ONE_HOLE_EDGES = 8; // of a tile with a hole

/// Of each block of texels a square or a square hole that has as much area as the mask has there.
class HalfTone {
public:
	HalfTone(const AlphaTest &p_test, uint32_t p_block_size_px) :
			test(p_test), block(p_block_size_px), size(glm::ivec2(p_test.image->size_px) * UNITS),
			count((p_test.image->size_px + block - 1u) / block) {}

	bool is_one_block() const { return count == glm::uvec2(1); }
	/// Nothing: more than so many edges.
	std::optional<std::vector<PolygonLoop>> find(size_t p_most_edges) const;

private:
	/// Of a block's area, that is there.
	double compute_share(const glm::uvec2 &p_block) const;
	PolygonLoop make_square(const glm::uvec2 &p_block, double p_share) const;
	glm::ivec2 get_corner(const glm::ivec2 &p_block) const {
		return glm::min(p_block * static_cast<int32_t>(block) * UNITS, size);
	}

	const AlphaTest &test;
	uint32_t block;
	glm::ivec2 size; // of the tile in units
	glm::uvec2 count;
};

double HalfTone::compute_share(const glm::uvec2 &p_block) const {
	const Image &image = *test.image;
	const glm::uvec2 begin = p_block * block;
	const glm::uvec2 end = glm::min(begin + block, image.size_px);
	uint32_t inside = 0;
	for (uint32_t y = begin.y; y < end.y; ++y) {
		for (uint32_t x = begin.x; x < end.x; ++x) {
			inside += image.get_texel(x, y)[3] >= test.cutoff * 255.0 ? 1 : 0;
		}
	}
	return double(inside) / (double(end.x - begin.x) * (end.y - begin.y));
}

PolygonLoop HalfTone::make_square(const glm::uvec2 &p_block, double p_share) const {
	const glm::ivec2 begin = get_corner(glm::ivec2(p_block));
	const glm::ivec2 end = get_corner(glm::ivec2(p_block) + 1);
	const bool is_hole = p_share >= 0.5;
	const glm::dvec2 half =
			glm::dvec2(end - begin) * 0.5 * std::sqrt(is_hole ? 1 - p_share : p_share);
	const glm::ivec2 middle = (begin + end) / 2;
	const glm::ivec2 inner = glm::max(glm::ivec2(glm::round(half)), 1);
	PolygonLoop loop;
	for (int corner = 0; corner < 4; ++corner) {
		loop.push_back(
				middle + inner * glm::ivec2(CORNER_X[corner] ? 1 : -1, CORNER_Y[corner] ? 1 : -1));
	}
	if (is_hole) {
		std::reverse(loop.begin(), loop.end());
	}
	return loop;
}

std::optional<std::vector<PolygonLoop>> HalfTone::find(size_t p_most_edges) const {
	std::vector<PolygonLoop> loops;
	std::vector<uint8_t> texels; // one for each block
	for (uint32_t y = 0; y < count.y; ++y) {
		for (uint32_t x = 0; x < count.x; ++x) {
			const double share = compute_share({ x, y });
			texels.insert(texels.end(), { 0, 0, 0, static_cast<uint8_t>(share >= 0.5 ? 255 : 0) });
			if (share > 0 && share < 1) {
				loops.push_back(make_square({ x, y }, share));
			}
			if (4 * loops.size() > p_most_edges) {
				return std::nullopt;
			}
		}
	}
	// Blocks that are there, with or without a hole, have a border in common.
	const auto blocks = make_image(test.image->name, count, std::move(texels));
	AlphaTest is_there;
	is_there.image = blocks.get();
	auto borders = SquareFinder(is_there).find(p_most_edges - 4 * loops.size());
	if (!borders) {
		return std::nullopt;
	}
	for (PolygonLoop &border : *borders) {
		for (glm::ivec2 &point : border) {
			const glm::ivec2 corner = (point + UNITS / 2) / UNITS;
			point = get_corner(corner) + (point - corner * UNITS); // parted as SquareFinder does
		}
		loops.push_back(std::move(border));
	}
	return loops;
}

} // namespace

AlphaTest make_alpha_test(const Material &p_material) {
	const Texture &texture = p_material.base_color_texture;
	return { texture.image.get(),
		p_material.alpha_mode == AlphaMode::BLEND ? BLEND_CUTOFF : p_material.alpha_cutoff,
		texture.wrap_u, texture.wrap_v, texture.is_magnified_nearest };
}

uint64_t compute_hash(const AlphaTest &p_test, uint64_t p_seed) {
	uint64_t hash = compute_value_hash(p_test.cutoff, p_seed);
	hash = compute_value_hash(p_test.wrap_u, hash);
	hash = compute_value_hash(p_test.wrap_v, hash);
	hash = compute_value_hash(p_test.is_nearest, hash);
	return compute_value_hash(p_test.image ? p_test.image->content_hash : 0, hash);
}

float sample_alpha(const AlphaTest &p_test, const glm::dvec2 &p_uv) {
	if (!std::isfinite(p_uv.x) || !std::isfinite(p_uv.y)) {
		return 0.0f;
	}
	const Image &image = *p_test.image;
	const glm::dvec2 place(wrap(p_uv.x, p_test.wrap_u) * image.size_px.x,
			wrap(p_uv.y, p_test.wrap_v) * image.size_px.y);
	if (p_test.is_nearest) {
		return image.get_texel(std::min(static_cast<uint32_t>(place.x), image.size_px.x - 1),
					   std::min(static_cast<uint32_t>(place.y), image.size_px.y - 1))[3] /
				255.0f;
	}
	const glm::dvec2 first = glm::floor(place - 0.5);
	const glm::dvec2 share = place - 0.5 - first;
	double alpha = 0;
	for (const int y : { 0, 1 }) {
		for (const int x : { 0, 1 }) {
			const uint8_t *texel = image.get_texel(
					wrap_texel(static_cast<int64_t>(first.x) + x, image.size_px.x, p_test.wrap_u),
					wrap_texel(static_cast<int64_t>(first.y) + y, image.size_px.y, p_test.wrap_v));
			alpha += (x ? share.x : 1 - share.x) * (y ? share.y : 1 - share.y) * texel[3];
		}
	}
	return static_cast<float>(alpha / 255.0);
}

AlphaOutline make_alpha_outline(
		const AlphaTest &p_test, uint32_t p_edge_budget, double p_tolerance_px) {
	GNOMON_ASSERT(p_edge_budget >= 4, p_edge_budget, " edges are no square");
	AlphaOutline outline;
	outline.size = glm::ivec2(p_test.image->size_px) * UNITS;
	// What is simplified may have many more edges before.
	const size_t most = size_t(64) * p_edge_budget;
	const auto loops =
			p_test.is_nearest ? SquareFinder(p_test).find(most) : ContourFinder(p_test).find(most);
	bool is_filled = false;
	std::vector<double> tolerances_px = { p_tolerance_px };
	for (const double coarse_px : COARSE_TOLERANCES_PX) {
		if (coarse_px > p_tolerance_px) {
			tolerances_px.push_back(coarse_px);
		}
	}
	for (size_t i = 0; loops && !is_filled && i < tolerances_px.size(); ++i) {
		AlphaOutline tried = outline;
		const bool keeps_squares = p_test.is_nearest && tolerances_px[i] < 0.5;
		const int32_t tolerance = static_cast<int32_t>(std::lround(tolerances_px[i] * UNITS));
		is_filled = fill(keeps_squares ? *loops : simplify_loops(*loops, tolerance, outline.size),
				p_edge_budget, tried);
		if (is_filled) {
			outline = std::move(tried);
		}
	}
	for (uint32_t block = 2; !is_filled; block *= 2) {
		const HalfTone half_tone(p_test, block);
		const uint32_t most_edges =
				half_tone.is_one_block() ? std::max(p_edge_budget, ONE_HOLE_EDGES) : p_edge_budget;
		const auto squares = half_tone.find(most_edges);
		AlphaOutline tried = outline;
		tried.block_size_px = block;
		is_filled = squares && fill(*squares, most_edges, tried);
		if (is_filled) {
			outline = std::move(tried);
		}
	}
	int64_t twice_area = 0;
	for (size_t i = 0; i < outline.triangles.size(); i += 3) {
		twice_area += compute_turn(outline.points[outline.triangles[i]],
				outline.points[outline.triangles[i + 1]], outline.points[outline.triangles[i + 2]]);
	}
	outline.is_whole = twice_area == 2 * int64_t(outline.size.x) * outline.size.y;
	return outline;
}

} // namespace gnomon
