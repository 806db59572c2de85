#include "modules/scene/cut_mesh.h"

#include "modules/core/files.h"
#include "modules/scene/cut_levels.h"
#include "modules/scene/outlined_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

namespace gnomon {

namespace {

constexpr uint32_t NONE = ~0u;		  // no triangle
const double CUTOFF_NEVER_PASSES = 2; // above every alpha
const double CUTOFF_STEPS = 32;		  // each needs an outline: 0.1 s for 2048 x 2048 texels

/// Returns the barycentric coordinates of a point on a triangle; for a triangle without area, along
/// the longer side at p_a.
glm::vec3 compute_barycentrics(const glm::dvec3 &p_point, const glm::dvec3 &p_a,
		const glm::dvec3 &p_b, const glm::dvec3 &p_c) {
	const glm::dvec3 ab = p_b - p_a;
	const glm::dvec3 ac = p_c - p_a;
	const glm::dvec3 normal = glm::cross(ab, ac);
	const double square = glm::dot(normal, normal);
	const glm::dvec3 offset = p_point - p_a;
	if (square > 0) {
		const double b = glm::dot(glm::cross(offset, ac), normal) / square;
		const double c = glm::dot(glm::cross(ab, offset), normal) / square;
		return glm::vec3(1.0 - b - c, b, c);
	}
	const bool is_ab = glm::dot(ab, ab) >= glm::dot(ac, ac);
	const glm::dvec3 side = is_ab ? ab : ac;
	const double square_length = glm::dot(side, side);
	const double fraction = square_length > 0 ? glm::dot(offset, side) / square_length : 0.0;
	return is_ab ? glm::vec3(1.0 - fraction, fraction, 0) : glm::vec3(1.0 - fraction, 0, fraction);
}

/// Cuts the triangles of a mesh one after another, in pairs where two are one quadrilateral: their
/// common edge would only divide the outline. Triangles that stay whole are added last, because the
/// cuts of their neighbours add points on their sides.
class MeshCutter {
public:
	MeshCutter(const Mesh &p_mesh, const Material &p_material, const OutlineBudget &p_budget,
			double p_tolerance_px);
	/// Returns null if nothing is left. The triangles' source is the mesh.
	std::shared_ptr<const Mesh> cut(const std::shared_ptr<const Mesh> &p_mesh);
	bool is_uncut() const { return uncut.size() * 3 == mesh.indices.size(); }
	uint32_t get_block_size_px() const { return block_size_px; }

private:
	double compute_cutoff(const uint32_t *p_corners) const;
	MeshPolygon read_triangle(uint32_t p_triangle) const;
	OutlinedTexture &get_texture(double p_cutoff);
	void list_side_triangles();
	/// Joins the polygon with a later triangle that has the same cutoff. Returns that triangle, or
	/// NONE.
	uint32_t join_triangle(uint32_t p_triangle, double p_cutoff, MeshPolygon &r_polygon) const;
	void cut_triangle(uint32_t p_triangle);
	void add_pieces(const std::vector<ClippedPiece> &p_pieces, const MeshPolygon &p_cut,
			uint32_t p_triangle);
	void sort_side_points();
	void add_uncut(uint32_t p_triangle);
	uint32_t add_point(const glm::vec3 &p_position);
	void add_triangle(uint32_t p_a, uint32_t p_b, uint32_t p_c, uint32_t p_source);
	std::vector<TrianglePoint> find_points() const;

	const Mesh &mesh;
	const Material &material;
	const Texture &texture;
	OutlineBudget budget;
	double tolerance_px;
	TileCoverage coverage;
	uint32_t block_size_px = 0;
	std::map<double, OutlinedTexture> textures; // by cutoff
	std::vector<uint32_t> uncut;				// triangles that no cut changes
	std::vector<bool> is_joined;				// per triangle: cut together with an earlier one
	/// The triangles at each edge. Empty if the mesh has a rig: a pose may fold a quadrilateral.
	std::map<std::pair<PositionBits, PositionBits>, std::vector<uint32_t>> side_triangles;
	/// Points of cut triangles on the mesh's edges, with their positions along them, 0..1:
	/// unsorted, and from both triangles at an edge.
	using SidePoints = std::vector<std::pair<double, glm::vec3>>;
	std::map<std::pair<PositionBits, PositionBits>, SidePoints> side_points;

	std::map<PositionBits, uint32_t> point_indices;
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	std::vector<uint32_t> sources;
};

MeshCutter::MeshCutter(const Mesh &p_mesh, const Material &p_material,
		const OutlineBudget &p_budget, double p_tolerance_px) :
		mesh(p_mesh),
		material(p_material), texture(p_material.base_color_texture), budget(p_budget),
		tolerance_px(p_tolerance_px) {
	if (texture.image) {
		for (uint32_t triangle = 0; triangle < mesh.get_triangle_count(); ++triangle) {
			const MeshPolygon read = read_triangle(triangle);
			if (read.has_area()) {
				coverage.add(read);
			}
		}
	}
}

/// Returns the threshold for the texture's alpha. Where vertex colours affect it, it is rounded to
/// steps, because each threshold needs an outline of its own.
double MeshCutter::compute_cutoff(const uint32_t *p_corners) const {
	double vertex_alpha = 1;
	if (!mesh.attributes.colors.empty()) {
		double sum = 0;
		for (int corner = 0; corner < 3; ++corner) {
			sum += mesh.attributes.colors[p_corners[corner]].w;
		}
		vertex_alpha = sum / 3;
	}
	const double alpha = material.alpha * vertex_alpha;
	const double cutoff = make_alpha_test(material).cutoff;
	if (cutoff <= 0) {
		return 0;
	}
	if (!(alpha >= cutoff)) {
		return CUTOFF_NEVER_PASSES;
	}
	const double fraction = cutoff / alpha;
	return vertex_alpha == 1 ? fraction
							 : std::max(std::round(fraction * CUTOFF_STEPS), 1.0) / CUTOFF_STEPS;
}

MeshPolygon MeshCutter::read_triangle(uint32_t p_triangle) const {
	MeshPolygon triangle;
	const std::vector<glm::vec2> &uvs = mesh.attributes.uvs[texture.uv_set];
	const glm::dmat3x2 transform(texture.transform);
	for (int corner = 0; corner < 3; ++corner) {
		const uint32_t index = mesh.indices[3 * size_t(p_triangle) + corner];
		const glm::dvec2 uv = uvs.empty() ? glm::dvec2(0.0) : glm::dvec2(uvs[index]);
		triangle.uv[corner] = transform * glm::dvec3(uv, 1.0);
		triangle.position[corner] = mesh.positions_node[index] + 0.0f; // -0 becomes 0
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
	return textures.try_emplace(p_cutoff, test, coverage, budget, tolerance_px).first->second;
}

void MeshCutter::cut_triangle(uint32_t p_triangle) {
	const double cutoff = compute_cutoff(&mesh.indices[3 * size_t(p_triangle)]);
	if (cutoff > 1) { // no alpha passes: nothing of the triangle is left
		return;
	}
	if (!texture.image) {
		uncut.push_back(p_triangle);
		return;
	}
	MeshPolygon polygon = read_triangle(p_triangle);
	if (!polygon.has_area()) { // cannot be clipped: the alpha at its centre decides
		const glm::dvec2 middle = (polygon.uv[0] + polygon.uv[1] + polygon.uv[2]) / 3.0;
		if (std::isfinite(middle.x + middle.y) &&
				sample_alpha(make_alpha_test(material), middle) >= cutoff) {
			uncut.push_back(p_triangle);
		}
		return;
	}
	const uint32_t other = join_triangle(p_triangle, cutoff, polygon);
	std::vector<ClippedPiece> pieces;
	double area = 0;
	for (const OutlinedTexture::Triangle &corners : get_texture(cutoff).list_triangles(polygon)) {
		ClippedPiece piece(polygon, corners);
		if (!piece.get_points().empty()) {
			area += std::abs(piece.compute_area());
			pieces.push_back(std::move(piece));
		}
	}
	const double ROUNDING = 1e-12; // relative; of the sum, if the pieces cover the whole polygon
	if (area < (1 - ROUNDING) * std::abs(polygon.area)) {
		add_pieces(pieces, polygon, p_triangle);
	} else {
		uncut.push_back(p_triangle);
		if (other != NONE) {
			uncut.push_back(other);
		}
	}
	if (other != NONE) {
		is_joined[other] = true;
	}
}

void MeshCutter::list_side_triangles() {
	if (!texture.image || mesh.attributes.rig) {
		return;
	}
	for (uint32_t triangle = 0; triangle < mesh.get_triangle_count(); ++triangle) {
		const MeshPolygon polygon = read_triangle(triangle);
		for (int side = 0; side < 3; ++side) {
			side_triangles[polygon.sides[side].get_key()].push_back(triangle);
		}
	}
}

uint32_t MeshCutter::join_triangle(
		uint32_t p_triangle, double p_cutoff, MeshPolygon &r_polygon) const {
	for (int side = 0; side < 3; ++side) {
		const auto found = side_triangles.find(r_polygon.sides[side].get_key());
		if (found == side_triangles.end() || found->second.size() != 2) {
			continue;
		}
		for (const uint32_t other : found->second) {
			if (other > p_triangle && !is_joined[other] &&
					compute_cutoff(&mesh.indices[3 * size_t(other)]) == p_cutoff &&
					r_polygon.join(read_triangle(other))) {
				return other;
			}
		}
	}
	return NONE;
}

void MeshCutter::add_pieces(
		const std::vector<ClippedPiece> &p_pieces, const MeshPolygon &p_cut, uint32_t p_triangle) {
	SidePoints *sides[4];
	for (int side = 0; side < p_cut.corner_count; ++side) {
		sides[side] = &side_points[p_cut.sides[side].get_key()];
	}
	std::vector<uint32_t> corners;
	for (const ClippedPiece &piece : p_pieces) {
		corners.clear();
		for (const ClippedPiece::Point &point : piece.get_points()) {
			const glm::vec3 position = piece.get_position(point);
			corners.push_back(add_point(position));
			if (point.side >= 0 && point.corner < 0) {
				sides[point.side]->emplace_back(point.fraction, position);
			}
		}
		const bool is_reversed = (piece.compute_area() < 0) != (p_cut.area < 0);
		for (size_t i = 1; i + 1 < corners.size(); ++i) {
			add_triangle(corners[0], corners[is_reversed ? i + 1 : i],
					corners[is_reversed ? i : i + 1], p_triangle);
		}
	}
}

/// Sorts by position along the side and removes duplicates: equal fractions give equal positions.
void MeshCutter::sort_side_points() {
	for (auto &[key, points] : side_points) {
		std::sort(points.begin(), points.end(), [](const auto &p_left, const auto &p_right) {
			return p_left.first < p_right.first;
		});
		points.erase(std::unique(points.begin(), points.end(),
							 [](const auto &p_left, const auto &p_right) {
								 return p_left.first == p_right.first;
							 }),
				points.end());
	}
}

void MeshCutter::add_uncut(uint32_t p_triangle) {
	const MeshPolygon triangle = read_triangle(p_triangle);
	std::vector<uint32_t> ring;
	for (int corner = 0; corner < 3; ++corner) {
		ring.push_back(add_point(triangle.position[corner]));
		const MeshSide &side = triangle.sides[corner];
		const auto found = side_points.find(side.get_key());
		if (found == side_points.end()) {
			continue;
		}
		std::vector<uint32_t> points;
		for (const auto &[fraction, position] : found->second) {
			points.push_back(add_point(position));
		}
		if (side.is_reversed) {
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
	// A fan from a corner would have degenerate triangles along that corner's sides.
	const uint32_t middle = add_point(glm::vec3(sum / 3.0));
	for (size_t i = 0; i < ring.size(); ++i) {
		add_triangle(middle, ring[i], ring[(i + 1) % ring.size()], p_triangle);
	}
}

uint32_t MeshCutter::add_point(const glm::vec3 &p_position) {
	const auto [found, is_new] = point_indices.try_emplace(
			to_position_bits(p_position), static_cast<uint32_t>(positions.size()));
	if (is_new) {
		positions.push_back(p_position + 0.0f); // -0 becomes 0
	}
	return found->second;
}

void MeshCutter::add_triangle(uint32_t p_a, uint32_t p_b, uint32_t p_c, uint32_t p_source) {
	if (p_a != p_b && p_b != p_c && p_c != p_a) { // otherwise rounding made it degenerate
		indices.insert(indices.end(), { p_a, p_b, p_c });
		sources.push_back(p_source);
	}
}

std::shared_ptr<const Mesh> MeshCutter::cut(const std::shared_ptr<const Mesh> &p_mesh) {
	is_joined.resize(mesh.get_triangle_count());
	list_side_triangles();
	for (uint32_t triangle = 0; triangle < mesh.get_triangle_count(); ++triangle) {
		if (!is_joined[triangle]) {
			cut_triangle(triangle);
		}
	}
	for (const auto &[cutoff, outlined] : textures) {
		block_size_px = std::max(block_size_px, outlined.get_block_size_px());
	}
	if (is_uncut()) {
		return p_mesh;
	}
	if (!uncut.empty()) {
		sort_side_points();
	}
	for (const uint32_t triangle : uncut) {
		add_uncut(triangle);
	}
	if (indices.empty()) {
		return nullptr;
	}
	std::vector<TrianglePoint> points =
			mesh.attributes.rig ? find_points() : std::vector<TrianglePoint>();
	return make_mesh(mesh.name, std::move(positions), {}, std::move(indices), {},
			MeshSource{ p_mesh, std::move(sources), std::move(points) });
}

/// Finds each point's barycentric coordinates in one of the triangles that contain it. A point on a
/// side is in two: both lead to the same position, up to rounding.
std::vector<TrianglePoint> MeshCutter::find_points() const {
	std::vector<TrianglePoint> points(positions.size());
	for (size_t corner = 0; corner < indices.size(); ++corner) {
		const uint32_t *source = &mesh.indices[3 * size_t(sources[corner / 3])];
		TrianglePoint &point = points[indices[corner]];
		point.corners = { source[0], source[1], source[2] };
		point.weights =
				compute_barycentrics(positions[indices[corner]], mesh.positions_node[source[0]],
						mesh.positions_node[source[1]], mesh.positions_node[source[2]]);
	}
	return points;
}

/// Returns everything about a mesh and a material that determines the cut, as a key of the cache.
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

/// Hashes everything that determines which parts of a mesh remain, apart from Mesh::content_hash.
uint64_t compute_content_hash(const Mesh &p_mesh, const Material &p_material) {
	const Texture &texture = p_material.base_color_texture;
	const std::vector<glm::vec2> &uvs = p_mesh.attributes.uvs[texture.uv_set];
	uint64_t hash = compute_hash(make_alpha_test(p_material), /*p_seed=*/1);
	hash = compute_value_hash(p_material.alpha, hash);
	hash = compute_value_hash(texture.transform, hash);
	hash = compute_hash(bytes_of(std::span<const glm::vec2>(uvs)), hash);
	return compute_hash(bytes_of(std::span<const glm::vec4>(p_mesh.attributes.colors)), hash);
}

struct CacheEntry {
	std::weak_ptr<const Mesh> source;
	std::weak_ptr<const Material> material; // the first that requested the cut
	CutMesh cut;

	/// Whether a later snapshot can request it again.
	bool is_reachable() const {
		return !source.expired() && (!material.expired() || cut.mesh.use_count() > 1);
	}
};

using CutKey = decltype(make_key(std::declval<Mesh>(), std::declval<Material>()));
std::mutex cache_mutex;
std::map<CutKey, CacheEntry> cache;
OutlineBudget cache_budget; // guarded by cache_mutex

} // namespace

CutMesh cut_mesh(const std::shared_ptr<const Mesh> &p_mesh, const Material &p_material,
		const OutlineBudget &p_budget, double p_tolerance_px) {
	MeshCutter cutter(*p_mesh, p_material, p_budget, p_tolerance_px);
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
	// Locked while a mesh is cut, because two threads could otherwise do the same work.
	const std::lock_guard<std::mutex> lock(cache_mutex);
	CacheEntry &entry = cache[make_key(*p_mesh, *p_material)];
	if (entry.source.expired()) { // a new entry
		CutMesh cut = cut_mesh(p_mesh, *p_material, cache_budget);
		if (cut.mesh && cut.mesh != p_mesh && cut.block_size_px == 0 &&
				p_material->base_color_texture.image) {
			cut.levels = std::make_shared<const CutLevels>(p_mesh, *p_material, cut.mesh);
		}
		entry = { p_mesh, p_material, std::move(cut) };
	}
	return entry.cut;
}

void set_outline_budget(const OutlineBudget &p_budget) {
	const std::lock_guard<std::mutex> lock(cache_mutex);
	cache_budget = p_budget;
}

void drop_unused_cut_meshes() {
	const std::lock_guard<std::mutex> lock(cache_mutex);
	std::erase_if(cache, [](const auto &p_item) { return !p_item.second.is_reachable(); });
}

size_t get_cut_mesh_count() {
	const std::lock_guard<std::mutex> lock(cache_mutex);
	return cache.size();
}

} // namespace gnomon
