#pragma once

#include "modules/shadow_reference/caster_scene.h"

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

/// Occluders and receivers whose exact visibility is known. z is up; receivers are in the plane
/// z = 0 and face up.
namespace gnomon::test_scenes {

/// Builds a scene of opaque triangles.
struct TriangleBuilder : Triangles {
	CasterScene build() const { return CasterScene(positions, indices); }
	void scale(float p_factor) {
		for (glm::vec3 &position : positions) {
			position *= p_factor;
		}
	}
	void add_quad(const glm::vec3 &p_a, const glm::vec3 &p_b, const glm::vec3 &p_c,
			const glm::vec3 &p_d) {
		const uint32_t first = static_cast<uint32_t>(positions.size());
		positions.insert(positions.end(), { p_a, p_b, p_c, p_d });
		indices.insert(indices.end(), { first, first + 1, first + 2, first, first + 2, first + 3 });
	}
	/// Adds a rectangle, x < p_edge_x at the height p_height, large enough to be a half-plane for
	/// all receivers of the tests.
	void add_half_plane(float p_edge_x, float p_height) {
		add_quad({ p_edge_x, -500, p_height }, { p_edge_x, 500, p_height },
				{ p_edge_x - 500, 500, p_height }, { p_edge_x - 500, -500, p_height });
	}
	/// Adds a disc of 2000 corners. Its area differs from the circle's by a fraction of 2e-6.
	void add_disc(const glm::dvec3 &p_centre, const glm::dvec3 &p_axis_x,
			const glm::dvec3 &p_axis_y, double p_radius) {
		const uint32_t first = static_cast<uint32_t>(positions.size());
		const uint32_t side_count = 2000;
		positions.emplace_back(p_centre);
		for (uint32_t i = 0; i < side_count; ++i) {
			const double angle_rad = 2 * std::numbers::pi * i / side_count;
			positions.emplace_back(p_centre +
					p_radius * (std::cos(angle_rad) * p_axis_x + std::sin(angle_rad) * p_axis_y));
			indices.insert(
					indices.end(), { first, first + 1 + i, first + 1 + (i + 1) % side_count });
		}
	}
};

constexpr float OFFSET_M = 2e-4f; // of the receivers' rays from the ground

/// Returns p_count x p_count receivers on a square of the ground around the origin.
inline std::vector<ReceiverPoint> make_ground(uint32_t p_count, float p_half_size) {
	std::vector<ReceiverPoint> points;
	for (uint32_t y = 0; y < p_count; ++y) {
		for (uint32_t x = 0; x < p_count; ++x) {
			const glm::vec2 position =
					(glm::vec2(x, y) + 0.5f) / static_cast<float>(p_count) * 2.0f - 1.0f;
			points.push_back({ glm::vec3(position * p_half_size, 0.0f), glm::vec3(0, 0, 1),
					/*is_receiver=*/true, /*spread_radius_m=*/0.0f, OFFSET_M });
		}
	}
	return points;
}

/// Returns the point at which the rays of a receiver start.
inline glm::dvec3 get_start(const ReceiverPoint &p_point) {
	return glm::dvec3(p_point.position) +
			double(p_point.offset_m) * glm::dvec3(p_point.geometric_normal);
}

inline VisibilityOptions make_options(uint32_t p_sample_count) {
	VisibilityOptions options;
	options.sample_count = p_sample_count;
	return options;
}

} // namespace gnomon::test_scenes
