#include "modules/scene/outlined_texture.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gnomon {

namespace {

/// Makes the image of a part of the texture plane outside the image, with clamping. Along each
/// axis, -1 selects the first column or row, 1 the last, and 0 all.
std::shared_ptr<const Image> make_border_image(const Image &p_image, int p_part_x, int p_part_y) {
	const glm::uvec2 size(
			p_part_x == 0 ? p_image.size_px.x : 1, p_part_y == 0 ? p_image.size_px.y : 1);
	std::vector<uint8_t> texels;
	for (uint32_t y = 0; y < size.y; ++y) {
		for (uint32_t x = 0; x < size.x; ++x) {
			const uint8_t *texel = p_image.get_texel(p_part_x > 0 ? p_image.size_px.x - 1 : x,
					p_part_y > 0 ? p_image.size_px.y - 1 : y);
			texels.insert(texels.end(), texel, texel + 4);
		}
	}
	return make_image(p_image.name, size, std::move(texels));
}

/// Whether all corners of a convex polygon are outside of one side of the mesh's polygon, so that
/// the two do not overlap.
template <size_t COUNT>
bool is_outside(const MeshPolygon &p_polygon, const std::array<glm::dvec2, COUNT> &p_corners) {
	for (int side = 0; side < p_polygon.corner_count; ++side) {
		if (std::all_of(p_corners.begin(), p_corners.end(), [&](const glm::dvec2 &p_corner) {
				return p_polygon.compute_side_area(side, p_corner) < 0;
			})) {
			return true;
		}
	}
	return false;
}

// A long, thin triangle covers little of a tile's outline, but each outline edge is tested: this
// many tiles of its length cost as much as one tile that it covers.
const double LONG_TILES_PER_TILE = 4;
const double MIN_EDGES = 4;	  // of a tile's outline
const int64_t ROW_COUNT = 64; // rows of a tile by which triangles are looked up
// Rejecting a tile that the triangle's bounding box overlaps, but not the triangle itself, is
// cheap: this many cost as much as one tile.
const double REJECTIONS_PER_TILE = 4;

} // namespace

void TileCoverage::add(const MeshPolygon &p_polygon) {
	const auto [low, high] = p_polygon.find_uv_bounds();
	const glm::dvec2 size = high - low;
	area += std::abs(p_polygon.area) / 2;
	box_area += size.x * size.y;
	excess_side_length += std::max(size.x - 1, 0.0) + std::max(size.y - 1, 0.0);
	longest_side = std::max({ longest_side, size.x, size.y });
	max_coordinate = std::max({ max_coordinate, std::abs(low.x), std::abs(low.y), std::abs(high.x),
			std::abs(high.y) });
}

bool TileCoverage::fits(double p_tile_size, double p_max_tiles) const {
	// A double has 53 bits, so 12 or more remain for the position within a tile.
	const double MAX_TILE_COORDINATE = double(uint64_t(1) << 40);
	// No real texture repeats this often on one triangle: such coordinates are damaged, and each
	// tile costs time.
	const double MAX_TILES_PER_SIDE = double(uint64_t(1) << 13);
	return box_area / (p_tile_size * p_tile_size) <= REJECTIONS_PER_TILE * p_max_tiles &&
			excess_side_length / p_tile_size <= p_max_tiles &&
			longest_side / p_tile_size <= MAX_TILES_PER_SIDE &&
			max_coordinate / p_tile_size <= MAX_TILE_COORDINATE;
}

OutlinedTexture::OutlinedTexture(const AlphaTest &p_test, const TileCoverage &p_coverage,
		const OutlineBudget &p_budget, double p_tolerance_px) :
		test(p_test),
		tolerance_px(p_tolerance_px) {
	const double tile_count = p_coverage.area + p_coverage.excess_side_length / LONG_TILES_PER_TILE;
	const double ratio = p_budget.edges_per_mesh / std::max(tile_count, 1.0);
	edge_budget = std::bit_floor(
			static_cast<uint32_t>(std::clamp(ratio, MIN_EDGES, double(p_budget.edges_per_tile))));
	const bool repeats = p_test.wrap_u != TextureWrap::CLAMP || p_test.wrap_v != TextureWrap::CLAMP;
	const double max_tiles = p_budget.edges_per_mesh / MIN_EDGES;
	// Tiles get larger until the mesh's budget allows MIN_EDGES for each, and TileCoverage::fits.
	while (repeats &&
			(ratio * tile_size * tile_size < MIN_EDGES || !p_coverage.fits(tile_size, max_tiles))) {
		tile_size *= 2;
	}
}

std::vector<OutlinedTexture::Interval> OutlinedTexture::list_intervals(
		TextureWrap p_wrap, double p_minimum, double p_maximum) const {
	std::vector<Interval> intervals;
	if (p_wrap == TextureWrap::CLAMP) {
		// Outside the image, to a power of two beyond the polygon: polygons of similar extent get
		// the same interval.
		if (p_minimum < 0) {
			intervals.push_back({ -1, -std::exp2(std::ceil(std::log2(-p_minimum))), 0 });
		}
		if (p_maximum > 0 && p_minimum < 1) {
			intervals.push_back({});
		}
		if (p_maximum > 1) {
			intervals.push_back({ 1, 1, 1 + std::exp2(std::ceil(std::log2(p_maximum - 1))) });
		}
		return intervals;
	}
	const double first = std::floor(p_minimum / tile_size);
	for (double tile = first; tile * tile_size < p_maximum; tile += 1) {
		const bool is_odd = std::floor(tile / 2) * 2 != tile;
		intervals.push_back({ 0, tile * tile_size, (tile + 1) * tile_size,
				p_wrap == TextureWrap::MIRROR && is_odd });
	}
	return intervals;
}

void OutlinedTexture::Tile::fill_rows() {
	rows.resize(ROW_COUNT);
	const auto find_row = [&](int32_t p_y) {
		return std::min(int64_t(p_y) * ROW_COUNT / outline.size.y, ROW_COUNT - 1);
	};
	for (uint32_t first = 0; first < outline.triangles.size(); first += 3) {
		const auto [low, high] = std::minmax({ outline.points[outline.triangles[first]].y,
				outline.points[outline.triangles[first + 1]].y,
				outline.points[outline.triangles[first + 2]].y });
		for (int64_t row = find_row(low); row <= find_row(high); ++row) {
			rows[row].push_back(first);
		}
	}
}

std::vector<uint32_t> OutlinedTexture::Tile::list_triangles(
		double p_minimum, double p_maximum) const {
	// One more row on either side, to allow for rounding.
	const auto find_row = [](double p_position, int64_t p_row_offset) {
		const double row = std::floor(std::clamp(p_position, 0.0, 1.0) * ROW_COUNT);
		return std::clamp<int64_t>(static_cast<int64_t>(row) + p_row_offset, 0, ROW_COUNT - 1);
	};
	std::vector<uint32_t> triangles;
	for (int64_t row = find_row(p_minimum, -1); row <= find_row(p_maximum, 1); ++row) {
		triangles.insert(triangles.end(), rows[row].begin(), rows[row].end());
	}
	std::sort(triangles.begin(), triangles.end());
	triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
	return triangles;
}

const OutlinedTexture::Tile &OutlinedTexture::get_tile(int p_part_x, int p_part_y) {
	auto [found, is_new] = tiles.try_emplace({ p_part_x, p_part_y });
	if (is_new) {
		AlphaTest part = test;
		std::shared_ptr<const Image> border_image;
		if (p_part_x != 0 || p_part_y != 0) {
			border_image = make_border_image(*test.image, p_part_x, p_part_y);
			part.image = border_image.get();
		}
		AlphaOutline &outline = found->second.outline;
		outline = make_alpha_outline(
				part, tile_size > 1 ? static_cast<uint32_t>(MIN_EDGES) : edge_budget, tolerance_px);
		found->second.fill_rows();
		const double block = std::min(outline.block_size_px * tile_size, double(INT32_MAX));
		block_size_px = std::max(block_size_px, static_cast<uint32_t>(block));
	}
	return found->second;
}

std::vector<OutlinedTexture::Triangle> OutlinedTexture::list_triangles(
		const MeshPolygon &p_polygon) {
	const auto [minimum, maximum] = p_polygon.find_uv_bounds();
	std::vector<Triangle> triangles;
	const std::vector<Interval> columns = list_intervals(test.wrap_u, minimum.x, maximum.x);
	const std::vector<Interval> rows = list_intervals(test.wrap_v, minimum.y, maximum.y);
	// p_at: coordinate of an outline point in units, 0..p_size.
	const auto find_coordinate = [](const Interval &p_interval, int32_t p_at, int32_t p_size) {
		const double ratio = double(p_at) / p_size;
		// Exact at the interval's ends, so that adjacent intervals get equal coordinates.
		return p_interval.is_mirrored
				? p_interval.end - ratio * (p_interval.end - p_interval.begin)
				: p_interval.begin + ratio * (p_interval.end - p_interval.begin);
	};
	for (const Interval &row : rows) {
		for (const Interval &column : columns) {
			const std::array<glm::dvec2, 4> box = { { { column.begin, row.begin },
					{ column.end, row.begin }, { column.end, row.end },
					{ column.begin, row.end } } };
			if (is_outside(p_polygon, box)) {
				continue;
			}
			const Tile &tile = get_tile(column.part, row.part);
			const AlphaOutline &outline = tile.outline;
			const double height = row.end - row.begin;
			const double low_position = (minimum.y - row.begin) / height;
			const double high_position = (maximum.y - row.begin) / height;
			for (const uint32_t first : row.is_mirrored
							? tile.list_triangles(1 - high_position, 1 - low_position)
							: tile.list_triangles(low_position, high_position)) {
				Triangle corners;
				for (uint32_t corner = 0; corner < 3; ++corner) {
					const glm::ivec2 &point = outline.points[outline.triangles[first + corner]];
					corners[corner] = { find_coordinate(column, point.x, outline.size.x),
						find_coordinate(row, point.y, outline.size.y) };
				}
				const glm::dvec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
				const glm::dvec2 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
				if (glm::all(glm::lessThanEqual(low, maximum)) &&
						glm::all(glm::greaterThanEqual(high, minimum)) &&
						!is_outside(p_polygon, corners)) {
					triangles.push_back(corners);
				}
			}
		}
	}
	return triangles;
}

} // namespace gnomon
