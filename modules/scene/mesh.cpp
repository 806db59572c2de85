#include "modules/scene/mesh.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/finite.h"
#include "modules/scene/mesh_rig.h"

#include <atomic>
#include <cmath>
#include <utility>

namespace gnomon {

namespace {

// A normal or tangent this short has lost its direction to rounding; a longer one is only rescaled.
const double MIN_NORMAL_LENGTH = 1e-6;
// Normals that are unit to within float rounding stay bit for bit as they came.
const double UNIT_TOLERANCE = 1e-6;

uint64_t make_mesh_id() {
	static std::atomic<uint64_t> next_id = 1;
	return next_id++;
}

void check_mesh(const Mesh &p_mesh) {
	const size_t vertex_count = p_mesh.positions_node.size();
	if (vertex_count > UINT32_MAX) {
		fail("Mesh \"", p_mesh.name, "\" has ", vertex_count, " vertices, must be at most ",
				UINT32_MAX, ". Split it.");
	}
	if (p_mesh.indices.size() % 3 != 0) {
		fail("Mesh \"", p_mesh.name, "\" has ", p_mesh.indices.size(),
				" indices, must be three per triangle. Triangulate it.");
	}
	if (!p_mesh.normals_node.empty() && p_mesh.normals_node.size() != vertex_count) {
		fail("Mesh \"", p_mesh.name, "\" has ", p_mesh.normals_node.size(),
				" normals, must be 0 or ", vertex_count,
				", one per position. Leave them out to have them computed.");
	}
	const MeshAttributes &attributes = p_mesh.attributes;
	for (const auto &[kind, count] : { std::pair("UVs of set 0", attributes.uvs[0].size()),
				 std::pair("UVs of set 1", attributes.uvs[1].size()),
				 std::pair("tangents", attributes.tangents.size()),
				 std::pair("colours", attributes.colors.size()) }) {
		if (count != 0 && count != vertex_count) {
			fail("Mesh \"", p_mesh.name, "\" has ", count, " ", kind, ", must be 0 or ",
					vertex_count, ", one per position. Export it again.");
		}
	}
	if (attributes.rig && attributes.rig->vertex_count != vertex_count) {
		fail("Mesh \"", p_mesh.name, "\" has joints or morph targets of ",
				attributes.rig->vertex_count, " vertices, must be ", vertex_count,
				", one per position. Export it again.");
	}
	for (size_t index = 0; index < vertex_count; ++index) {
		if (!is_finite(p_mesh.positions_node[index])) {
			fail("Mesh \"", p_mesh.name, "\": position ", index,
					" is not finite. Correct the vertex or export the mesh again.");
		}
	}
	for (size_t index = 0; index < p_mesh.indices.size(); ++index) {
		if (p_mesh.indices[index] >= vertex_count) {
			fail("Mesh \"", p_mesh.name, "\": index ", index, " is ", p_mesh.indices[index],
					", must be below ", vertex_count,
					", the number of positions. Export it again.");
		}
	}
}

/// Sums the normals of the faces at each vertex, weighted by area: the cross product's length is
/// twice the area. Uses double: in a float sum, a square millimetre vanishes beside a square of
/// 10 m.
std::vector<glm::dvec3> compute_face_normal_sums(const Mesh &p_mesh) {
	std::vector<glm::dvec3> sums(p_mesh.positions_node.size(), glm::dvec3(0.0));
	for (size_t first = 0; first + 2 < p_mesh.indices.size(); first += 3) {
		const uint32_t *corners = &p_mesh.indices[first];
		const glm::dvec3 origin = p_mesh.positions_node[corners[0]];
		const glm::dvec3 normal = glm::cross(glm::dvec3(p_mesh.positions_node[corners[1]]) - origin,
				glm::dvec3(p_mesh.positions_node[corners[2]]) - origin);
		for (int corner = 0; corner < 3; ++corner) {
			sums[corners[corner]] += normal;
		}
	}
	return sums;
}

void repair_normals(Mesh &r_mesh) {
	std::vector<glm::dvec3> sums; // computed when the first normal needs it
	r_mesh.normals_node.resize(r_mesh.positions_node.size(), glm::vec3(0.0f));
	for (size_t index = 0; index < r_mesh.normals_node.size(); ++index) {
		glm::vec3 &normal = r_mesh.normals_node[index];
		const double length = is_finite(normal) ? glm::length(glm::dvec3(normal)) : 0.0;
		if (std::abs(length - 1.0) <= UNIT_TOLERANCE) {
			continue;
		}
		if (length > MIN_NORMAL_LENGTH) {
			normal = glm::vec3(glm::dvec3(normal) / length);
			continue;
		}
		if (sums.empty()) {
			sums = compute_face_normal_sums(r_mesh);
		}
		const double sum_length = glm::length(sums[index]);
		// A vertex without any area has no normal; any unit vector keeps shaders free of NaN.
		normal = sum_length > 0 && std::isfinite(sum_length) ? glm::vec3(sums[index] / sum_length)
															 : glm::vec3(0.0f, 1.0f, 0.0f);
	}
}

} // namespace

std::shared_ptr<const Mesh> make_mesh(std::string p_name, std::vector<glm::vec3> p_positions_node,
		std::vector<glm::vec3> p_normals_node, std::vector<uint32_t> p_indices,
		MeshAttributes p_attributes, MeshSource p_source) {
	auto mesh = std::make_shared<Mesh>();
	mesh->name = std::move(p_name);
	mesh->positions_node = std::move(p_positions_node);
	mesh->normals_node = std::move(p_normals_node);
	mesh->indices = std::move(p_indices);
	mesh->attributes = std::move(p_attributes);
	mesh->source = std::move(p_source);
	check_mesh(*mesh);
	repair_normals(*mesh);
	for (const glm::vec3 &position : mesh->positions_node) {
		mesh->bounds_node.add(glm::dvec3(position));
	}
	mesh->content_hash = compute_hash(bytes_of(std::span<const glm::vec3>(mesh->positions_node)));
	mesh->content_hash = compute_hash(
			bytes_of(std::span<const glm::vec3>(mesh->normals_node)), mesh->content_hash);
	mesh->content_hash =
			compute_hash(bytes_of(std::span<const uint32_t>(mesh->indices)), mesh->content_hash);
	if (mesh->attributes.rig) {
		mesh->content_hash =
				compute_value_hash(mesh->attributes.rig->content_hash, mesh->content_hash);
	}
	mesh->id = make_mesh_id();
	return mesh;
}

std::shared_ptr<const Mesh> make_deformed_mesh(
		const std::shared_ptr<const Mesh> &p_rest, uint64_t p_slot_id) {
	auto mesh = std::make_shared<Mesh>(*p_rest);
	mesh->rest = p_rest;
	mesh->slot_id = p_slot_id;
	mesh->id = make_mesh_id();
	return mesh;
}

std::vector<glm::vec4> compute_tangents(const std::vector<glm::vec3> &p_positions,
		const std::vector<glm::vec3> &p_normals, const std::vector<uint32_t> &p_indices,
		const std::vector<glm::vec2> &p_uvs) {
	std::vector<glm::dvec3> tangent_sums(p_positions.size(), glm::dvec3(0.0));
	std::vector<double> handedness_sums(p_positions.size(), 0.0);
	for (size_t first = 0; first + 2 < p_indices.size(); first += 3) {
		const uint32_t *corners = &p_indices[first];
		glm::dvec3 positions[3];
		glm::dvec2 uvs[3];
		for (int corner = 0; corner < 3; ++corner) {
			positions[corner] = p_positions[corners[corner]];
			uvs[corner] = p_uvs[corners[corner]];
		}
		const glm::dvec2 du(uvs[1].x - uvs[0].x, uvs[2].x - uvs[0].x);
		const glm::dvec2 dv(uvs[1].y - uvs[0].y, uvs[2].y - uvs[0].y);
		const double area = du.x * dv.y - du.y * dv.x;
		const glm::dvec3 sum =
				(positions[1] - positions[0]) * dv.y - (positions[2] - positions[0]) * dv.x;
		const double length = glm::length(sum);
		if (!(length > 0) || area == 0) {
			continue; // degenerate
		}
		const glm::dvec3 tangent = sum * ((area < 0 ? -1.0 : 1.0) / length);
		for (int corner = 0; corner < 3; ++corner) {
			const glm::dvec3 a = positions[(corner + 1) % 3] - positions[corner];
			const glm::dvec3 b = positions[(corner + 2) % 3] - positions[corner];
			const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
			tangent_sums[corners[corner]] += tangent * angle;
			// An image's y grows downwards.
			handedness_sums[corners[corner]] += area < 0 ? angle : -angle;
		}
	}
	std::vector<glm::vec4> tangents;
	tangents.reserve(p_positions.size());
	for (size_t index = 0; index < p_positions.size(); ++index) {
		const glm::dvec3 normal = p_normals[index];
		glm::dvec3 tangent = tangent_sums[index] - normal * glm::dot(normal, tangent_sums[index]);
		if (!(glm::length(tangent) > MIN_NORMAL_LENGTH)) { // any perpendicular one
			tangent = glm::cross(
					normal, std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
		}
		tangents.emplace_back(glm::normalize(tangent), handedness_sums[index] < 0 ? -1.0f : 1.0f);
	}
	return tangents;
}

double Bounds::compute_exit_distance(
		const glm::dvec3 &p_point, const glm::dvec3 &p_direction) const {
	double nearest = 1e300; // beyond any side of the box
	for (int axis = 0; axis < 3; ++axis) {
		const double side = p_direction[axis] > 0 ? maximum[axis] : minimum[axis];
		if (p_direction[axis] != 0) {
			nearest = std::min(nearest, (side - p_point[axis]) / p_direction[axis]);
		}
	}
	return std::max(nearest, 0.0);
}

Bounds transform_bounds(const Bounds &p_bounds, const glm::dmat4 &p_target_from_source) {
	Bounds bounds;
	for (int corner = 0; corner < 8; ++corner) {
		bounds.add(glm::dvec3(p_target_from_source * glm::dvec4(p_bounds.get_corner(corner), 1.0)));
	}
	return bounds;
}

} // namespace gnomon
