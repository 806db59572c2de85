#include "modules/shadow_reference/tests/test_scenes.h"

#include "tests/analytic/closed_form.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace gnomon;
using namespace gnomon::test_scenes;

namespace {

constexpr uint32_t TABLE_SAMPLE_COUNT = 9216; // as for published tables
constexpr double TOLERANCE = 0.002;			  // of visibility, at every receiver

AreaLight make_directional(const glm::vec3 &p_direction, float p_tangent) {
	AreaLight light;
	light.is_directional = true;
	light.direction = p_direction;
	light.disc_radius = p_tangent;
	return light;
}

AreaLight make_spot(const glm::vec3 &p_position, float p_radius) {
	AreaLight light;
	light.position = p_position;
	light.disc_radius = p_radius;
	return light;
}

} // namespace

TEST_CASE("[ClosedForm] the formulas meet their limits and known values") {
	using namespace closed_form;
	CHECK(compute_half_plane_visibility(-2) == 0);
	CHECK(compute_half_plane_visibility(0) == doctest::Approx(0.5));
	CHECK(compute_half_plane_visibility(1) == 1);
	CHECK(compute_half_plane_visibility(0.5) ==
			doctest::Approx(0.8044989)); // 2/3 + sqrt(3) / (4 pi)
	CHECK(compute_disc_visibility(0.5, 0) == doctest::Approx(0.75));
	CHECK(compute_disc_visibility(2, 0.5) == 0);
	CHECK(compute_disc_visibility(0.5, 1.5) == 1);
	// The lens of two unit circles: 2/3 - sqrt(3) / (2 pi) of the disc.
	CHECK(compute_disc_visibility(1, 1) == doctest::Approx(1 - 0.3910022));
	CHECK(compute_disc_visibility(1e4, 1e4 + 0.5) ==
			doctest::Approx(compute_half_plane_visibility(0.5)).epsilon(1e-3));
}

TEST_CASE("[Reference] a half-plane before a spot light hides a circular segment of its disc") {
	TriangleBuilder triangles;
	triangles.add_half_plane(0.25f, 2.5f);
	const CasterScene tracer = triangles.build();
	const std::vector<ReceiverPoint> points = make_ground(24, 2.0f);
	for (const float radius : { 0.08f, 0.4f, 1.2f }) {
		CAPTURE(radius);
		const AreaLight light = make_spot({ 0.3f, 1.2f, 6.0f }, radius);
		const VisibilityResult result =
				tracer.compute(points, { 24, 24 }, light, make_options(TABLE_SAMPLE_COUNT));
		double largest_error = 0;
		unsigned penumbra_count = 0;
		for (size_t i = 0; i < points.size(); ++i) {
			// The edge is at x = 0.25 m, z = 2.5 m, along y; the side +x is open.
			const double expected = closed_form::compute_edge_visibility(get_start(points[i]),
					light.position, radius, { 0.25f, 0, 2.5f }, { 0, 1, 0 }, { 1, 0, 0 });
			largest_error = std::max(largest_error, std::abs(expected - result.visibility[i]));
			penumbra_count += expected > 0.002 && expected < 0.998 ? 1 : 0;
		}
		CHECK(largest_error < TOLERANCE);
		CHECK(penumbra_count > 10);
	}
}

TEST_CASE("[Reference] a half-plane before a directional light hides a segment of the same form") {
	TriangleBuilder triangles;
	triangles.add_half_plane(0.25f, 2.5f);
	const CasterScene tracer = triangles.build();
	const std::vector<ReceiverPoint> points = make_ground(24, 2.0f);
	const glm::vec3 direction(0.1f, -0.4f, -1.0f);
	for (const float tangent : { 0.00465f, 0.1f, 0.5f }) { // the first is the sun's
		CAPTURE(tangent);
		const VisibilityResult result = tracer.compute(points, { 24, 24 },
				make_directional(direction, tangent), make_options(TABLE_SAMPLE_COUNT));
		double largest_error = 0;
		for (size_t i = 0; i < points.size(); ++i) {
			const glm::dvec3 start = get_start(points[i]);
			const double expected = closed_form::compute_edge_visibility(start,
					start - glm::normalize(glm::dvec3(direction)), tangent, { 0.25f, 0, 2.5f },
					{ 0, 1, 0 }, { 1, 0, 0 });
			largest_error = std::max(largest_error, std::abs(expected - result.visibility[i]));
		}
		CHECK(largest_error < TOLERANCE);
	}
}

TEST_CASE("[Reference] a disc before a spot light hides the lens of two circles") {
	// All receivers on one ray from L, so that one occluder is parallel to the disc for each of
	// them.
	const glm::dvec3 light_position(1, 2, 6);
	const glm::dvec3 axis = glm::normalize(glm::dvec3(0.2, 0.3, 1)); // from the receivers to L
	const glm::dvec3 side = glm::normalize(glm::cross(axis, glm::dvec3(1, 0, 0)));
	const double radius = 0.5;
	for (const double occluder_radius : { 0.05, 0.2, 0.6 }) {
		for (const double offset : { 0.0, 0.1, 0.3, 0.7 }) {
			CAPTURE(occluder_radius);
			CAPTURE(offset);
			TriangleBuilder triangles;
			triangles.add_disc(light_position - 2.0 * axis + offset * side, side,
					glm::cross(axis, side), occluder_radius);
			std::vector<ReceiverPoint> points;
			for (int i = 0; i < 24; ++i) {
				points.push_back(
						{ glm::vec3(light_position - (2.2 + 0.2 * i) * axis), glm::vec3(axis),
								/*is_receiver=*/true, /*spread_radius_m=*/0.0f, OFFSET_M });
			}
			const VisibilityResult result = triangles.build().compute(points, { 24, 1 },
					make_spot(light_position, radius), make_options(TABLE_SAMPLE_COUNT));
			for (size_t i = 0; i < points.size(); ++i) {
				const double distance = glm::dot(light_position - get_start(points[i]), axis);
				const double magnification = distance / (distance - 2.0);
				const double expected = closed_form::compute_disc_visibility(
						occluder_radius * magnification / radius, offset * magnification / radius);
				CHECK(std::abs(expected - result.visibility[i]) < TOLERANCE);
			}
		}
	}
}

TEST_CASE(
		"[Reference] a disc before a directional light hides the lens, wherever the receiver is") {
	const glm::dvec3 axis = glm::normalize(glm::dvec3(0.2, 0.3, 1));
	const glm::dvec3 side = glm::normalize(glm::cross(axis, glm::dvec3(1, 0, 0)));
	const glm::dvec3 centre = 3.0 * axis;
	TriangleBuilder triangles;
	triangles.add_disc(centre, side, glm::cross(axis, side), 0.5);
	const CasterScene tracer = triangles.build();
	const std::vector<ReceiverPoint> points = make_ground(24, 2.0f);
	for (const float tangent : { 0.05f, 0.3f }) {
		const VisibilityResult result = tracer.compute(points, { 24, 24 },
				make_directional(glm::vec3(-axis), tangent), make_options(TABLE_SAMPLE_COUNT));
		double largest_error = 0;
		for (size_t i = 0; i < points.size(); ++i) {
			const glm::dvec3 to_centre = centre - get_start(points[i]);
			const double height = glm::dot(to_centre, axis);
			const double expected = closed_form::compute_disc_visibility(0.5 / height / tangent,
					glm::length(to_centre - height * axis) / height / tangent);
			largest_error = std::max(largest_error, std::abs(expected - result.visibility[i]));
		}
		CHECK(largest_error < TOLERANCE);
	}
}

TEST_CASE("[Reference] nothing in between is exactly 1, everything hidden exactly 0") {
	TriangleBuilder cover;
	cover.add_half_plane(250.0f, 2.5f);
	TriangleBuilder elsewhere; // behind the light, and below the ground
	elsewhere.add_half_plane(250.0f, 7.0f);
	elsewhere.add_half_plane(250.0f, -0.1f);
	const std::vector<ReceiverPoint> points = make_ground(8, 2.0f);
	for (const uint32_t sample_count : { 1u, 2u, 7u, 1000u, 1024u }) {
		for (const AreaLight &light :
				{ make_spot({ 0, 0, 6 }, 0.4f), make_spot({ 0, 0, 6 }, 0.0f) }) {
			for (const float visibility :
					TriangleBuilder()
							.build()
							.compute(points, { 8, 8 }, light, make_options(sample_count))
							.visibility) {
				CHECK(visibility == 1.0f);
			}
			for (const float visibility :
					elsewhere.build()
							.compute(points, { 8, 8 }, light, make_options(sample_count))
							.visibility) {
				CHECK(visibility == 1.0f);
			}
			for (const float visibility :
					cover.build()
							.compute(points, { 8, 8 }, light, make_options(sample_count))
							.visibility) {
				CHECK(visibility == 0.0f);
			}
		}
		for (const float visibility :
				cover.build()
						.compute(points, { 8, 8 }, make_directional({ 0, 0, -1 }, 0.1f),
								make_options(sample_count))
						.visibility) {
			CHECK(visibility == 0.0f);
		}
	}
}
