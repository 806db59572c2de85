#include "modules/core/error.h"
#include "modules/shadow_reference/disc_samples.h"
#include "modules/shadow_reference/tests/test_scenes.h"

#include "tests/analytic/closed_form.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <thread>

using namespace gnomon;
using namespace gnomon::test_scenes;

namespace {

const AreaLight LIGHT = { /*is_directional=*/false, { 0.3f, 1.2f, 6.0f }, {}, 0.4f };
constexpr glm::uvec2 SIZE_PX(40, 40);

/// A half-plane: x < 0.25 m at z = 2.5 m.
TriangleBuilder make_scene() {
	TriangleBuilder triangles;
	triangles.add_half_plane(0.25f, 2.5f);
	return triangles;
}

/// Root mean square error over the penumbra, compared with the closed form for make_scene.
double compute_rms_error(
		const VisibilityResult &p_result, const std::vector<ReceiverPoint> &p_points) {
	double square_sum = 0;
	unsigned count = 0;
	for (size_t i = 0; i < p_points.size(); ++i) {
		const double expected = closed_form::compute_edge_visibility(get_start(p_points[i]),
				LIGHT.position, LIGHT.disc_radius, { 0.25f, 0, 2.5f }, { 0, 1, 0 }, { 1, 0, 0 });
		if (expected > 0.002 && expected < 0.998) {
			square_sum += std::pow(expected - p_result.visibility[i], 2);
			++count;
		}
	}
	return std::sqrt(square_sum / count);
}

} // namespace

TEST_CASE("[DiscSamples] scrambled points cover the disc evenly for every count") {
	for (const uint32_t count : { 1u, 2u, 3u, 7u, 13u, 64u, 97u, 512u, 1000u, 4608u, 65536u }) {
		CAPTURE(count);
		const DiscSamples samples(count, 5);
		DiscSamples::Packet packet;
		glm::dvec2 sum(0.0);
		double largest_radius = 0;
		unsigned inner_count = 0; // points in the inner half of the disc's area
		uint32_t visited_count = 0;
		for (uint32_t i = 0; i < samples.get_packet_count(); ++i) {
			samples.compute_packet(i, 0x12345678u, 0x9abcdef0u, packet);
			for (uint32_t k = 0; k < DiscSamples::PACKET_SIZE && visited_count < count; ++k) {
				++visited_count;
				const glm::dvec2 point(packet.x[k], packet.y[k]);
				sum += point;
				largest_radius = std::max(largest_radius, glm::length(point));
				inner_count += glm::length(point) < std::sqrt(0.5) ? 1 : 0;
			}
		}
		CHECK(visited_count == count);
		CHECK(largest_radius <= 1.000001);
		// Limits are twice the values of a good sample set. At large counts, random points fail
		// both checks.
		const double scale = std::pow(count, -0.75);
		CHECK(glm::length(sum) / count < 1.2 * scale);
		CHECK(std::abs(static_cast<double>(inner_count) / count - 0.5) <= 1.2 * scale);
	}
}

TEST_CASE("[DiscSamples] 256 points put 64 in each quadrant of the disc") {
	// The map to the disc turns each quadrant of the square into the same quadrant of the disc. A
	// (0,2)-net has a quarter of its points in each.
	const DiscSamples samples(256, 1);
	DiscSamples::Packet packet;
	unsigned counts[4] = {};
	for (uint32_t i = 0; i < 32; ++i) {
		samples.compute_packet(i, 77, 88, packet);
		for (uint32_t k = 0; k < 8; ++k) {
			++counts[(packet.x[k] > 0 ? 1 : 0) + (packet.y[k] > 0 ? 2 : 0)];
		}
	}
	for (const unsigned count : counts) {
		CHECK(count == 64);
	}
}

TEST_CASE("[Reference] the result does not depend on threads; the seed alone decides it") {
	const CasterScene tracer = make_scene().build();
	const std::vector<ReceiverPoint> points = make_ground(40, 1.0f);
	VisibilityOptions options = make_options(100);
	options.thread_count = 1;
	const VisibilityResult one = tracer.compute(points, SIZE_PX, LIGHT, options);
	for (const uint32_t thread_count : { 2u, 5u, 100u, 0u }) {
		options.thread_count = thread_count;
		const VisibilityResult many = tracer.compute(points, SIZE_PX, LIGHT, options);
		CHECK(many.visibility == one.visibility);
		CHECK(many.standard_error == one.standard_error);
		CHECK(many.ray_count == 1600 * 100);
		CHECK(many.is_complete);
	}
	options.seed = 1;
	CHECK(tracer.compute(points, SIZE_PX, LIGHT, options).visibility != one.visibility);
}

TEST_CASE("[Reference] the error falls faster than that of random samples") {
	const CasterScene tracer = make_scene().build();
	const std::vector<ReceiverPoint> points = make_ground(40, 1.0f);
	double error_before = 0;
	for (const uint32_t sample_count : { 16u, 64u, 256u, 1024u, 4096u }) {
		CAPTURE(sample_count);
		const double error = compute_rms_error(
				tracer.compute(points, SIZE_PX, LIGHT, make_options(sample_count)), points);
		CHECK(error < 0.5 * std::pow(sample_count, -0.7)); // 0.5 n^-0.5 would be random
		if (error_before > 0) {
			CHECK(error < 0.45 * error_before); // about 4^-0.75 = 0.35; random: 4^-0.5 = 0.5
		}
		error_before = error;
	}
}

TEST_CASE("[Reference] from 16 samples on, the standard error is within 25 % of the real one") {
	const CasterScene tracer = make_scene().build();
	const std::vector<ReceiverPoint> points = make_ground(40, 1.0f);
	for (const uint32_t sample_count : { 2u, 3u, 17u, 64u, 1000u, 1024u, 9216u }) {
		CAPTURE(sample_count);
		const VisibilityResult result =
				tracer.compute(points, SIZE_PX, LIGHT, make_options(sample_count));
		const double error = compute_rms_error(result, points);
		CHECK(result.penumbra_pixel_count > 100);
		// Few samples: a pixel whose rays agree by chance looks lit and is not counted.
		const double tolerance = sample_count < 16 ? 2.0 : 1.25;
		CHECK(result.standard_error < tolerance * error);
		CHECK(result.standard_error > error / tolerance);
	}
	CHECK(tracer.compute(points, SIZE_PX, LIGHT, make_options(1)).standard_error == -1.0f);
}

TEST_CASE("[Reference] a scene scaled with every length has the same mask") {
	const std::vector<ReceiverPoint> points = make_ground(40, 1.0f);
	const VisibilityResult one =
			make_scene().build().compute(points, SIZE_PX, LIGHT, make_options(256));
	for (const float factor : { 1e-3f, 1e3f }) {
		TriangleBuilder triangles = make_scene();
		triangles.scale(factor);
		std::vector<ReceiverPoint> scaled_points = points;
		for (ReceiverPoint &point : scaled_points) {
			point.position *= factor;
			point.offset_m *= factor;
		}
		AreaLight light = LIGHT;
		light.position *= factor;
		light.disc_radius *= factor;
		const VisibilityResult scaled =
				triangles.build().compute(scaled_points, SIZE_PX, light, make_options(256));
		unsigned changed_count = 0;
		for (size_t i = 0; i < points.size(); ++i) {
			const float difference = std::abs(scaled.visibility[i] - one.visibility[i]);
			CHECK(difference <= 1.01f / 256); // a sample on the edge itself may round either way
			changed_count += difference != 0 ? 1 : 0;
		}
		CHECK(changed_count <= 5);
	}
}

TEST_CASE("[Reference] a radius of zero is a hard shadow: one ray, no error") {
	const std::vector<ReceiverPoint> points = make_ground(40, 1.0f);
	AreaLight light = LIGHT;
	light.disc_radius = 0;
	const VisibilityResult result =
			make_scene().build().compute(points, SIZE_PX, light, make_options(1024));
	CHECK(result.ray_count == 1600);
	CHECK(result.standard_error == 0.0f);
	for (const float visibility : result.visibility) {
		CHECK((visibility == 0.0f || visibility == 1.0f));
	}
}

TEST_CASE("[Reference] degenerate receivers have a defined value, never NaN") {
	const float nan = std::numeric_limits<float>::quiet_NaN();
	const float inf = std::numeric_limits<float>::infinity();
	const glm::vec3 up(0, 0, 1);
	const std::vector<ReceiverPoint> points = {
		{ { nan, 0, 0 }, up, true }, // 0: not finite
		{ { 0, inf, 0 }, up, true }, { { 0, 0, 0 }, { nan, 0, 0 }, true },
		{ { 0, 0, 0 }, up, true, 0.0f, nan }, { { 0, 0, 0 }, up, false }, // 0: no receiver
		{ LIGHT.position, { 0, 0, 0 }, true },							  // 1: on the light
		{ { 3, 0, 0 }, { 0, 0, 0 }, true },					   // no normal: rays start at it
		{ LIGHT.position + glm::vec3(0, 0, 1e-6f), up, true }, // closer than R
		{ { 3, 0, 1e6f }, up, true }, // far behind the light: the renderer would not query it
	};
	const std::vector<float> visibility =
			make_scene().build().compute(points, { 9, 1 }, LIGHT, make_options(64)).visibility;
	CHECK(visibility == std::vector<float>{ 0, 0, 0, 0, 0, 1, 1, 1, 1 });
}

TEST_CASE("[Reference] degenerate triangles and those that are not finite change nothing") {
	const float nan = std::numeric_limits<float>::quiet_NaN();
	TriangleBuilder triangles = make_scene();
	triangles.add_quad({ nan, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { INFINITY, 1, 1 });
	triangles.add_quad({ 3, 0, 1 }, { 3, 0, 1 }, { 3, 0, 1 }, { 3, 0, 1 });
	triangles.add_quad({ 0, 0, 1 }, { 1, 0, 1 }, { 2, 0, 1 }, { 3, 0, 1 });
	const std::vector<ReceiverPoint> points = make_ground(40, 1.0f);
	CHECK(triangles.build().compute(points, SIZE_PX, LIGHT, make_options(64)).visibility ==
			make_scene().build().compute(points, SIZE_PX, LIGHT, make_options(64)).visibility);
}

TEST_CASE("[Reference] a light or an option out of range is an error") {
	const CasterScene tracer = make_scene().build();
	const std::vector<ReceiverPoint> points = make_ground(1, 1.0f);
	const float nan = std::numeric_limits<float>::quiet_NaN();
	for (const float radius : { nan, -1.0f, INFINITY }) {
		AreaLight light = LIGHT;
		light.disc_radius = radius;
		CHECK_THROWS_AS(tracer.compute(points, { 1, 1 }, light, make_options(4)), Error);
	}
	AreaLight light = LIGHT;
	light.position.x = nan;
	CHECK_THROWS_AS(tracer.compute(points, { 1, 1 }, light, make_options(4)), Error);
	light = LIGHT;
	light.is_directional = true;
	light.direction = glm::vec3(0.0f);
	CHECK_THROWS_AS(tracer.compute(points, { 1, 1 }, light, make_options(4)), Error);
	light.direction = glm::vec3(0, 0, -1e-30f); // any length will do
	CHECK_NOTHROW(tracer.compute(points, { 1, 1 }, light, make_options(4)));
	for (const uint32_t sample_count : { 0u, 65537u }) {
		CHECK_THROWS_AS(tracer.compute(points, { 1, 1 }, LIGHT, make_options(sample_count)), Error);
	}
	CHECK(tracer.compute({}, { 0, 0 }, LIGHT, make_options(4)).is_complete); // no receivers
}

TEST_CASE("[Reference] progress rises to 1 on the calling thread, and may stop the work") {
	const CasterScene tracer = make_scene().build();
	const std::vector<ReceiverPoint> points = make_ground(40, 1.0f);
	VisibilityOptions options = make_options(16);
	float last = 0;
	bool is_rising = true;
	const std::thread::id caller = std::this_thread::get_id();
	options.progress = [&](float p_fraction) {
		is_rising = is_rising && p_fraction >= last && std::this_thread::get_id() == caller;
		last = p_fraction;
	};
	CHECK(tracer.compute(points, SIZE_PX, LIGHT, options).is_complete);
	CHECK(is_rising);
	CHECK(last == 1.0f);

	std::atomic<bool> is_cancelled = true;
	options.is_cancelled = &is_cancelled;
	CHECK_FALSE(tracer.compute(points, SIZE_PX, LIGHT, options).is_complete); // before it begins

	is_cancelled = false;
	options.thread_count = 1; // with more, others might trace all tiles before the first call
	options.progress = [&](float) { is_cancelled = true; };
	CHECK_FALSE(tracer.compute(points, SIZE_PX, LIGHT, options).is_complete);

	options.is_cancelled = nullptr;
	options.thread_count = 0;
	options.progress = [](float) { fail("stop"); };
	CHECK_THROWS_AS(tracer.compute(points, SIZE_PX, LIGHT, options), Error);
}
