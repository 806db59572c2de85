#pragma once

#include "modules/scene/alpha_outline.h"
#include "modules/scene/triangle_clip.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace gnomon {

/// Maximum number of edges of the outline of one texture tile, and of all outlines on one mesh;
/// above them outlines are made coarser.
struct OutlineBudget {
	uint32_t edges_per_tile = 1 << 14;
	uint32_t edges_per_mesh = 1 << 21; // enough for the outlines of 128 tiles
};

/// How much of the texture plane the triangles of a mesh cover, in tiles. A tile is one repetition
/// of the texture, 0..1 of its coordinates.
struct TileCoverage {
	double area = 0;
	double box_area = 0;		   // sum of the areas of the triangles' bounding boxes
	double excess_side_length = 0; // sum over those boxes' sides of the length above one tile
	double longest_side = 0;	   // longest side of those boxes
	double max_coordinate = 0;	   // largest absolute coordinate

	void add(const MeshPolygon &p_polygon);
	/// Whether tiles of that size, in repetitions of the texture along each axis, are at most about
	/// p_max_tiles, few enough to be visited one by one, and distinct in double.
	bool fits(double p_tile_size, double p_max_tiles) const;
};

/// The region of the texture plane where an alpha test passes, as triangles. Each part of the plane
/// that looks different, such as a clamped border, has an outline, made when it is first needed.
class OutlinedTexture {
public:
	using Triangle = std::array<glm::dvec2, 3>;

	/// p_tolerance_px: see make_alpha_outline.
	OutlinedTexture(const AlphaTest &p_test, const TileCoverage &p_coverage,
			const OutlineBudget &p_budget, double p_tolerance_px);

	/// Lists the outline's triangles that may overlap a polygon of the mesh.
	std::vector<Triangle> list_triangles(const MeshPolygon &p_polygon);
	/// Returns the largest AlphaOutline::block_size_px of the outlines made so far, in texels of
	/// the texture.
	uint32_t get_block_size_px() const { return block_size_px; }

private:
	/// An interval of texture coordinates along one axis, and the part of the image that covers it.
	struct Interval {
		int part = 0; // 0: the image; -1, 1: its first or last texel, extended by clamping
		double begin = 0, end = 1;
		bool is_mirrored = false;
	};

	/// An outline, and for each row of it, the triangles (by first corner) that overlap the row.
	struct Tile {
		AlphaOutline outline;
		std::vector<std::vector<uint32_t>> rows;

		void fill_rows();
		/// Lists the triangles that may overlap a range of the tile's height, 0..1, in order.
		std::vector<uint32_t> list_triangles(double p_minimum, double p_maximum) const;
	};

	std::vector<Interval> list_intervals(
			TextureWrap p_wrap, double p_minimum, double p_maximum) const;
	const Tile &get_tile(int p_part_x, int p_part_y);

	AlphaTest test;
	double tolerance_px;
	uint32_t edge_budget;
	/// Repetitions of the texture along each axis of a tile. Above 1, an outline stretched over the
	/// tile stands for several of them.
	double tile_size = 1;
	uint32_t block_size_px = 0;
	std::map<std::pair<int, int>, Tile> tiles;
};

} // namespace gnomon
