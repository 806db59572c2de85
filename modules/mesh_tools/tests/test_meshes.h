#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

/// Small meshes with known topology.
namespace gnomon::test_meshes {

inline Mesh make(std::vector<glm::vec3> p_positions, std::vector<uint32_t> p_indices) {
	Mesh mesh;
	mesh.name = "test";
	mesh.positions_node = std::move(p_positions);
	mesh.indices = std::move(p_indices);
	return mesh;
}

/// Returns a cube with side length 2: 8 corners shared by 12 triangles with outward winding.
inline Mesh make_cube(const glm::vec3 &p_centre = glm::vec3(0.0f)) {
	std::vector<glm::vec3> positions;
	for (int i = 0; i < 8; ++i) {
		positions.push_back(p_centre + glm::vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
	}
	return make(positions,
			{ 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6,
					2, 1, 3, 7, 1, 7, 5 });
}

/// Returns the same triangles, each with its own corners, as in a glTF file with hard edges.
inline Mesh unweld(const Mesh &p_mesh) {
	Mesh mesh = make({}, {});
	for (const uint32_t index : p_mesh.indices) {
		mesh.indices.push_back(static_cast<uint32_t>(mesh.positions_node.size()));
		mesh.positions_node.push_back(p_mesh.positions_node[index]);
	}
	return mesh;
}

inline Mesh join(const Mesh &p_left, const Mesh &p_right) {
	Mesh mesh = p_left;
	const uint32_t offset = static_cast<uint32_t>(p_left.positions_node.size());
	mesh.positions_node.insert(mesh.positions_node.end(), p_right.positions_node.begin(),
			p_right.positions_node.end());
	for (const uint32_t index : p_right.indices) {
		mesh.indices.push_back(offset + index);
	}
	return mesh;
}

inline Mesh make_octahedron() {
	return make({ { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } },
			{ 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5 });
}

/// Returns a sphere of unit radius: an octahedron subdivided p_level times, with 8 * 4^p_level
/// triangles.
inline Mesh make_sphere(int p_level) {
	Mesh mesh = make_octahedron();
	for (int level = 0; level < p_level; ++level) {
		std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
		const auto find_middle = [&](uint32_t p_a, uint32_t p_b) {
			const auto [item, is_new] = middles.try_emplace(
					std::minmax(p_a, p_b), static_cast<uint32_t>(mesh.positions_node.size()));
			if (is_new) {
				mesh.positions_node.push_back(
						glm::normalize(mesh.positions_node[p_a] + mesh.positions_node[p_b]));
			}
			return item->second;
		};
		std::vector<uint32_t> indices;
		for (size_t i = 0; i < mesh.indices.size(); i += 3) {
			const uint32_t a = mesh.indices[i];
			const uint32_t b = mesh.indices[i + 1];
			const uint32_t c = mesh.indices[i + 2];
			const uint32_t ab = find_middle(a, b);
			const uint32_t bc = find_middle(b, c);
			const uint32_t ca = find_middle(c, a);
			indices.insert(indices.end(), { a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca });
		}
		mesh.indices = indices;
	}
	return mesh;
}

/// Returns a torus of p_u x p_v quads. p_u = 200 and p_v = 174 give about as many triangles as the
/// Stanford bunny.
inline Mesh make_torus(uint32_t p_u, uint32_t p_v) {
	Mesh mesh = make({}, {});
	for (uint32_t i = 0; i < p_u; ++i) {
		for (uint32_t j = 0; j < p_v; ++j) {
			const double u = 2 * std::numbers::pi * i / p_u;
			const double v = 2 * std::numbers::pi * j / p_v;
			mesh.positions_node.emplace_back((2 + 0.7 * std::cos(v)) * std::cos(u),
					(2 + 0.7 * std::cos(v)) * std::sin(u), 0.7 * std::sin(v));
			const uint32_t right = (i + 1) % p_u * p_v;
			const uint32_t up = (j + 1) % p_v;
			const uint32_t a = i * p_v + j;
			const uint32_t b = right + j;
			const uint32_t c = right + up;
			const uint32_t d = i * p_v + up;
			mesh.indices.insert(mesh.indices.end(), { a, b, c, a, c, d });
		}
	}
	return mesh;
}

inline Mesh make_quad() {
	return make({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }, { 0, 1, 2, 0, 2, 3 });
}

/// Returns a Moebius strip of p_count quads, a band with half a twist: it has one boundary and no
/// consistent winding.
inline Mesh make_moebius(uint32_t p_count) {
	Mesh mesh = make({}, {});
	for (uint32_t i = 0; i < p_count; ++i) {
		const double u = 2 * std::numbers::pi * i / p_count;
		for (const double side : { -0.4, 0.4 }) {
			const double radius = 1 + side * std::cos(u / 2);
			mesh.positions_node.emplace_back(
					radius * std::cos(u), radius * std::sin(u), side * std::sin(u / 2));
		}
		const uint32_t a = 2 * i;
		const uint32_t b = 2 * i + 1;
		const bool is_last = i + 1 == p_count;
		const uint32_t c = is_last ? 1 : 2 * i + 2; // the ends meet with a half twist
		const uint32_t d = is_last ? 0 : 2 * i + 3;
		mesh.indices.insert(mesh.indices.end(), { a, c, b, b, c, d });
	}
	return mesh;
}

/// Returns random triangles over a few points, which have every kind of defect.
inline Mesh make_soup(uint32_t p_seed, uint32_t p_point_count, uint32_t p_triangle_count) {
	std::mt19937 random(p_seed);
	// On a grid, so that points and lines coincide.
	std::uniform_int_distribution<int> coordinate(-3, 3);
	Mesh mesh = make({}, {});
	for (uint32_t i = 0; i < p_point_count; ++i) {
		mesh.positions_node.emplace_back(
				coordinate(random), coordinate(random), coordinate(random));
	}
	std::uniform_int_distribution<uint32_t> point(0, p_point_count - 1);
	for (uint32_t i = 0; i < 3 * p_triangle_count; ++i) {
		mesh.indices.push_back(point(random));
	}
	return mesh;
}

} // namespace gnomon::test_meshes
