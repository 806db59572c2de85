#include "modules/scene/cut_mesh.h"

#include "modules/core/files.h"
#include "modules/scene/alpha_outline.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

namespace gnomon {

namespace {

double cross(const glm::dvec2 &p_a, const glm::dvec2 &p_b) {
	return p_a.x * p_b.y - p_a.y * p_b.x;
}

/// Above 0: to the left of the line from a to b.
double compute_side(const glm::dvec2 &p_a, const glm::dvec2 &p_b, const glm::dvec2 &p_point) {
	return cross(p_b - p_a, p_point - p_a);
}

using PositionBits = std::array<uint32_t, 3>;

PositionBits to_bits(const glm::vec3 &p_position) {
	return std::bit_cast<PositionBits>(p_position + 0.0f); // -0 becomes 0
}

/// An edge of the mesh in the order of its ends' positions: the same from both its triangles.
struct MeshSide {
	glm::dvec2 uv[2];
	glm::dvec3 position[2];
	bool is_turned = false; // against the triangle's own direction

	glm::vec3 get_position(double p_share) const {
		return glm::vec3(position[0] + (position[1] - position[0]) * p_share);
	}
	std::pair<PositionBits, PositionBits> get_key() const {
		return { to_bits(glm::vec3(position[0])), to_bits(glm::vec3(position[1])) };
	}
};

/// A triangle of the mesh in the coordinates of its texture.
struct MeshTriangle {
	glm::dvec2 uv[3];
	glm::vec3 position[3];
	MeshSide sides[3]; // from corner i to i + 1
	double area = 0;   // twice, in the texture's coordinates; negative: mirrored

	void set_up();
	/// Above 0 inside, for each of the sides.
	double compute_inside(int p_side, const glm::dvec2 &p_uv) const;
	glm::vec3 compute_position(const glm::dvec2 &p_uv) const;
};

void MeshTriangle::set_up() {
	for (int i = 0; i < 3; ++i) {
		const int k = (i + 1) % 3;
		MeshSide &side = sides[i];
		side.is_turned = to_bits(position[k]) < to_bits(position[i]);
		side.uv[0] = side.is_turned ? uv[k] : uv[i];
		side.uv[1] = side.is_turned ? uv[i] : uv[k];
		side.position[0] = side.is_turned ? position[k] : position[i];
		side.position[1] = side.is_turned ? position[i] : position[k];
	}
	area = cross(uv[1] - uv[0], uv[2] - uv[0]);
}

double MeshTriangle::compute_inside(int p_side, const glm::dvec2 &p_uv) const {
	const MeshSide &side = sides[p_side];
	const double left = compute_side(side.uv[0], side.uv[1], p_uv);
	return side.is_turned != (area < 0) ? -left : left;
}

glm::vec3 MeshTriangle::compute_position(const glm::dvec2 &p_uv) const {
	const glm::dvec2 offset = p_uv - uv[0];
	const double b = cross(offset, uv[2] - uv[0]) / area;
	const double c = cross(uv[1] - uv[0], offset) / area;
	const glm::dvec3 origin(position[0]);
	return glm::vec3(origin + (glm::dvec3(position[1]) - origin) * b +
			(glm::dvec3(position[2]) - origin) * c);
}

/// A convex piece of an outline while it is clipped to a triangle. Each side remembers the line it
/// lies on, so that a point is computed from the same two lines wherever it occurs.
class ClippedPiece {
public:
	struct Point {
		glm::dvec2 uv = glm::dvec2(0.0);
		int corner = -1;  // of the triangle
		int side = -1;	  // of the triangle, on which it lies
		double share = 0; // along that side
	};

	ClippedPiece(const MeshTriangle &p_triangle, const std::array<glm::dvec2, 3> &p_uvs);
	const std::vector<Point> &get_points() const { return points; }
	glm::vec3 get_position(const Point &p_point) const;
	double compute_area() const;

private:
	struct Line {
		int side = -1; // of the triangle; else these two points of the outline, in order
		glm::dvec2 a = glm::dvec2(0.0), b = glm::dvec2(0.0);
	};

	void clip(int p_side);
	double locate(int p_side, Point &r_point) const;
	Point cross_line(int p_side, const Line &p_line) const;

	const MeshTriangle &triangle;
	std::vector<Point> points;
	std::vector<Line> lines; // from point i to the next
};

ClippedPiece::ClippedPiece(const MeshTriangle &p_triangle, const std::array<glm::dvec2, 3> &p_uvs) :
		triangle(p_triangle) {
	for (int i = 0; i < 3; ++i) {
		const glm::dvec2 &a = p_uvs[i];
		const glm::dvec2 &b = p_uvs[(i + 1) % 3];
		Point &point = points.emplace_back();
		point.uv = a;
		const bool is_turned = std::tie(b.x, b.y) < std::tie(a.x, a.y);
		lines.push_back({ -1, is_turned ? b : a, is_turned ? a : b });
	}
	for (int side = 0; side < 3 && !points.empty(); ++side) {
		clip(side);
	}
}

/// Above 0 inside of a side; 0 on it, which the point then remembers.
double ClippedPiece::locate(int p_side, Point &r_point) const {
	if (r_point.side == p_side || r_point.corner == p_side || r_point.corner == (p_side + 1) % 3) {
		return 0;
	}
	const double inside = triangle.compute_inside(p_side, r_point.uv);
	if (inside == 0 && r_point.corner < 0) {
		if (r_point.side >= 0) { // on two sides: their corner
			r_point.corner = r_point.side == (p_side + 1) % 3 ? r_point.side : p_side;
			r_point.side = -1;
		} else {
			const MeshSide &side = triangle.sides[p_side];
			const glm::dvec2 along = side.uv[1] - side.uv[0];
			r_point.side = p_side;
			r_point.share = glm::dot(r_point.uv - side.uv[0], along) / glm::dot(along, along);
		}
	}
	return inside;
}

ClippedPiece::Point ClippedPiece::cross_line(int p_side, const Line &p_line) const {
	Point point;
	if (p_line.side >= 0) {
		point.corner = p_line.side == (p_side + 1) % 3 ? p_line.side : p_side;
		point.uv = triangle.uv[point.corner];
		return point;
	}
	const MeshSide &side = triangle.sides[p_side];
	const glm::dvec2 along = side.uv[1] - side.uv[0];
	const glm::dvec2 across = p_line.b - p_line.a;
	point.side = p_side;
	// Of the whole line: other sides may cut off what lies beyond this one's ends.
	point.share = cross(p_line.a - side.uv[0], across) / cross(along, across);
	point.uv = side.uv[0] + along * point.share;
	return point;
}

/// Sutherland and Hodgman 1974, against one side.
void ClippedPiece::clip(int p_side) {
	const size_t count = points.size();
	std::vector<double> inside(count);
	for (size_t i = 0; i < count; ++i) {
		inside[i] = locate(p_side, points[i]);
	}
	std::vector<Point> clipped;
	std::vector<Line> clipped_lines;
	const auto add = [&](const Point &p_point, const Line &p_line) {
		clipped.push_back(p_point);
		clipped_lines.push_back(p_line);
	};
	const Line along_side{ p_side };
	for (size_t i = 0; i < count; ++i) {
		const double next = inside[(i + 1) % count];
		if (inside[i] >= 0) {
			add(points[i], inside[i] == 0 && next < 0 ? along_side : lines[i]);
		}
		if (inside[i] > 0 && next < 0) {
			add(cross_line(p_side, lines[i]), along_side);
		} else if (inside[i] < 0 && next > 0) {
			add(cross_line(p_side, lines[i]), lines[i]);
		}
	}
	points = clipped.size() < 3 ? std::vector<Point>() : std::move(clipped);
	lines = std::move(clipped_lines);
}

glm::vec3 ClippedPiece::get_position(const Point &p_point) const {
	if (p_point.corner >= 0) {
		return triangle.position[p_point.corner];
	}
	return p_point.side >= 0 ? triangle.sides[p_point.side].get_position(p_point.share)
							 : triangle.compute_position(p_point.uv);
}

/// Twice.
double ClippedPiece::compute_area() const {
	double area = 0;
	for (size_t i = 1; i + 1 < points.size(); ++i) {
		area += cross(points[i].uv - points[0].uv, points[i + 1].uv - points[0].uv);
	}
	return area;
}

/// How much of a texture's plane the triangles of a mesh cover, in tiles.
struct TileCover {
	double area = 0;
	double box_area = 0; // of the boxes around them
	double box_sides = 0;
	double farthest = 0; // of their coordinates

	void add(const MeshTriangle &p_triangle) {
		const glm::dvec2 low =
				glm::min(glm::min(p_triangle.uv[0], p_triangle.uv[1]), p_triangle.uv[2]);
		const glm::dvec2 high =
				glm::max(glm::max(p_triangle.uv[0], p_triangle.uv[1]), p_triangle.uv[2]);
		const glm::dvec2 size = high - low;
		area += std::abs(p_triangle.area) / 2;
		box_area += size.x * size.y;
		box_sides += size.x + size.y;
		farthest = std::max(
				{ farthest, std::abs(low.x), std::abs(low.y), std::abs(high.x), std::abs(high.y) });
	}
	/// Tiles of that size are few enough to be visited one by one, and distinct in double.
	bool fits(double p_tile_size) const {
		const double MOST_TILES = 1 << 20;
		const double MOST_PLACES = double(uint64_t(1) << 40);
		return box_area / (p_tile_size * p_tile_size) + box_sides / p_tile_size <= MOST_TILES &&
				farthest / p_tile_size <= MOST_PLACES;
	}
};

/// What a texture leaves of a mesh: outlines for each part of the plane of its coordinates.
class OutlinedTexture {
public:
	OutlinedTexture(
			const AlphaTest &p_test, const TileCover &p_cover, const OutlineBudget &p_budget);

	/// Calls with each triangle of the outline that may meet a box of coordinates.
	template <typename Visitor>
	void visit(const glm::dvec2 &p_minimum, const glm::dvec2 &p_maximum, const Visitor &p_visit);
	uint32_t get_block_size_px() const { return block_size_px; }

private:
	/// Of an axis: which part of the image covers a stretch of coordinates.
	struct Stretch {
		int part = 0; // 0: the image; -1, 1: its first or last texels, drawn out
		double begin = 0, end = 1;
		bool is_mirrored = false;
	};

	std::vector<Stretch> list_stretches(
			TextureWrap p_wrap, double p_minimum, double p_maximum) const;
	const AlphaOutline &get_outline(int p_part_x, int p_part_y);

	AlphaTest test;
	uint32_t edge_budget;
	double tile_size = 1; // in tiles, where one outline stands for many
	uint32_t block_size_px = 0;
	std::map<std::pair<int, int>, AlphaOutline> outlines;
};

/// The image's first (-1) or last (1) column or row in place of all, where a part says so.
std::shared_ptr<const Image> draw_out(const Image &p_image, int p_part_x, int p_part_y) {
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

OutlinedTexture::OutlinedTexture(
		const AlphaTest &p_test, const TileCover &p_cover, const OutlineBudget &p_budget) :
		test(p_test) {
	const double share = p_budget.edges_per_mesh / std::max(p_cover.area, 1.0);
	edge_budget = std::bit_floor(
			static_cast<uint32_t>(std::clamp(share, 4.0, double(p_budget.edges_per_tile))));
	const bool repeats = p_test.wrap_u != TextureWrap::CLAMP || p_test.wrap_v != TextureWrap::CLAMP;
	while (repeats && (share * tile_size * tile_size < 4 || !p_cover.fits(tile_size))) {
		tile_size *= 2;
	}
}

std::vector<OutlinedTexture::Stretch> OutlinedTexture::list_stretches(
		TextureWrap p_wrap, double p_minimum, double p_maximum) const {
	std::vector<Stretch> stretches;
	if (p_wrap == TextureWrap::CLAMP) {
		if (p_minimum < 0) {
			stretches.push_back({ -1, -std::exp2(std::ceil(std::log2(-p_minimum))), 0 });
		}
		if (p_maximum > 0 && p_minimum < 1) {
			stretches.push_back({});
		}
		if (p_maximum > 1) {
			stretches.push_back({ 1, 1, 1 + std::exp2(std::ceil(std::log2(p_maximum - 1))) });
		}
		return stretches;
	}
	const double first = std::floor(p_minimum / tile_size);
	for (double tile = first; tile * tile_size < p_maximum; tile += 1) {
		const bool is_odd = std::floor(tile / 2) * 2 != tile;
		stretches.push_back({ 0, tile * tile_size, (tile + 1) * tile_size,
				p_wrap == TextureWrap::MIRROR && is_odd });
	}
	return stretches;
}

const AlphaOutline &OutlinedTexture::get_outline(int p_part_x, int p_part_y) {
	auto [found, is_new] = outlines.try_emplace({ p_part_x, p_part_y });
	if (is_new) {
		AlphaTest part = test;
		std::shared_ptr<const Image> drawn_out;
		if (p_part_x != 0 || p_part_y != 0) {
			drawn_out = draw_out(*test.image, p_part_x, p_part_y);
			part.image = drawn_out.get();
		}
		found->second = make_alpha_outline(part, tile_size > 1 ? 4 : edge_budget);
		const double block = std::min(found->second.block_size_px * tile_size, double(INT32_MAX));
		block_size_px = std::max(block_size_px, static_cast<uint32_t>(block));
	}
	return found->second;
}

template <typename Visitor>
void OutlinedTexture::visit(
		const glm::dvec2 &p_minimum, const glm::dvec2 &p_maximum, const Visitor &p_visit) {
	const std::vector<Stretch> columns = list_stretches(test.wrap_u, p_minimum.x, p_maximum.x);
	const std::vector<Stretch> rows = list_stretches(test.wrap_v, p_minimum.y, p_maximum.y);
	const auto place = [](const Stretch &p_stretch, int32_t p_at, int32_t p_size) {
		const double share = double(p_at) / p_size;
		// Ends are exact, so that neighbours have them in common.
		return p_stretch.is_mirrored ? p_stretch.end - share * (p_stretch.end - p_stretch.begin)
									 : p_stretch.begin + share * (p_stretch.end - p_stretch.begin);
	};
	for (const Stretch &row : rows) {
		for (const Stretch &column : columns) {
			const AlphaOutline &outline = get_outline(column.part, row.part);
			std::vector<glm::dvec2> uvs;
			uvs.reserve(outline.points.size());
			for (const glm::ivec2 &point : outline.points) {
				uvs.emplace_back(place(column, point.x, outline.size.x),
						place(row, point.y, outline.size.y));
			}
			for (size_t i = 0; i < outline.triangles.size(); i += 3) {
				const std::array<glm::dvec2, 3> corners = { uvs[outline.triangles[i]],
					uvs[outline.triangles[i + 1]], uvs[outline.triangles[i + 2]] };
				const glm::dvec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
				const glm::dvec2 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
				if (glm::all(glm::lessThanEqual(low, p_maximum)) &&
						glm::all(glm::greaterThanEqual(high, p_minimum))) {
					p_visit(corners);
				}
			}
		}
	}
}

/// Cuts the triangles one after another. Those that are whole wait until it is known where their
/// neighbours' cuts meet their sides.
class MeshCutter {
public:
	MeshCutter(const Mesh &p_mesh, const Material &p_material, const OutlineBudget &p_budget);
	/// Null: nothing is there. The triangles' source is the mesh.
	std::shared_ptr<const Mesh> cut(const std::shared_ptr<const Mesh> &p_mesh);
	bool is_whole() const { return whole.size() * 3 == mesh.indices.size(); }
	uint32_t get_block_size_px() const { return block_size_px; }

private:
	double compute_cutoff(const uint32_t *p_corners) const;
	MeshTriangle read_triangle(uint32_t p_triangle) const;
	OutlinedTexture &get_texture(double p_cutoff);
	void cut_triangle(uint32_t p_triangle);
	void add_pieces(const std::vector<ClippedPiece> &p_pieces, const MeshTriangle &p_cut,
			uint32_t p_triangle);
	void add_whole(uint32_t p_triangle);
	uint32_t add_point(const glm::vec3 &p_position);
	void add_triangle(uint32_t p_a, uint32_t p_b, uint32_t p_c, uint32_t p_source);

	const Mesh &mesh;
	const Material &material;
	const Texture &texture;
	OutlineBudget budget;
	TileCover cover;
	uint32_t block_size_px = 0;
	std::map<double, OutlinedTexture> textures; // by cutoff
	std::vector<uint32_t> whole;				// triangles
	/// Points of cut triangles on the mesh's edges, by their place along it.
	std::map<std::pair<PositionBits, PositionBits>, std::map<double, glm::vec3>> side_points;

	std::map<PositionBits, uint32_t> point_indices;
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	std::vector<uint32_t> sources;
};

MeshCutter::MeshCutter(
		const Mesh &p_mesh, const Material &p_material, const OutlineBudget &p_budget) :
		mesh(p_mesh),
		material(p_material), texture(p_material.base_color_texture), budget(p_budget) {
	if (texture.image) {
		for (uint32_t triangle = 0; triangle < mesh.get_triangle_count(); ++triangle) {
			const MeshTriangle read = read_triangle(triangle);
			if (std::isfinite(read.area)) {
				cover.add(read);
			}
		}
	}
}

/// Of the texture's alpha: at least that is there.
double MeshCutter::compute_cutoff(const uint32_t *p_corners) const {
	double alpha = material.alpha;
	if (!mesh.attributes.colors.empty()) {
		double sum = 0;
		for (int corner = 0; corner < 3; ++corner) {
			sum += mesh.attributes.colors[p_corners[corner]].w;
		}
		alpha *= sum / 3;
	}
	const double cutoff = make_alpha_test(material).cutoff;
	return cutoff <= 0 ? 0.0 : alpha > 0 ? cutoff / alpha : 2.0;
}

MeshTriangle MeshCutter::read_triangle(uint32_t p_triangle) const {
	MeshTriangle triangle;
	const std::vector<glm::vec2> &uvs = mesh.attributes.uvs[texture.uv_set];
	const glm::dmat3x2 transform(texture.transform);
	for (int corner = 0; corner < 3; ++corner) {
		const uint32_t index = mesh.indices[3 * size_t(p_triangle) + corner];
		const glm::dvec2 uv = uvs.empty() ? glm::dvec2(0.0) : glm::dvec2(uvs[index]);
		triangle.uv[corner] = transform * glm::dvec3(uv, 1.0);
		triangle.position[corner] = mesh.positions_node[index] + 0.0f;
	}
	triangle.set_up();
	return triangle;
}

OutlinedTexture &MeshCutter::get_texture(double p_cutoff) {
	const auto found = textures.find(p_cutoff);
	if (found != textures.end()) {
		return found->second;
	}
	AlphaTest test = make_alpha_test(material);
	test.cutoff = static_cast<float>(p_cutoff);
	return textures.try_emplace(p_cutoff, test, cover, budget).first->second;
}

void MeshCutter::cut_triangle(uint32_t p_triangle) {
	const double cutoff = compute_cutoff(&mesh.indices[3 * size_t(p_triangle)]);
	if (!texture.image) {
		if (cutoff <= 1) {
			whole.push_back(p_triangle);
		}
		return;
	}
	const MeshTriangle triangle = read_triangle(p_triangle);
	if (triangle.area == 0 || !std::isfinite(triangle.area)) { // all of it shows one line of texels
		const glm::dvec2 middle = (triangle.uv[0] + triangle.uv[1] + triangle.uv[2]) / 3.0;
		if (std::isfinite(middle.x + middle.y) &&
				sample_alpha(make_alpha_test(material), middle) >= cutoff) {
			whole.push_back(p_triangle);
		}
		return;
	}
	std::vector<ClippedPiece> pieces;
	double area = 0;
	get_texture(cutoff).visit(glm::min(glm::min(triangle.uv[0], triangle.uv[1]), triangle.uv[2]),
			glm::max(glm::max(triangle.uv[0], triangle.uv[1]), triangle.uv[2]),
			[&](const std::array<glm::dvec2, 3> &p_corners) {
				ClippedPiece piece(triangle, p_corners);
				if (!piece.get_points().empty()) {
					area += std::abs(piece.compute_area());
					pieces.push_back(std::move(piece));
				}
			});
	const double ROUNDING = 1e-12;
	if (area >= (1 - ROUNDING) * std::abs(triangle.area)) {
		whole.push_back(p_triangle);
	} else {
		add_pieces(pieces, triangle, p_triangle);
	}
}

void MeshCutter::add_pieces(
		const std::vector<ClippedPiece> &p_pieces, const MeshTriangle &p_cut, uint32_t p_triangle) {
	for (const ClippedPiece &piece : p_pieces) {
		std::vector<uint32_t> corners;
		for (const ClippedPiece::Point &point : piece.get_points()) {
			const glm::vec3 position = piece.get_position(point);
			corners.push_back(add_point(position));
			if (point.side >= 0 && point.corner < 0) {
				side_points[p_cut.sides[point.side].get_key()][point.share] = position;
			}
		}
		const bool is_turned = (piece.compute_area() < 0) != (p_cut.area < 0);
		for (size_t i = 1; i + 1 < corners.size(); ++i) {
			add_triangle(corners[0], corners[is_turned ? i + 1 : i], corners[is_turned ? i : i + 1],
					p_triangle);
		}
	}
}

void MeshCutter::add_whole(uint32_t p_triangle) {
	const MeshTriangle triangle = read_triangle(p_triangle);
	std::vector<uint32_t> ring;
	for (int corner = 0; corner < 3; ++corner) {
		ring.push_back(add_point(triangle.position[corner]));
		const MeshSide &side = triangle.sides[corner];
		const auto found = side_points.find(side.get_key());
		if (found == side_points.end()) {
			continue;
		}
		std::vector<uint32_t> points;
		for (const auto &[share, position] : found->second) {
			points.push_back(add_point(position));
		}
		if (side.is_turned) {
			std::reverse(points.begin(), points.end());
		}
		ring.insert(ring.end(), points.begin(), points.end());
	}
	if (ring.size() == 3) {
		add_triangle(ring[0], ring[1], ring[2], p_triangle);
		return;
	}
	const glm::dvec3 sum = glm::dvec3(triangle.position[0]) + glm::dvec3(triangle.position[1]) +
			glm::dvec3(triangle.position[2]);
	const uint32_t middle = add_point(glm::vec3(sum / 3.0));
	for (size_t i = 0; i < ring.size(); ++i) {
		add_triangle(middle, ring[i], ring[(i + 1) % ring.size()], p_triangle);
	}
}

uint32_t MeshCutter::add_point(const glm::vec3 &p_position) {
	const auto [found, is_new] =
			point_indices.try_emplace(to_bits(p_position), static_cast<uint32_t>(positions.size()));
	if (is_new) {
		positions.push_back(p_position + 0.0f);
	}
	return found->second;
}

void MeshCutter::add_triangle(uint32_t p_a, uint32_t p_b, uint32_t p_c, uint32_t p_source) {
	if (p_a != p_b && p_b != p_c && p_c != p_a) { // else rounding took its area
		indices.insert(indices.end(), { p_a, p_b, p_c });
		sources.push_back(p_source);
	}
}

std::shared_ptr<const Mesh> MeshCutter::cut(const std::shared_ptr<const Mesh> &p_mesh) {
	for (uint32_t triangle = 0; triangle < mesh.get_triangle_count(); ++triangle) {
		cut_triangle(triangle);
	}
	for (const auto &[cutoff, outlined] : textures) {
		block_size_px = std::max(block_size_px, outlined.get_block_size_px());
	}
	if (is_whole()) {
		return p_mesh;
	}
	for (const uint32_t triangle : whole) {
		add_whole(triangle);
	}
	if (indices.empty()) {
		return nullptr;
	}
	return make_mesh(mesh.name, std::move(positions), {}, std::move(indices), {},
			MeshSource{ p_mesh, std::move(sources) });
}

/// All of a material that decides how a mesh is cut.
auto make_key(const Mesh &p_mesh, const Material &p_material) {
	const Texture &texture = p_material.base_color_texture;
	std::array<float, 6> transform;
	for (int i = 0; i < 6; ++i) {
		transform[i] = texture.transform[i / 2][i % 2];
	}
	return std::tuple(p_mesh.id, texture.image ? texture.image->id : 0, p_material.alpha_mode,
			p_material.alpha, p_material.alpha_cutoff, texture.wrap_u, texture.wrap_v,
			texture.is_magnified_nearest, texture.uv_set, transform);
}

/// Of what decides which parts of a mesh are there.
uint64_t compute_content_hash(const Mesh &p_mesh, const Material &p_material) {
	const Texture &texture = p_material.base_color_texture;
	const std::vector<glm::vec2> &uvs = p_mesh.attributes.uvs[texture.uv_set];
	uint64_t hash = compute_hash(make_alpha_test(p_material), 1);
	hash = compute_value_hash(p_material.alpha, hash);
	hash = compute_value_hash(texture.transform, hash);
	hash = compute_hash(bytes_of(std::span<const glm::vec2>(uvs)), hash);
	return compute_hash(bytes_of(std::span<const glm::vec4>(p_mesh.attributes.colors)), hash);
}

struct CacheEntry {
	std::weak_ptr<const Mesh> source;
	std::weak_ptr<const Material> material; // of the one that asked first
	CutMesh cut;

	/// Whether a later snapshot may ask again.
	bool is_used() const {
		return !source.expired() && (!material.expired() || cut.mesh.use_count() > 1);
	}
};

using CutKey = decltype(make_key(std::declval<Mesh>(), std::declval<Material>()));
std::mutex cache_mutex;
std::map<CutKey, CacheEntry> cache;

} // namespace

CutMesh cut_mesh(const std::shared_ptr<const Mesh> &p_mesh, const Material &p_material,
		const OutlineBudget &p_budget) {
	MeshCutter cutter(*p_mesh, p_material, p_budget);
	CutMesh result;
	result.mesh = cutter.cut(p_mesh);
	result.block_size_px = cutter.get_block_size_px();
	result.content_hash = compute_content_hash(*p_mesh, p_material);
	return result;
}

CutMesh get_cut_mesh(const std::shared_ptr<const Mesh> &p_mesh,
		const std::shared_ptr<const Material> &p_material) {
	if (!p_material || !p_material->is_cut_out()) {
		return { p_mesh };
	}
	// Held while a mesh is cut: two threads would do the same work.
	const std::lock_guard<std::mutex> lock(cache_mutex);
	CacheEntry &entry = cache[make_key(*p_mesh, *p_material)];
	if (entry.source.expired()) {
		entry = { p_mesh, p_material, cut_mesh(p_mesh, *p_material) };
	}
	return entry.cut;
}

void drop_unused_cut_meshes() {
	const std::lock_guard<std::mutex> lock(cache_mutex);
	std::erase_if(cache, [](const auto &p_item) { return !p_item.second.is_used(); });
}

size_t get_cut_mesh_count() {
	const std::lock_guard<std::mutex> lock(cache_mutex);
	return cache.size();
}

} // namespace gnomon
