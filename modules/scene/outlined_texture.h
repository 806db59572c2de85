#pragma once

#include "modules/scene/alpha_outline.h"
#include "modules/scene/triangle_clip.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace gnomon {

/// The most edges of a texture's outline, and of all outlines on one mesh; beyond them outlines are
/// made coarser.
struct OutlineBudget {
	uint32_t edges_per_tile = 1 << 14;
	uint32_t edges_per_mesh = 1 << 20;
};

/// How much of the texture plane the triangles of a mesh cover, in tiles.
struct TileCover {
	double area = 0;
	double box_area = 0;	 // sum of the areas of the triangles' bounding boxes
	double long_sides = 0;	 // sum of those boxes' sides, beyond one tile each
	double longest_side = 0; // longest side of those boxes
	double farthest = 0;	 // largest absolute coordinate

	void add(const MeshTriangle &p_triangle);
	/// Whether tiles of that size are few enough to be visited one by one, and distinct in double.
	bool fits(double p_tile_size, double p_most_tiles) const;
};

/// The region of a mesh that a texture's alpha leaves: outlines for each part of the texture plane.
class OutlinedTexture {
public:
	using Triangle = std::array<glm::dvec2, 3>;

	/// p_tolerance_px: see make_alpha_outline.
	OutlinedTexture(const AlphaTest &p_test, const TileCover &p_cover,
			const OutlineBudget &p_budget, double p_tolerance_px);

	/// Lists the outline's triangles that may overlap a triangle of the mesh.
	std::vector<Triangle> list_triangles(const MeshTriangle &p_triangle);
	uint32_t get_block_size_px() const { return block_size_px; }

private:
	/// Along one axis: the part of the image that covers an interval of coordinates.
	struct Stretch {
		int part = 0; // 0: the image; -1, 1: its first or last texels, extended (clamped)
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

	std::vector<Stretch> list_stretches(
			TextureWrap p_wrap, double p_minimum, double p_maximum) const;
	const Tile &get_tile(int p_part_x, int p_part_y);

	AlphaTest test;
	double tolerance_px;
	uint32_t edge_budget;
	double tile_size = 1; // in tiles, where one outline represents many
	uint32_t block_size_px = 0;
	std::map<std::pair<int, int>, Tile> tiles;
};

} // namespace gnomon
