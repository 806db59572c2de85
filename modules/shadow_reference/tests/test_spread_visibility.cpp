#include "modules/shadow_reference/caster_scene.h"
#include "modules/shadow_reference/spread_visibility.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace gnomon;

namespace {

/// Light enters evenly over a disc with the spread radius.
class EvenSpread : public SurfaceSpread {
public:
	float compute_radius_m(const SurfaceMaterial &, float) const override { return 1.0f; }
	float compute_distance(float p_fraction) const override { return std::sqrt(p_fraction); }
};

const EvenSpread EVEN;
const float SPREAD_OFFSET_M = 1e-4f; // of the rays' start from the surface
const uint32_t SAMPLE_COUNT = 16384;
const uint64_t HASH = 7; // any

/// Adds a horizontal square that faces up. p_half: half the length of its sides in metres.
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
			.compute(casters, p_light,
					{ p_position, glm::vec3(0, 1, 0), true, p_radius_m, SPREAD_OFFSET_M },
					SAMPLE_COUNT, HASH);
}

double count_rays(const SpreadMean &p_mean) {
	return p_mean.counts[0] + p_mean.counts[1];
}

/// Returns the fraction of a unit disc's area beyond a line at p_distance from its centre.
double compute_cap_fraction(double p_distance) {
	return (std::acos(p_distance) - p_distance * std::sqrt(1 - p_distance * p_distance)) /
			3.14159265358979;
}

} // namespace

TEST_CASE("[SpreadVisibility] on a flat body the mean is the fraction of the disc that is lit") {
	Triangles ground;
	add_square(ground, glm::vec3(0), 10);
	Triangles roof; // over x < 0
	add_square(roof, glm::vec3(-20, 1, 0), 20);
	for (const float x : { -0.9f, -0.5f, 0.0f, 0.3f, 0.8f }) {
		CAPTURE(x);
		const SpreadMean mean = trace(ground, roof, glm::vec3(2 * x, 0, 0), 2.0f);
		CHECK(count_rays(mean) == SAMPLE_COUNT);
		CHECK(mean.compute_mean().x == doctest::Approx(compute_cap_fraction(-x)).epsilon(0.003));
		CHECK(mean.compute_mean().x == mean.compute_mean().z);
	}
	CHECK(trace(ground, roof, glm::vec3(3, 0, 0), 2.0f).compute_mean().x == 1);
	CHECK(trace(ground, roof, glm::vec3(-3, 0, 0), 2.0f).compute_mean().x == 0);
}

TEST_CASE("[SpreadVisibility] points beyond the body's edge, or that the light cannot reach, do "
		  "not count") {
	Triangles half; // covers x < 0 only
	add_square(half, glm::vec3(-10, 0, 0), 10);
	const Triangles nothing;
	CHECK(count_rays(trace(half, nothing, glm::vec3(-1e-3f, 0, 0), 1.0f)) ==
			doctest::Approx(SAMPLE_COUNT / 2).epsilon(0.01));
	AreaLight spot;
	spot.position = glm::vec3(-1, 1, 0);
	spot.cos_outer = std::cos(0.7853982f); // the cone covers a radius of 1 m on the ground
	CHECK(count_rays(trace(half, nothing, glm::vec3(-1e-3f, 0, 0), 2.0f, spot)) <
			SAMPLE_COUNT * 0.26); // (1 m / 2 m)^2 = 0.25
	spot.cos_outer = -1;
	spot.range_m = 1.2f;
	CHECK(count_rays(trace(half, nothing, glm::vec3(-1e-3f, 0, 0), 2.0f, spot)) <
			SAMPLE_COUNT * 0.15); // (1.2^2 - 1^2) / 2^2 = 0.11
}

TEST_CASE("[SpreadVisibility] surfaces up to the radius above or below the receiver "
		  "count, and of two surfaces the nearer one") {
	for (const float height : { 0.5f, -0.5f }) {
		CAPTURE(height);
		Triangles step;
		add_square(step, glm::vec3(-10, 0, 0), 10);
		add_square(step, glm::vec3(10, height, 0), 10);
		const Triangles nothing;
		CHECK(count_rays(trace(step, nothing, glm::vec3(-0.1f, 0, 0), 1.0f)) == SAMPLE_COUNT);
		CHECK(count_rays(trace(step, nothing, glm::vec3(-0.1f, 0, 0), 0.4f)) <
				0.7 * SAMPLE_COUNT); // 0.66 of the disc is over x < 0
		// A second level, farther from the plane, is not sampled: a roof over it has no effect.
		add_square(step, glm::vec3(-10, -0.9f, 0), 10);
		Triangles roof; // between the two levels
		add_square(roof, glm::vec3(-10, -0.4f, 0), 10);
		CHECK(trace(step, roof, glm::vec3(-3, 0, 0), 1.0f).compute_mean().x == 1);
	}
}

TEST_CASE("[SpreadVisibility] of several bodies only the receiver's own counts") {
	Triangles near_body;
	add_square(near_body, glm::vec3(0), 10);
	Triangles far_body;
	add_square(far_body, glm::vec3(0, -0.2f, 0), 10);
	Triangles roof; // between the two, hides only the far one
	add_square(roof, glm::vec3(0, -0.1f, 0), 10);
	const CasterScene casters(roof.positions, roof.indices, {});
	const Triangles bodies[] = { far_body, near_body };
	const SpreadMean mean =
			SpreadVisibility(bodies, EVEN)
					.compute(casters, make_sun(),
							{ glm::vec3(0), glm::vec3(0, 1, 0), true, 1.0f, SPREAD_OFFSET_M },
							/*p_sample_count=*/1024, HASH);
	CHECK(mean.compute_mean().x == 1);
}

TEST_CASE("[SpreadVisibility] with a spread far wider than its body, a receiver has its own "
		  "visibility") {
	Triangles small_body;
	add_square(small_body, glm::vec3(0), 1e-5f);
	const Triangles bodies[] = { small_body };
	const SpreadVisibility spread(bodies, EVEN);
	VisibilityOptions options;
	options.sample_count = 256;
	options.spread = &spread;
	const ReceiverPoint point = { glm::vec3(0), glm::vec3(0, 1, 0), true, 1e4f, SPREAD_OFFSET_M };
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

TEST_CASE("[CasterScene] each translucent body attenuates a ray once, however often it is met") {
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
	const auto trace_up = [&](float p_x) {
		return scene.trace(glm::vec3(p_x, 0, 0), glm::vec3(0, 3, 0), 1.0f);
	};
	CHECK(trace_up(-0.5f) == red);
	CHECK(trace_up(0.5f) == red * blue);
	CHECK(trace_up(1.5f) == blue);
	CHECK(trace_up(3.0f) == glm::vec3(1.0f));
	CHECK(trace_up(5.0f) == glm::vec3(0.0f));
	CHECK(scene.trace(glm::vec3(0.5f, 0, 0), glm::vec3(0, 3, 0), 0.5f) == red); // ends before blue

	// As a packet of eight rays, and as the mask of a light with a size.
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
