#include "modules/shadow_reference/caster_scene.h"
#include "modules/shadow_reference/spread_visibility.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace gnomon;

namespace {

/// Light enters evenly over a disc.
class EvenSpread : public SurfaceSpread {
public:
	float compute_radius_m(const SurfaceMaterial &, float) const override { return 1.0f; }
	float compute_distance(float p_share) const override { return std::sqrt(p_share); }
};

const EvenSpread EVEN;
const float OFFSET_M = 1e-4f;

/// Level, facing up.
void add_square(Triangles &r_triangles, const glm::vec3 &p_centre, float p_half) {
	const uint32_t first = static_cast<uint32_t>(r_triangles.positions.size());
	for (const glm::vec2 &corner :
			{ glm::vec2(-1, -1), glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1) }) {
		r_triangles.positions.push_back(p_centre + p_half * glm::vec3(corner.x, 0.0f, corner.y));
	}
	for (const uint32_t index : { 0, 1, 2, 0, 2, 3 }) {
		r_triangles.indices.push_back(first + index);
	}
}

AreaLight make_sun() {
	AreaLight light;
	light.is_directional = true;
	light.direction = glm::vec3(0, -1, 0);
	return light;
}

SpreadMean trace(const Triangles &p_body, const Triangles &p_casters, const glm::vec3 &p_position,
		float p_radius_m, const AreaLight &p_light = make_sun()) {
	const CasterScene casters(p_casters.positions, p_casters.indices, {});
	const Triangles bodies[] = { p_body };
	return SpreadVisibility(bodies, EVEN)
			.compute(casters, p_light, { p_position, glm::vec3(0, 1, 0), true, p_radius_m },
					OFFSET_M, 16384, 7);
}

double count_rays(const SpreadMean &p_mean) {
	return p_mean.counts[0] + p_mean.counts[1];
}

/// Of a disc of radius 1, the share beyond a line at a distance.
double compute_cap_share(double p_distance) {
	return (std::acos(p_distance) - p_distance * std::sqrt(1 - p_distance * p_distance)) /
			3.14159265358979;
}

} // namespace

TEST_CASE(
		"[SpreadVisibility] on a flat body the mean is the share of the disc that sees the light") {
	Triangles ground;
	add_square(ground, glm::vec3(0), 10);
	Triangles roof; // over x < 0
	add_square(roof, glm::vec3(-20, 1, 0), 20);
	for (const float x : { -0.9f, -0.5f, 0.0f, 0.3f, 0.8f }) {
		CAPTURE(x);
		const SpreadMean mean = trace(ground, roof, glm::vec3(2 * x, 0, 0), 2.0f);
		CHECK(count_rays(mean) == 16384);
		CHECK(mean.compute_mean().x == doctest::Approx(compute_cap_share(-x)).epsilon(0.003));
		CHECK(mean.compute_mean().x == mean.compute_mean().z);
	}
	CHECK(trace(ground, roof, glm::vec3(3, 0, 0), 2.0f).compute_mean().x == 1);
	CHECK(trace(ground, roof, glm::vec3(-3, 0, 0), 2.0f).compute_mean().x == 0);
}

TEST_CASE("[SpreadVisibility] points that the body lacks, or that the light cannot reach, do not "
		  "count") {
	Triangles half; // for x < 0 alone
	add_square(half, glm::vec3(-10, 0, 0), 10);
	const Triangles nothing;
	CHECK(count_rays(trace(half, nothing, glm::vec3(-1e-3f, 0, 0), 1.0f)) ==
			doctest::Approx(16384 / 2).epsilon(0.01));
	AreaLight spot;
	spot.position = glm::vec3(-1, 1, 0);
	spot.cos_outer = std::cos(0.7853982f); // a metre wide below
	CHECK(count_rays(trace(half, nothing, glm::vec3(-1e-3f, 0, 0), 2.0f, spot)) < 16384 * 0.26);
	spot.cos_outer = -1;
	spot.range_m = 1.2f;
	CHECK(count_rays(trace(half, nothing, glm::vec3(-1e-3f, 0, 0), 2.0f, spot)) < 16384 * 0.15);
}

TEST_CASE("[SpreadVisibility] a step counts as far as the radius, up and down, and the nearer "
		  "level first") {
	for (const float height : { 0.5f, -0.5f }) {
		CAPTURE(height);
		Triangles step;
		add_square(step, glm::vec3(-10, 0, 0), 10);
		add_square(step, glm::vec3(10, height, 0), 10);
		const Triangles nothing;
		CHECK(count_rays(trace(step, nothing, glm::vec3(-0.1f, 0, 0), 1.0f)) == 16384);
		CHECK(count_rays(trace(step, nothing, glm::vec3(-0.1f, 0, 0), 0.4f)) < 0.7 * 16384);
		// A second level farther off hides nothing.
		add_square(step, glm::vec3(-10, -0.9f, 0), 10);
		Triangles roof; // between the two
		add_square(roof, glm::vec3(-10, -0.4f, 0), 10);
		CHECK(trace(step, roof, glm::vec3(-3, 0, 0), 1.0f).compute_mean().x == 1);
	}
}

TEST_CASE("[SpreadVisibility] of several bodies the one counts on which the receiver is") {
	Triangles near_body;
	add_square(near_body, glm::vec3(0), 10);
	Triangles far_body;
	add_square(far_body, glm::vec3(0, -0.2f, 0), 10);
	Triangles roof; // over the far one alone
	add_square(roof, glm::vec3(0, -0.1f, 0), 10);
	const CasterScene casters(roof.positions, roof.indices, {});
	const Triangles bodies[] = { far_body, near_body };
	const SpreadMean mean =
			SpreadVisibility(bodies, EVEN)
					.compute(casters, make_sun(), { glm::vec3(0), glm::vec3(0, 1, 0), true, 1.0f },
							OFFSET_M, 1024, 7);
	CHECK(mean.compute_mean().x == 1);
}

TEST_CASE("[SpreadVisibility] a spread far wider than its body leaves the receiver what it sees "
		  "itself") {
	Triangles crumb;
	add_square(crumb, glm::vec3(0), 1e-5f);
	const Triangles bodies[] = { crumb };
	const SpreadVisibility spread(bodies, EVEN);
	VisibilityOptions options;
	options.sample_count = 256;
	options.spread = &spread;
	const ReceiverPoint point = { glm::vec3(0), glm::vec3(0, 1, 0), true, 1e4f };
	Triangles roof;
	add_square(roof, glm::vec3(0, 1, 0), 1);
	const Triangles nothing;
	for (const bool is_hidden : { false, true }) {
		const Triangles &casters = is_hidden ? roof : nothing;
		const CasterScene tracer(casters.positions, casters.indices);
		const VisibilityResult result =
				tracer.compute(std::span(&point, 1), glm::uvec2(1), make_sun(), options);
		CHECK(result.visibility[0] == (is_hidden ? 0.0f : 1.0f));
	}
}

TEST_CASE("[CasterScene] each translucent body leaves its part once, however often it is met") {
	const glm::vec3 red(0.9f, 0.25f, 0.125f);
	const glm::vec3 blue(0.125f, 0.5f, 0.75f);
	std::vector<TranslucentTriangles> bodies(2);
	bodies[0].transmittance = red;
	for (const float y : { 1.0f, 1.2f, 1.4f }) { // three squares of one body
		add_square(bodies[0].triangles, glm::vec3(0, y, 0), 1);
	}
	bodies[1].transmittance = blue;
	add_square(bodies[1].triangles, glm::vec3(1, 2, 0), 1);
	Triangles wall;
	add_square(wall, glm::vec3(5, 1, 0), 1);
	const CasterScene scene(wall.positions, wall.indices, bodies);
	const auto look_up = [&](float p_x) {
		return scene.trace(glm::vec3(p_x, 0, 0), glm::vec3(0, 3, 0), 1.0f);
	};
	CHECK(look_up(-0.5f) == red);
	CHECK(look_up(0.5f) == red * blue);
	CHECK(look_up(1.5f) == blue);
	CHECK(look_up(3.0f) == glm::vec3(1.0f));
	CHECK(look_up(5.0f) == glm::vec3(0.0f));
	CHECK(scene.trace(glm::vec3(0.5f, 0, 0), glm::vec3(0, 3, 0), 0.5f) == red); // ends before blue

	// As a packet, and as the mask of a light with a size.
	const CasterScene tracer(wall.positions, wall.indices, bodies);
	const ReceiverPoint points[] = { { glm::vec3(0.5f, 0, 0), glm::vec3(0, 1, 0), true },
		{ glm::vec3(3, 0, 0), glm::vec3(0, 1, 0), true },
		{ glm::vec3(0, 0, 0), glm::vec3(0, 1, 0), true } };
	AreaLight sun = make_sun();
	sun.disc_radius = 0.05f;
	VisibilityOptions options;
	options.sample_count = 1024;
	const VisibilityResult result = tracer.compute(points, glm::uvec2(3, 1), sun, options);
	REQUIRE(result.colors.size() == 3);
	CHECK(glm::distance(result.colors[0], red * blue) < 1e-6f);
	CHECK(result.colors[1] == glm::vec3(1.0f));
	CHECK(result.visibility[1] == 1.0f);
	// Half of the disc is seen next to the blue body, as its edge is straight above.
	CHECK(glm::distance(result.colors[2], red * (0.5f + 0.5f * blue)) < 0.01f);
}
