#include "modules/scene/alpha_outline.h"

#include "modules/core/error.h"
#include "modules/scene/alpha_contour.h"
#include "modules/scene/loop_simplification.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gnomon {

namespace {

const int32_t UNITS = AlphaOutline::UNITS_PER_TEXEL;
// Tolerances for outlines that have more edges than their budget.
const double COARSE_TOLERANCES_PX[] = { 0.5, 1.0 };

size_t count_points(const std::vector<PolygonLoop> &p_loops) {
	size_t count = 0;
	for (const PolygonLoop &loop : p_loops) {
		count += loop.size();
	}
	return count;
}

/// Triangulates the loops into the outline. Returns false if they have more than p_edge_budget
/// edges or cannot be triangulated.
bool triangulate_into(
		std::vector<PolygonLoop> p_loops, uint32_t p_edge_budget, AlphaOutline &r_outline) {
	const size_t count = count_points(p_loops); // closed loops have as many edges as points
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

const uint32_t SQUARE_WITH_HOLE_EDGES = 8; // of a tile that is a square with a hole

/// Replaces each block of texels by a square, or a square hole, of the same area as its texels that
/// pass the alpha test.
class HalfTone {
public:
	HalfTone(const AlphaTest &p_test, uint32_t p_block_size_px) :
			test(p_test), block(p_block_size_px), size(glm::ivec2(p_test.image->size_px) * UNITS),
			count((p_test.image->size_px + block - 1u) / block) {}

	bool is_one_block() const { return count == glm::uvec2(1); }
	/// Returns the loops, or nullopt if they have more than p_max_edges edges.
	std::optional<std::vector<PolygonLoop>> find(size_t p_max_edges) const;

private:
	/// Returns the fraction, 0..1, of a block's texels that pass the alpha test.
	double compute_coverage(const glm::uvec2 &p_block) const;
	PolygonLoop make_square(const glm::uvec2 &p_block, double p_coverage) const;
	glm::ivec2 get_corner(const glm::ivec2 &p_block) const {
		return glm::min(p_block * static_cast<int32_t>(block) * UNITS, size);
	}

	const AlphaTest &test;
	uint32_t block;
	glm::ivec2 size;  // of the tile in units
	glm::uvec2 count; // of blocks along x and y
};

double HalfTone::compute_coverage(const glm::uvec2 &p_block) const {
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

PolygonLoop HalfTone::make_square(const glm::uvec2 &p_block, double p_coverage) const {
	const glm::ivec2 begin = get_corner(glm::ivec2(p_block));
	const glm::ivec2 end = get_corner(glm::ivec2(p_block) + 1);
	const bool is_hole = p_coverage >= 0.5;
	const glm::dvec2 half =
			glm::dvec2(end - begin) * 0.5 * std::sqrt(is_hole ? 1 - p_coverage : p_coverage);
	const glm::ivec2 middle = (begin + end) / 2;
	const glm::ivec2 inner = glm::max(glm::ivec2(glm::round(half)), 1);
	const glm::ivec2 across(inner.x, -inner.y);
	PolygonLoop loop = { middle - inner, middle + across, middle + inner, middle - across };
	if (is_hole) {
		std::reverse(loop.begin(), loop.end());
	}
	return loop;
}

std::optional<std::vector<PolygonLoop>> HalfTone::find(size_t p_max_edges) const {
	std::vector<PolygonLoop> loops;
	std::vector<uint8_t> texels; // one for each block: opaque if at least half of it is
	for (uint32_t y = 0; y < count.y; ++y) {
		for (uint32_t x = 0; x < count.x; ++x) {
			const double coverage = compute_coverage({ x, y });
			texels.insert(
					texels.end(), { 0, 0, 0, static_cast<uint8_t>(coverage >= 0.5 ? 255 : 0) });
			if (coverage > 0 && coverage < 1) {
				loops.push_back(make_square({ x, y }, coverage));
			}
			if (4 * loops.size() > p_max_edges) {
				return std::nullopt;
			}
		}
	}
	// Adjacent blocks that are covered, with or without a hole, are joined.
	const auto blocks = make_image(test.image->name, count, std::move(texels));
	AlphaTest block_test;
	block_test.image = blocks.get();
	auto borders = find_alpha_squares(block_test, p_max_edges - 4 * loops.size());
	if (!borders) {
		return std::nullopt;
	}
	for (PolygonLoop &border : *borders) {
		for (glm::ivec2 &point : border) {
			const glm::ivec2 corner = (point + UNITS / 2) / UNITS;
			point = get_corner(corner) + (point - corner * UNITS); // preserves separated corners
		}
		loops.push_back(std::move(border));
	}
	return loops;
}

} // namespace

AlphaOutline make_alpha_outline(
		const AlphaTest &p_test, uint32_t p_edge_budget, double p_tolerance_px) {
	GNOMON_ASSERT(p_edge_budget >= 4, p_edge_budget, " edges cannot form a square");
	AlphaOutline outline;
	outline.size = glm::ivec2(p_test.image->size_px) * UNITS;
	// An outline may have many more edges before it is simplified.
	const size_t max_segments = size_t(64) * p_edge_budget;
	const auto loops = p_test.is_nearest ? find_alpha_squares(p_test, max_segments)
										 : find_alpha_contour(p_test, max_segments);
	bool is_filled = false;
	std::vector<double> tolerances_px = { p_tolerance_px };
	for (const double coarse_px : COARSE_TOLERANCES_PX) {
		if (coarse_px > p_tolerance_px) {
			tolerances_px.push_back(coarse_px);
		}
	}
	for (size_t i = 0; loops && !is_filled && i < tolerances_px.size(); ++i) {
		AlphaOutline candidate = outline;
		const bool keeps_squares = p_test.is_nearest && tolerances_px[i] < 0.5;
		const int32_t tolerance = static_cast<int32_t>(std::lround(tolerances_px[i] * UNITS));
		is_filled = triangulate_into(
				keeps_squares ? *loops : simplify_loops(*loops, tolerance, outline.size),
				p_edge_budget, candidate);
		if (is_filled) {
			outline = std::move(candidate);
		}
	}
	for (uint32_t block = 2; !is_filled; block *= 2) {
		const HalfTone half_tone(p_test, block);
		const uint32_t max_edges = half_tone.is_one_block()
				? std::max(p_edge_budget, SQUARE_WITH_HOLE_EDGES)
				: p_edge_budget;
		const auto squares = half_tone.find(max_edges);
		AlphaOutline candidate = outline;
		candidate.block_size_px = block;
		is_filled = squares && triangulate_into(*squares, max_edges, candidate);
		if (is_filled) {
			outline = std::move(candidate);
		}
	}
	int64_t twice_area = 0;
	for (size_t i = 0; i < outline.triangles.size(); i += 3) {
		twice_area += compute_twice_signed_area(outline.points[outline.triangles[i]],
				outline.points[outline.triangles[i + 1]], outline.points[outline.triangles[i + 2]]);
	}
	outline.covers_tile = twice_area == 2 * int64_t(outline.size.x) * outline.size.y;
	return outline;
}

} // namespace gnomon
