// build: optimised
// Visibility counted in double precision (count_in_double.h), compared with rays to points of the
// light.

#include "modules/shadow_edge_count/tests/count_scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace gnomon;

namespace {

const glm::dvec3 GROUND_NORMAL(0.0, 1.0, 0.0);

void add_ground(CountScene &r_scene, double p_scale = 1) {
	r_scene.add(make_box_mesh("box", glm::vec3(4.2, 0.2, 4.2) * float(p_scale)),
			glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.2, 0.0) * p_scale));
}

void add_tilted_box(CountScene &r_scene, double p_scale = 1) {
	r_scene.add(make_box_mesh("box", glm::vec3(0.5, 0.3, 0.4) * float(p_scale)),
			glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 1.2, 0.1) * p_scale), 0.4,
					glm::dvec3(0.3, 1.0, 0.1)));
}

void make_directional(CountScene &r_scene, double p_tangent) {
	r_scene.is_directional = true;
	r_scene.radius = p_tangent;
	r_scene.half_extent = 6.0; // metres
}

struct Difference {
	double mean = 0;	// over penumbra points
	double maximum = 0; // over all points
	uint32_t penumbra_count = 0;
};

/// Compares counting with tracing rays, at 16 x 16 points of the ground: a square with the side
/// 2 p_half_width, shifted from the origin to where the light casts the shadow. p_is_inside:
/// returns true for points inside a solid, which are skipped since no camera sees them.
template <typename Predicate>
Difference compare_visibility(
		const CountScene &p_scene, double p_half_width, Predicate p_is_inside) {
	const int steps = 16;
	const uint32_t ray_count = 1024;
	Difference difference;
	for (int y = 0; y < steps; ++y) {
		for (int x = 0; x < steps; ++x) {
			const glm::dvec3 position =
					glm::dvec3((x + 0.37) / steps * 2 - 1.25, 0.0, (y + 0.61) / steps * 2 - 1.15) *
					p_half_width;
			if (p_is_inside(position)) {
				continue;
			}
			const double reference = p_scene.trace(position, GROUND_NORMAL, ray_count);
			const double counted = p_scene.count(position, GROUND_NORMAL);
			REQUIRE(counted >= 0.0);
			REQUIRE(counted <= 1.0);
			const double error = std::abs(counted - reference);
			difference.maximum = std::max(difference.maximum, error);
			if (reference > 0.002 && reference < 0.998) {
				difference.mean += error;
				++difference.penumbra_count;
			}
		}
	}
	difference.mean /= std::max(1u, difference.penumbra_count);
	return difference;
}

Difference compare_visibility(const CountScene &p_scene, double p_half_width) {
	return compare_visibility(p_scene, p_half_width, [](const glm::dvec3 &) { return false; });
}

} // namespace

TEST_CASE("[EdgeCount] the shadow of one solid matches ray tracing, for lights of every size") {
	for (const double radius : { 0.0, 0.08, 0.4, 1.2, 3.0 }) {
		CAPTURE(radius);
		CountScene scene;
		scene.radius = radius;
		add_ground(scene);
		add_tilted_box(scene);
		scene.build();
		const Difference difference = compare_visibility(scene, 1.4);
		CHECK(difference.mean < 0.002); // includes the noise of the rays
		CHECK(difference.maximum < 0.008);
		CHECK((difference.penumbra_count > 0) == (radius > 0));
	}
}

TEST_CASE("[EdgeCount] the shadow of a sphere matches ray tracing, for both kinds of light") {
	for (const bool is_directional : { false, true }) {
		CAPTURE(is_directional);
		CountScene scene;
		if (is_directional) {
			make_directional(scene, 0.07); // about that of the other light: 0.4 m at 6 m
		}
		add_ground(scene);
		scene.add(make_count_sphere(0.8, 8),
				glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 1.3, 0.0)));
		scene.build();
		const Difference difference = compare_visibility(scene, 1.4);
		CHECK(difference.mean < 0.002);
		CHECK(difference.maximum < 0.008);
		CHECK(difference.penumbra_count > 10);
	}
}

TEST_CASE("[EdgeCount] overlapping shadows of several solids match ray tracing") {
	for (const uint32_t sample_set_count : { 1u, 4u }) {
		CAPTURE(sample_set_count);
		CountScene scene;
		scene.sample_set_count = sample_set_count;
		add_ground(scene);
		for (int index = 0; index < 4; ++index) {
			const glm::dvec3 position(
					0.3 * std::cos(2.1 * index), 0.5 + 0.55 * index, 0.3 * std::sin(2.1 * index));
			scene.add(make_box_mesh("box", glm::vec3(0.35, 0.04, 0.3)),
					glm::rotate(glm::translate(glm::dmat4(1.0), position), 0.7 * index,
							glm::dvec3(0.2, 1.0, 0.1)));
		}
		scene.build();
		const Difference difference = compare_visibility(scene, 1.4);
		CHECK(difference.mean < (sample_set_count == 1 ? 0.01 : 0.006));
		CHECK(difference.maximum < (sample_set_count == 1 ? 0.06 : 0.04));
		CHECK(difference.penumbra_count > 50);
	}
}

TEST_CASE("[EdgeCount] a solid that is sunk into the ground leaks no light") {
	CountScene scene;
	scene.radius = 0.4;
	add_ground(scene);
	const glm::dmat4 transform = glm::rotate(
			glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, 0.97, 0.1)), 0.4, GROUND_NORMAL);
	const glm::dvec3 half(0.35, 1.02, 0.35);
	scene.add(make_box_mesh("box", glm::vec3(half)), transform);
	scene.build();
	const Difference difference = compare_visibility(scene, 1.4, [&](const glm::dvec3 &p_position) {
		const glm::dvec3 own = glm::dvec3(glm::inverse(transform) * glm::dvec4(p_position, 1.0));
		return glm::all(glm::lessThan(glm::abs(own), half));
	});
	CHECK(difference.mean < 0.003);
	CHECK(difference.maximum < 0.02);
	CHECK(difference.penumbra_count > 20);
}

TEST_CASE("[EdgeCount] shadows of open meshes match ray tracing from both sides") {
	for (const bool is_flipped : { false, true }) {
		CAPTURE(is_flipped);
		CountScene scene;
		add_ground(scene);
		std::vector<uint32_t> indices = { 0, 1, 2, 0, 2, 3 };
		if (is_flipped) {
			std::reverse(indices.begin(), indices.end());
		}
		scene.add(make_mesh("quad",
						  { { -0.5f, 0, -0.4f }, { 0.5f, 0, -0.4f }, { 0.5f, 0, 0.4f },
								  { -0.5f, 0, 0.4f } },
						  {}, indices),
				glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 1.2, 0.1)), 0.3,
						glm::dvec3(1.0, 0.2, 0.4)));
		scene.build();
		const Difference difference = compare_visibility(scene, 1.4);
		CHECK(difference.mean < 0.002);
		CHECK(difference.maximum < 0.008);
	}
}

TEST_CASE("[EdgeCount] the scale of the scene does not change visibility") {
	std::vector<double> values[3];
	const double scales[] = { 1.0, 1e-3, 1e3 };
	for (int index = 0; index < 3; ++index) {
		const double scale = scales[index];
		CountScene scene;
		scene.light *= scale;
		scene.target *= scale;
		scene.radius *= scale;
		scene.scene_size *= scale;
		add_ground(scene, scale);
		add_tilted_box(scene, scale);
		scene.build();
		for (int step = 0; step < 100; ++step) {
			const glm::dvec3 position(-1.4 + 0.011 * step, 0.0, -1.2 + 0.017 * step);
			values[index].push_back(scene.count(position * scale, GROUND_NORMAL));
		}
	}
	for (size_t step = 0; step < values[0].size(); ++step) {
		// Not equal: positions of meshes are float32.
		CHECK(std::abs(values[1][step] - values[0][step]) < 1e-3);
		CHECK(std::abs(values[2][step] - values[0][step]) < 1e-3);
	}
}

TEST_CASE("[EdgeCount] visibility is exactly 1 with nothing before the light and exactly 0 in full "
		  "shadow") {
	CountScene scene;
	add_ground(scene);
	scene.build();
	CHECK(scene.count({ 0.3, 0.0, 0.2 }, GROUND_NORMAL) == 1.0);
	scene.add(make_box_mesh("box", glm::vec3(2.0, 0.3, 2.0)),
			glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 1.5, 0.0)));
	scene.build();
	CHECK(scene.count({ -0.4, 0.0, -0.3 }, GROUND_NORMAL) == 0.0);
	CHECK(scene.count({ 0.0, 1.8, 0.0 }, GROUND_NORMAL) == 1.0); // on top of the box
}

TEST_CASE("[EdgeCount] shadows of casters that cut the light's disc match ray tracing") {
	const auto quad = make_mesh("quad",
			{ { -0.5f, 0.0f, -0.5f }, { 0.5f, 0.0f, -0.5f }, { 0.5f, 0.0f, 0.5f },
					{ -0.5f, 0.0f, 0.5f } },
			{}, { 0, 1, 2, 0, 2, 3 });
	const std::shared_ptr<const Mesh> meshes[] = {
		make_box_mesh("box", glm::vec3(0.3f, 0.2f, 0.5f)), make_count_sphere(0.3, 8), quad
	};
	for (const auto &mesh : meshes) {
		CAPTURE(mesh->name);
		for (const glm::dvec3 &offset : { glm::dvec3(0.02, 0.01, -0.03), glm::dvec3(0.3, 0.1, 0.1),
					 glm::dvec3(-0.1, 0.35, 0.2), glm::dvec3(0.05, -0.25, -0.3) }) {
			for (const double angle_rad : { 0.0, 0.5, 1.4 }) {
				CAPTURE(offset.x);
				CAPTURE(angle_rad);
				CountScene scene;
				scene.sample_set_count = 4;
				add_ground(scene);
				scene.add(mesh,
						glm::rotate(glm::translate(glm::dmat4(1.0), scene.light + offset),
								angle_rad, glm::dvec3(0.3, 1.0, 0.1)));
				scene.build();
				const Difference difference = compare_visibility(scene, 1.4);
				CHECK(difference.maximum < 0.01);
			}
		}
	}
}
