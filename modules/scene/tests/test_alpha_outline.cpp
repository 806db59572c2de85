// build: optimised
#include "modules/scene/alpha_outline.h"
#include "modules/scene/loop_simplification.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

using namespace gnomon;

namespace {

const uint32_t EDGE_BUDGET = 20000; // enough for an exact outline, unless a test passes another

std::shared_ptr<const Image> make_alpha_image(
		glm::uvec2 p_size_px, const std::function<double(glm::uvec2)> &p_alpha) {
	std::vector<uint8_t> texels;
	for (uint32_t y = 0; y < p_size_px.y; ++y) {
		for (uint32_t x = 0; x < p_size_px.x; ++x) {
			const double alpha = std::clamp(p_alpha({ x, y }), 0.0, 1.0);
			texels.insert(texels.end(), { 0, 0, 0, uint8_t(std::lround(alpha * 255)) });
		}
	}
	return make_image("mask", p_size_px, std::move(texels));
}

/// Returns the outline's fraction of the tile's area.
double compute_outline_area(const AlphaOutline &p_outline) {
	int64_t twice = 0;
	for (size_t i = 0; i < p_outline.triangles.size(); i += 3) {
		const int64_t signed_area =
				compute_twice_signed_area(p_outline.points[p_outline.triangles[i]],
						p_outline.points[p_outline.triangles[i + 1]],
						p_outline.points[p_outline.triangles[i + 2]]);
		CHECK(signed_area >= 0);
		twice += signed_area;
	}
	return double(twice) / 2 / p_outline.size.x / p_outline.size.y;
}

/// Whether a point, in texels, is in one of the triangles.
bool is_inside(const AlphaOutline &p_outline, const glm::dvec2 &p_point) {
	const glm::dvec2 point = p_point * double(AlphaOutline::UNITS_PER_TEXEL);
	const auto signed_area = [&](const glm::dvec2 &p_a, const glm::dvec2 &p_b) {
		return (p_b.x - p_a.x) * (point.y - p_a.y) - (p_b.y - p_a.y) * (point.x - p_a.x);
	};
	for (size_t i = 0; i < p_outline.triangles.size(); i += 3) {
		const glm::dvec2 a(p_outline.points[p_outline.triangles[i]]);
		const glm::dvec2 b(p_outline.points[p_outline.triangles[i + 1]]);
		const glm::dvec2 c(p_outline.points[p_outline.triangles[i + 2]]);
		if (signed_area(a, b) >= 0 && signed_area(b, c) >= 0 && signed_area(c, a) >= 0) {
			return true;
		}
	}
	return false;
}

/// Checks random points: the outline must contain those where the test passes, and no others,
/// except within about p_tolerance_px texels of the contour.
void check_points(const AlphaTest &p_test, const AlphaOutline &p_outline, double p_tolerance_px) {
	std::minstd_rand random(5);
	std::uniform_real_distribution<double> uniform(0, 1);
	const glm::dvec2 size(p_test.image->size_px);
	for (int i = 0; i < 4000; ++i) {
		const glm::dvec2 point = glm::dvec2(uniform(random), uniform(random)) * size;
		// A point is near the contour if the test differs at a point around it.
		const bool expected = sample_alpha(p_test, point / size) >= p_test.cutoff;
		bool is_near = false;
		for (int k = 0; k < 16; ++k) {
			const glm::dvec2 moved = point +
					p_tolerance_px * glm::dvec2(std::cos(k * 0.4), std::sin(k * 0.4)) *
							(k % 2 ? 1.0 : 0.5);
			const bool is_out = glm::any(glm::lessThan(moved, glm::dvec2(0))) ||
					glm::any(glm::greaterThan(moved, size));
			is_near = is_near || is_out ||
					(sample_alpha(p_test, moved / size) >= p_test.cutoff) != expected;
		}
		if (!is_near) {
			CAPTURE(point.x);
			CAPTURE(point.y);
			CHECK(is_inside(p_outline, point) == expected);
		}
	}
}

} // namespace

TEST_CASE("[AlphaOutline] triangulation adds no points and refuses invalid polygons") {
	const PolygonLoop square = { { 0, 0 }, { 100, 0 }, { 100, 100 }, { 0, 100 } };
	const PolygonLoop hole = { { 20, 20 }, { 20, 40 }, { 40, 40 }, { 40, 20 } };
	const PolygonLoop other_hole = { { 60, 20 }, { 50, 80 }, { 80, 70 }, { 70, 60 } };
	// A polygon of n points with h holes has n + 2 h - 2 triangles.
	CHECK(triangulate(std::vector<PolygonLoop>{ square }).size() == 3 * 2);
	CHECK(triangulate(std::vector<PolygonLoop>{ square, hole }).size() == 3 * 8);
	CHECK(triangulate(std::vector<PolygonLoop>{ square, hole, other_hole }).size() == 3 * 14);
	// Clockwise, crossing itself, and with two points only.
	CHECK(triangulate(
			std::vector<PolygonLoop>{ PolygonLoop{ { 0, 0 }, { 0, 9 }, { 9, 9 }, { 9, 0 } } })
					.empty());
	CHECK(triangulate(
			std::vector<PolygonLoop>{ PolygonLoop{ { 0, 0 }, { 9, 9 }, { 0, 9 }, { 9, 0 } } })
					.empty());
	CHECK(triangulate(std::vector<PolygonLoop>{ PolygonLoop{ { 0, 0 }, { 9, 0 } } }).empty());
	CHECK(triangulate({}).empty());
}

TEST_CASE("[AlphaOutline] the outline of smooth masks is within half a texel") {
	for (const int seed : { 1, 2, 3, 4, 5, 6, 7, 8 }) {
		CAPTURE(seed);
		std::minstd_rand random(static_cast<uint32_t>(seed));
		std::uniform_real_distribution<double> uniform(0, 1);
		double phases[6];
		for (double &phase : phases) {
			phase = 6.3 * uniform(random); // 0..2 pi
		}
		const auto image = make_alpha_image({ 40u + 3 * seed, 48 }, [&](const glm::uvec2 &p_texel) {
			const glm::dvec2 at = glm::dvec2(p_texel) * (seed % 2 ? 0.3 : 0.9);
			return 0.5 +
					0.3 *
					(std::sin(at.x + phases[0]) + std::sin(at.y * 0.7 + phases[1]) +
							std::sin((at.x + at.y) * 0.6 + phases[2]));
		});
		for (const TextureWrap wrap :
				{ TextureWrap::CLAMP, TextureWrap::REPEAT, TextureWrap::MIRROR }) {
			AlphaTest test;
			test.image = image.get();
			test.cutoff = 0.2f + 0.07f * seed; // 0.27..0.76
			test.wrap_u = test.wrap_v = wrap;
			const AlphaOutline outline = make_alpha_outline(test, EDGE_BUDGET);
			REQUIRE(!outline.is_empty());
			CHECK(outline.block_size_px == 0);
			check_points(test, outline, 0.5);
		}
	}
}

TEST_CASE("[AlphaOutline] the outline of a disc has the disc's area and few edges") {
	const double radius_px = 20;
	const auto image = make_alpha_image(glm::uvec2(64), [&](const glm::uvec2 &p_texel) {
		return 0.5 + (radius_px - glm::distance(glm::dvec2(p_texel) + 0.5, glm::dvec2(32))) * 0.5;
	});
	AlphaTest test;
	test.image = image.get();
	const AlphaOutline outline = make_alpha_outline(test, EDGE_BUDGET);
	const double expected = 3.14159265 * radius_px * radius_px / (64 * 64);
	CHECK(std::abs(compute_outline_area(outline) / expected - 1) < 0.01);
	// 29 chords are within the default tolerance, 1/8 texel, of the circle.
	CHECK(outline.edge_count >= 12);
	CHECK(outline.edge_count <= 40);
	test.cutoff = 0;
	CHECK(make_alpha_outline(test, EDGE_BUDGET).covers_tile);
	CHECK(make_alpha_outline(test, EDGE_BUDGET).edge_count == 4);
	test.cutoff = 1.5f; // above every alpha
	CHECK(make_alpha_outline(test, EDGE_BUDGET).is_empty());
}

TEST_CASE("[AlphaOutline] noise is outlined with any wrap mode, and as squares if nearest") {
	for (const uint32_t seed : { 1u, 2u, 3u }) {
		std::minstd_rand random(seed);
		const auto image = make_alpha_image(
				{ 33, 29 }, [&](const glm::uvec2 &) { return double(random() % 256) / 255; });
		AlphaTest test;
		test.image = image.get();
		for (const TextureWrap wrap :
				{ TextureWrap::CLAMP, TextureWrap::REPEAT, TextureWrap::MIRROR }) {
			test.wrap_u = test.wrap_v = wrap;
			const AlphaOutline outline = make_alpha_outline(test, EDGE_BUDGET);
			CHECK(outline.block_size_px == 0);
			check_points(test, outline, 0.4);
		}
		test.is_nearest = true;
		const AlphaOutline squares = make_alpha_outline(test, EDGE_BUDGET);
		CHECK(squares.block_size_px == 0);
		check_points(test, squares, 0.05);
		// More edges than the budget: a half-tone of the same area.
		const AlphaOutline half_tone = make_alpha_outline(test, 200);
		CHECK(half_tone.block_size_px > 1);
		CHECK(half_tone.edge_count <= 200);
		CHECK(std::abs(compute_outline_area(half_tone) - compute_outline_area(squares)) < 0.01);
	}
}

TEST_CASE("[AlphaOutline] a half-tone has few triangles where blocks are fully covered") {
	std::minstd_rand random(7);
	for (const uint32_t budget : { 4u, 8u, 256u, 1000u }) {
		CAPTURE(budget);
		const auto image = make_alpha_image({ 321, 203 }, [&](const glm::uvec2 &p_texel) {
			const bool is_noise = p_texel.x < 100 && p_texel.y < 100;
			return is_noise ? double(random() % 2) : p_texel.x < 300 ? 1.0 : 0.0;
		});
		AlphaTest test;
		test.image = image.get();
		test.is_nearest = true;
		const AlphaOutline half_tone = make_alpha_outline(test, budget);
		CHECK(half_tone.block_size_px > 1);
		const uint32_t max_edges = std::max(budget, 8u); // a tile of one block with a hole has 8
		CHECK(half_tone.edge_count <= max_edges);
		CHECK(half_tone.triangles.size() / 3 <= 2 * max_edges);
		const AlphaOutline exact = make_alpha_outline(test, /*p_edge_budget=*/100000);
		CHECK(exact.block_size_px == 0);
		CHECK(std::abs(compute_outline_area(half_tone) - compute_outline_area(exact)) < 0.01);
	}
}

TEST_CASE("[AlphaOutline] each straight border of a large image becomes one edge") {
	const auto image = make_alpha_image(
			{ 8192, 64 }, [](const glm::uvec2 &p_texel) { return p_texel.y / 8 % 2 ? 0.9 : 0.1; });
	AlphaTest test;
	test.image = image.get();
	test.wrap_u = test.wrap_v = TextureWrap::CLAMP;
	const AlphaOutline outline = make_alpha_outline(test, EDGE_BUDGET);
	CHECK(outline.block_size_px == 0);
	CHECK(outline.edge_count == 16); // 4 stripes
	CHECK(compute_outline_area(outline) == doctest::Approx(0.5).epsilon(0.01));
}

TEST_CASE("[AlphaOutline] outlines of tiles that repeat match at the tile borders") {
	const auto image = make_alpha_image({ 16, 12 }, [&](const glm::uvec2 &p_texel) {
		return 0.5 + 0.5 * std::sin(p_texel.x * 0.9) * std::cos(p_texel.y * 0.8 + 1);
	});
	AlphaTest test;
	test.image = image.get();
	const AlphaOutline outline = make_alpha_outline(test, EDGE_BUDGET);
	std::map<int, std::set<int>> on_x, on_y;
	for (const glm::ivec2 &point : outline.points) {
		if (point.y != 0 && point.y != outline.size.y) {
			on_x[point.x].insert(point.y);
		}
		if (point.x != 0 && point.x != outline.size.x) {
			on_y[point.y].insert(point.x);
		}
	}
	CHECK(!on_x[0].empty());
	CHECK(on_x[0] == on_x[outline.size.x]);
	CHECK(on_y[0] == on_y[outline.size.y]);
}

TEST_CASE("[AlphaOutline] texels that touch at corners are outlined with the area of their alpha") {
	const uint32_t SIZE = 12;
	const uint32_t SAMPLES = 32; // per texel and axis
	for (const uint32_t seed : { 1u, 2u, 3u, 4u }) {
		CAPTURE(seed);
		std::minstd_rand random(seed);
		std::vector<uint8_t> texels;
		for (uint32_t texel = 0; texel < SIZE * SIZE; ++texel) { // four in nine are opaque
			texels.insert(texels.end(), { 0, 0, 0, uint8_t(random() % 9 < 4 ? 255 : 0) });
		}
		const auto image = make_image("corners", glm::uvec2(SIZE), std::move(texels));
		AlphaTest test;
		test.image = image.get();
		const AlphaOutline outline = make_alpha_outline(test, 4096, 1.0 / 32);
		REQUIRE(outline.block_size_px == 0);
		int64_t twice_area = 0;
		for (size_t i = 0; i < outline.triangles.size(); i += 3) {
			twice_area += compute_twice_signed_area(outline.points[outline.triangles[i]],
					outline.points[outline.triangles[i + 1]],
					outline.points[outline.triangles[i + 2]]);
		}
		uint32_t passed = 0;
		for (uint32_t y = 0; y < SIZE * SAMPLES; ++y) {
			for (uint32_t x = 0; x < SIZE * SAMPLES; ++x) {
				const glm::dvec2 uv = (glm::dvec2(x, y) + 0.5) / double(SIZE * SAMPLES);
				passed += sample_alpha(test, uv) >= test.cutoff ? 1 : 0;
			}
		}
		const double units = double(AlphaOutline::UNITS_PER_TEXEL);
		CHECK(double(twice_area) / 2 / (units * units) ==
				doctest::Approx(double(passed) / (SAMPLES * SAMPLES)).epsilon(0.02));
	}
}
