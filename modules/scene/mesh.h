#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// An axis-aligned box. Default: empty (minimum above maximum).
struct Bounds {
	glm::dvec3 minimum = glm::dvec3(1e300);
	glm::dvec3 maximum = glm::dvec3(-1e300);

	bool is_empty() const { return minimum.x > maximum.x; }
	void add(const glm::dvec3 &p_point) {
		minimum = glm::min(minimum, p_point);
		maximum = glm::max(maximum, p_point);
	}
	void add(const Bounds &p_bounds) {
		minimum = glm::min(minimum, p_bounds.minimum);
		maximum = glm::max(maximum, p_bounds.maximum);
	}
	/// p_index: 0 .. 7; bits 0, 1, 2 select the maximum of x, y, z.
	glm::dvec3 get_corner(int p_index) const {
		return glm::dvec3(p_index & 1 ? maximum.x : minimum.x, p_index & 2 ? maximum.y : minimum.y,
				p_index & 4 ? maximum.z : minimum.z);
	}
	/// Distance from the point to the box; 0 inside. The box must not be empty.
	double compute_distance(const glm::dvec3 &p_point) const {
		return glm::distance(p_point, glm::clamp(p_point, minimum, maximum));
	}
	/// Returns the distance from a point, along a unit vector, to where the ray leaves the box. The
	/// point should be in the box; 0 if it is beyond the side that the ray would leave through.
	double compute_exit_distance(const glm::dvec3 &p_point, const glm::dvec3 &p_direction) const;
	/// Length of the diagonal; 0 when empty.
	double get_diagonal() const { return is_empty() ? 0 : glm::length(maximum - minimum); }
};

/// Returns the bounds of a box's corners after a transform; the box must not be empty.
Bounds transform_bounds(const Bounds &p_bounds, const glm::dmat4 &p_target_from_source);

struct Mesh;
struct MeshRig;

/// Vertex attributes other than position and normal. Each list is empty or has one element per
/// vertex.
struct MeshAttributes {
	std::vector<glm::vec2> uvs[2]; // x along an image's rows, y down from its top
	/// Direction on the surface in which u of the normal map grows. w is 1 or -1: v decreases along
	/// the cross product of normal and tangent, or grows along it.
	std::vector<glm::vec4> tangents;
	std::vector<glm::vec4> colors;		// linear, and alpha
	std::shared_ptr<const MeshRig> rig; // how the mesh deforms; null: it does not
};

/// A point on a triangle, as barycentric coordinates: it follows the corners when they move.
struct TrianglePoint {
	glm::uvec3 corners = glm::uvec3(0);		// vertex indices
	glm::vec3 weights = glm::vec3(1, 0, 0); // barycentric weights; their sum is 1
};

/// For a mesh that the alpha test cut out of another one, its source (cut_mesh.h): the source
/// triangle of each triangle. Face planes come from the source, because rounding tilts those of
/// small triangles.
struct MeshSource {
	std::weak_ptr<const Mesh> mesh; // null: the mesh was not cut out of another
	std::vector<uint32_t> triangles;
	std::vector<TrianglePoint> points; // one per vertex if the source has a rig; otherwise empty
};

/// Triangles of one material. Immutable once shared; identified by `id`.
struct Mesh {
	std::string name;
	std::vector<glm::vec3> positions_node; // metres, in the node's space; finite
	std::vector<glm::vec3> normals_node;   // unit, one per position
	MeshAttributes attributes;
	std::vector<uint32_t> indices; // three per triangle, each below the number of positions
	MeshSource source;
	/// If the GPU deforms this mesh (PoseSlot): the mesh at rest. Both have the same triangles and
	/// attributes, and the same CPU vertices: those at rest. Null for other meshes.
	std::shared_ptr<const Mesh> rest;
	uint64_t slot_id = 0; // id of that PoseSlot
	Bounds bounds_node;
	uint64_t id = 0;		   // unique in the process, see make_mesh
	uint64_t content_hash = 0; // of positions, normals, indices and rig

	uint32_t get_triangle_count() const { return static_cast<uint32_t>(indices.size() / 3); }
	/// Whether a pose can move its vertices relative to one another.
	bool is_deformable() const { return attributes.rig || !source.points.empty(); }
};

/// Checks sizes, positions and indices (a bad one is an Error naming the mesh), normalizes normals,
/// replaces missing or unusable ones by area-weighted face normals, computes the bounds and the
/// hash, and gives the mesh its id.
std::shared_ptr<const Mesh> make_mesh(std::string p_name, std::vector<glm::vec3> p_positions_node,
		std::vector<glm::vec3> p_normals_node, std::vector<uint32_t> p_indices,
		MeshAttributes p_attributes = {}, MeshSource p_source = {});
/// Makes a mesh with the same triangles and an id of its own, whose vertices a pose sets; see
/// Mesh::rest.
std::shared_ptr<const Mesh> make_deformed_mesh(
		const std::shared_ptr<const Mesh> &p_rest, uint64_t p_slot_id);

/// Computes tangents for a mesh that has no tangents, from its UVs: for each vertex the
/// angle-weighted sum over its faces, orthogonal to its normal. Vertices whose faces disagree on
/// handedness are not split. p_uvs: one per vertex.
std::vector<glm::vec4> compute_tangents(const std::vector<glm::vec3> &p_positions,
		const std::vector<glm::vec3> &p_normals, const std::vector<uint32_t> &p_indices,
		const std::vector<glm::vec2> &p_uvs);

} // namespace gnomon
