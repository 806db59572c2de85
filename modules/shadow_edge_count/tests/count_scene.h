#pragma once

#include "modules/scene/box_mesh.h"
#include "modules/shadow_edge_count/count_in_double.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace gnomon {

/// A sphere tessellated into p_rings rings of 2 p_rings patches.
inline std::shared_ptr<const Mesh> make_count_sphere(double p_radius, uint32_t p_rings) {
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	const uint32_t columns = 2 * p_rings;
	for (uint32_t ring = 0; ring <= p_rings; ++ring) {
		for (uint32_t column = 0; column < columns; ++column) {
			const double polar = std::numbers::pi * ring / p_rings;
			const double azimuth = 2.0 * std::numbers::pi * column / columns;
			const double across = ring == 0 || ring == p_rings ? 0.0 : std::sin(polar);
			positions.push_back(glm::vec3(p_radius *
					glm::dvec3(across * std::cos(azimuth), std::cos(polar),
							across * std::sin(azimuth))));
		}
	}
	for (uint32_t ring = 0; ring < p_rings; ++ring) {
		for (uint32_t column = 0; column < columns; ++column) {
			const uint32_t a = ring * columns + column;
			const uint32_t b = ring * columns + (column + 1) % columns;
			if (ring > 0) {
				indices.insert(indices.end(), { a, b, b + columns });
			}
			if (ring + 1 < p_rings) {
				indices.insert(indices.end(), { a, b + columns, a + columns });
			}
		}
	}
	return make_mesh("sphere", std::move(positions), {}, std::move(indices));
}

/// How far receivers are moved off their surfaces, in S: as far as in images of small scenes.
constexpr double RECEIVER_OFFSET_SIZES = 5e-5;

/// Meshes and a light. Computes the visibility of a point by counting and by tracing rays.
class CountScene {
public:
	glm::dvec3 light = glm::dvec3(1.8, 6.0, 1.2);
	glm::dvec3 target = glm::dvec3(0.0, 0.4, 0.0);
	bool is_directional = false;
	double radius = 0.4;		   // R; directional: a tangent
	double scene_size = 4;		   // S in metres
	double half_extent = 0.95;	   // of the view: a tangent; directional: metres
	uint32_t sample_set_count = 1; // sets of 64 points: 1 or 4

	void add(const std::shared_ptr<const Mesh> &p_mesh, const glm::dmat4 &p_world_from_node) {
		objects.push_back({ get_topology(p_mesh), p_world_from_node });
	}

	/// Must be called after the last change, before any computation.
	void build() {
		const glm::dvec3 forward = glm::normalize(target - light);
		const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0)));
		const glm::dmat3 rotation =
				glm::transpose(glm::dmat3(right, glm::cross(forward, right), forward));
		view_from_world = glm::dmat4(rotation);
		view_from_world[3] = glm::dvec4(-(rotation * light), 1.0);
		space.is_directional = is_directional;
		space.disc_radius = radius;
		// As in make_count_light_constants, apart from views of great depth.
		space.nearer_tolerance = 2e-5 * (is_directional ? scene_size : 1.0);
		space.scene_size_m = scene_size;
		casters = {};
		triangles.clear();
		for (const Object &object : objects) {
			casters.add_mesh(*object.topology, view_from_world * object.world_from_node, space);
			for (const uint32_t vertex : object.topology->triangles) {
				triangles.push_back(glm::dvec3(object.world_from_node *
						glm::dvec4(object.topology->welded_positions_node[vertex], 1.0)));
			}
		}
		masks.clear();
		for (uint32_t sample_set = 0; sample_set < sample_set_count; ++sample_set) {
			masks.emplace_back(sample_set, sample_set_count);
		}
	}

	/// The position of a receiver in light space, moved off its surface.
	glm::dvec3 make_receiver(const glm::dvec3 &p_position, const glm::dvec3 &p_normal) const {
		const glm::dvec3 moved = p_position + p_normal * (RECEIVER_OFFSET_SIZES * scene_size);
		return glm::dvec3(view_from_world * glm::dvec4(moved, 1.0));
	}

	/// Visibility of a receiver by counting. p_receiver: see make_receiver.
	double count(const glm::dvec3 &p_receiver) const {
		return compute_count_visibility(space, p_receiver, casters.edges, casters.faces, masks);
	}
	double count(const glm::dvec3 &p_position, const glm::dvec3 &p_normal) const {
		return count(make_receiver(p_position, p_normal));
	}

	/// Visibility by tracing rays: the fraction of p_count points of the light that no triangle
	/// hides. The points are on the disc that faces p_position.
	double trace(const glm::dvec3 &p_position, const glm::dvec3 &p_normal, uint32_t p_count) const {
		const glm::dvec3 from = p_position + p_normal * (RECEIVER_OFFSET_SIZES * scene_size);
		const glm::dvec3 to_light = is_directional ? glm::normalize(light - target) : light - from;
		const glm::dvec3 axis = glm::normalize(to_light);
		const glm::dvec3 u = glm::normalize(glm::cross(axis, glm::dvec3(0.3, 1.0, 0.2)));
		const glm::dvec3 v = glm::cross(axis, u);
		uint32_t seen = 0;
		for (uint32_t index = 0; index < p_count; ++index) {
			const double r = std::sqrt((index + 0.5) / p_count) * radius;
			const double angle = 2.399963229728653 * index; // the golden angle
			const glm::dvec3 to = to_light + u * (r * std::cos(angle)) + v * (r * std::sin(angle));
			// Directional: to beyond all casters.
			seen += is_hidden(from, is_directional ? to * (10.0 * scene_size) : to) ? 0 : 1;
		}
		return double(seen) / p_count;
	}

	const std::vector<CountEdge> &get_edges() const { return casters.edges; }
	const std::vector<CountFace> &get_faces() const { return casters.faces; }
	const CountSpace &get_space() const { return space; }
	const std::vector<DiscLookup> &get_masks() const { return masks; }

private:
	struct Object {
		std::shared_ptr<const MeshTopology> topology;
		glm::dmat4 world_from_node;
	};

	/// True if a triangle intersects the segment from p_from to p_from + p_segment (Möller and
	/// Trumbore 1997).
	bool is_hidden(const glm::dvec3 &p_from, const glm::dvec3 &p_segment) const {
		for (size_t first = 0; first < triangles.size(); first += 3) {
			const glm::dvec3 e1 = triangles[first + 1] - triangles[first];
			const glm::dvec3 e2 = triangles[first + 2] - triangles[first];
			const glm::dvec3 h = glm::cross(p_segment, e2);
			const double determinant = glm::dot(e1, h);
			if (determinant == 0) {
				continue;
			}
			const glm::dvec3 s = (p_from - triangles[first]) / determinant;
			const double b = glm::dot(s, h);
			const glm::dvec3 q = glm::cross(s, e1);
			const double c = glm::dot(p_segment, q);
			const double t = glm::dot(e2, q);
			if (b >= 0 && c >= 0 && b + c <= 1 && t > 0 && t < 1) {
				return true;
			}
		}
		return false;
	}

	std::vector<Object> objects;
	CountSpace space;
	glm::dmat4 view_from_world = glm::dmat4(1.0);
	CountedCasters casters;
	std::vector<DiscLookup> masks;
	std::vector<glm::dvec3> triangles; // world, three per face
};

} // namespace gnomon
