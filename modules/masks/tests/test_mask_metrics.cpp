#include "modules/core/error.h"
#include "modules/masks/mask_metrics.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

using namespace gnomon;

namespace {

/// Makes a mask of one row; a negative value marks a pixel without receiver.
MaskImage make_row(const std::vector<float> &p_values) {
	MaskImage image;
	image.size_px = glm::uvec2(p_values.size(), 1);
	for (const float value : p_values) {
		image.visibility.push_back(std::max(value, 0.0f));
		image.receiver.push_back(value < 0 ? 0.0f : 1.0f);
	}
	return image;
}

} // namespace

TEST_CASE("[MaskMetrics] equal masks have no error") {
	const MaskImage image = make_row({ 0, 0.25f, 0.5f, 1, -1 });
	const MaskMetrics metrics = compute_mask_metrics(image, image);
	CHECK(metrics.receiver.pixel_count == 4);
	CHECK(metrics.penumbra.pixel_count == 2);
	CHECK(metrics.receiver.mae == 0);
	CHECK(metrics.receiver.p99 == 0);
	CHECK(metrics.penumbra.rmse == 0);
	CHECK(metrics.receiver.wrong == 0);
	CHECK(metrics.umbra_over == 0);
}

TEST_CASE("[MaskMetrics] metrics of five pixels match values computed by hand") {
	// Receivers: errors +0.5, -0.5, -0.25, 0; penumbra: -0.5, -0.25 (reference 0.5 and 0.25).
	const MaskImage reference = make_row({ 0, 0.5f, 0.25f, 1, -1 });
	const MaskImage result = make_row({ 0.5f, 0, 0, 1, -1 });
	const MaskMetrics metrics = compute_mask_metrics(reference, result);
	CHECK(metrics.receiver.mae == doctest::Approx(1.25 / 4));
	CHECK(metrics.receiver.rmse == doctest::Approx(std::sqrt(0.5625 / 4)));
	CHECK(metrics.receiver.bias == doctest::Approx(-0.25 / 4));
	CHECK(metrics.receiver.p99 == 0.5);
	CHECK(metrics.penumbra.mae == 0.375);
	CHECK(metrics.penumbra.rmse == doctest::Approx(std::sqrt(0.3125 / 2)));
	CHECK(metrics.penumbra.bias == -0.375);
	CHECK(metrics.penumbra.p99 == 0.5);
	CHECK(metrics.umbra_over == 1); // both are black where the reference is not
}

TEST_CASE("[MaskMetrics] penumbra and umbra_over exclude values equal to their limits") {
	// Penumbra: 0.002 < reference < 0.998. umbra_over: reference > 0.05 and result < 0.01.
	const MaskImage reference =
			make_row({ 0.002f, 0.0021f, 0.998f, 0.9979f, 0.05f, 0.051f, 0.5f, 0.6f });
	const MaskImage result = make_row({ 0, 0, 0.998f, 0.5f, 0, 0.0099f, 0.01f, 0.6f });
	const MaskMetrics metrics = compute_mask_metrics(reference, result);
	CHECK(metrics.receiver.pixel_count == 8);
	CHECK(metrics.penumbra.pixel_count == 6); // not 0.002 and 0.998 themselves
	// Reference above 0.05: 0.9979, 0.051, 0.5, 0.6; of these, only the second is below 0.01.
	CHECK(metrics.umbra_over == 0.25);
}

TEST_CASE("[MaskMetrics] 99 of 100 pixels do not exceed p99") {
	std::vector<float> values(100, 0.0f);
	const MaskImage reference = make_row(values);
	values[17] = 1.0f;
	CHECK(compute_mask_metrics(reference, make_row(values)).receiver.p99 == 0);
	values[3] = 0.5f;
	CHECK(compute_mask_metrics(reference, make_row(values)).receiver.p99 == 0.5);
}

TEST_CASE("[MaskMetrics] wrong is the fraction of pixels with an error above 0.2 of either sign") {
	// Errors outside of the penumbra: 0.2, 0.201, -1, 0; in it: -0.3, -0.2. Receivers are all six.
	const MaskImage reference = make_row({ 0, 0, 1, 1, 0.5f, 0.2f, -1 });
	const MaskImage result = make_row({ 0.2f, 0.201f, 0, 1, 0.2f, 0, -1 });
	const MaskMetrics metrics = compute_mask_metrics(reference, result);
	CHECK(metrics.receiver.pixel_count == 6);
	CHECK(metrics.receiver.wrong == 0.5);
	CHECK(metrics.penumbra.wrong == 0.5);
}

TEST_CASE("[MaskMetrics] without receivers or penumbra all is 0, never NaN") {
	const MaskImage none = make_row({ -1, -1 });
	CHECK(compute_mask_metrics(none, none).receiver.rmse == 0);
	CHECK(compute_mask_metrics(MaskImage(), MaskImage()).receiver.pixel_count == 0);
	const MaskMetrics metrics = compute_mask_metrics(make_row({ 0, 1 }), make_row({ 1, 1 }));
	CHECK(metrics.penumbra.pixel_count == 0);
	CHECK(metrics.penumbra.p99 == 0);
	CHECK(metrics.penumbra.wrong == 0);
	CHECK(metrics.receiver.wrong == 0.5);
	CHECK(metrics.umbra_over == 0);
}

TEST_CASE("[MaskMetrics] other sizes, other receivers and values that are not finite are errors") {
	const MaskImage reference = make_row({ 0, 0.5f, 1 });
	CHECK_THROWS_AS(compute_mask_metrics(reference, make_row({ 0, 1 })), Error);
	CHECK_THROWS_WITH_AS(
			compute_mask_metrics(reference, make_row({ 0, 0.5f, -1 }), "a.exr", "b.exr"),
			"Masks differ in their receivers: 1 pixels, the first at (2, 0), of a.exr and b.exr. "
			"Render both with the same scene, light and camera.",
			Error);
	for (const float bad :
			{ std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity() }) {
		MaskImage result = reference;
		result.visibility[1] = bad;
		CHECK_THROWS_AS(compute_mask_metrics(reference, result), Error);
		CHECK_THROWS_AS(compute_mask_metrics(result, reference), Error);
		result = reference;
		result.receiver[1] = bad;
		CHECK_THROWS_AS(compute_mask_metrics(reference, result), Error);
	}
}

TEST_CASE("[MaskMetrics] the temporal error includes flicker but not a constant error") {
	const std::vector<MaskImage> reference = { make_row({ 0.2f, 1, 1, -1 }),
		make_row({ 0.4f, 1, 1, 1 }), make_row({ 0.6f, 1, -1, 1 }) };
	std::vector<MaskImage> result = reference;
	for (MaskImage &image : result) {
		image.visibility[0] += 0.1f;
	}
	TemporalMetrics metrics = compute_temporal_metrics(reference, result);
	CHECK(metrics.receiver_pixel_count == 6); // pixel 0 twice, 1 twice, 2 once, 3 once
	CHECK(metrics.penumbra_pixel_count == 2);
	CHECK(metrics.receiver_rmse < 1e-6);

	result[1].visibility[0] += 0.3f; // differences wrong by +0.3 and -0.3
	metrics = compute_temporal_metrics(reference, result);
	CHECK(metrics.receiver_rmse == doctest::Approx(std::sqrt(2 * 0.09 / 6)));
	CHECK(metrics.penumbra_rmse == doctest::Approx(0.3));

	CHECK(compute_temporal_metrics({}, {}).receiver_rmse == 0);
	CHECK(compute_temporal_metrics(std::span(reference).first(1), std::span(result).first(1))
					.receiver_pixel_count == 0);
	CHECK_THROWS_AS(compute_temporal_metrics(reference, std::span(result).first(2)), Error);
	const std::vector<MaskImage> mixed = { make_row({ 0, 1 }), make_row({ 0, 1, 1 }) };
	CHECK_THROWS_AS(compute_temporal_metrics(mixed, mixed), Error);
}

TEST_CASE("[MaskMetrics] the JSON has the documented keys in their order") {
	MaskMetrics metrics;
	metrics.receiver = { 4, 0.5, 0.25, 1, -0.125, 0.25 };
	metrics.penumbra = { 2, 0, 0.5, 0.75, 0.1, 0.5 };
	metrics.umbra_over = 0.5;
	CHECK(to_json(metrics) ==
			R"({"pixels":4,"receiver":{"mae":0.5,"rmse":0.25,"p99":1.0,"bias":-0.125,)"
			R"("wrong":0.25},"penumbra":{"pixels":2,"mae":0.0,"rmse":0.5,"p99":0.75,"bias":0.1,)"
			R"("wrong":0.5,"umbra_over":0.5}})");
	CHECK(nlohmann::json::parse(to_json(MaskMetrics()))["pixels"] == 0);
}
