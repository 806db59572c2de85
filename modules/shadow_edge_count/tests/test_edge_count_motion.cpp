// A light that moves a little each frame: the mask must change as much as the reference does.

#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace gnomon;

namespace {

using Masks = std::vector<MaskResult>; // one per frame

/// The light moves by 1 cm a frame.
Masks render_frames(MaskFixture &r_fixture, const std::string &p_technique) {
	SmallScene scene;
	scene.box->surfaces[0].mesh = make_count_sphere(0.5, 16);
	Masks masks;
	for (int frame = 0; frame < 6; ++frame) {
		masks.push_back(render_frame(r_fixture, scene, { .technique = p_technique }));
		scene.light->parent_from_node[3] += glm::dvec4(0.008, 0.0, -0.006, 0.0);
	}
	return masks;
}

/// The reference masks, without noise: counted in double with 256 points.
Masks count_frames(MaskFixture &r_fixture) {
	SmallScene scene;
	scene.box->surfaces[0].mesh = make_count_sphere(0.5, 16);
	scene.light->properties["edge_count_quality"] = std::string("256");
	Masks masks;
	for (int frame = 0; frame < 6; ++frame) {
		const MaskResult seen = render_frame(r_fixture, scene, { .wants_surfaces = true });
		masks.push_back(count_in_double(scene, seen));
		scene.light->parent_from_node[3] += glm::dvec4(0.008, 0.0, -0.006, 0.0);
	}
	return masks;
}

struct MotionError {
	double rmse = 0; // of the change from frame to frame, in the penumbra of either frame
	double maximum = 0;
	double reference_rms = 0; // of the reference's change
	size_t pixel_count = 0;
};

MotionError compute_motion_error(const Masks &p_masks, const Masks &p_references) {
	MotionError error;
	for (size_t frame = 1; frame < p_masks.size(); ++frame) {
		const MaskResult &reference = p_references[frame];
		const MaskResult &previous = p_references[frame - 1];
		for (size_t index = 0; index < reference.visibility.size(); ++index) {
			const auto is_penumbra = [&](const MaskResult &p_reference) {
				return p_reference.receiver[index] > 0 && p_reference.visibility[index] > 0.002f &&
						p_reference.visibility[index] < 0.998f;
			};
			if (!is_penumbra(reference) && !is_penumbra(previous)) {
				continue;
			}
			const double change =
					p_masks[frame].visibility[index] - p_masks[frame - 1].visibility[index];
			const double reference_change =
					reference.visibility[index] - previous.visibility[index];
			const double difference = std::abs(change - reference_change);
			error.rmse += difference * difference;
			error.maximum = std::max(error.maximum, difference);
			error.reference_rms += reference_change * reference_change;
			++error.pixel_count;
		}
	}
	error.rmse = std::sqrt(error.rmse / double(std::max(error.pixel_count, size_t(1))));
	error.reference_rms =
			std::sqrt(error.reference_rms / double(std::max(error.pixel_count, size_t(1))));
	return error;
}

} // namespace

TEST_CASE("[GPU][EdgeCount] shadows do not flicker while the light moves") {
	MaskFixture fixture;
	REQUIRE(ShadowRegistry::find_fallback() != nullptr);
	const Masks references = count_frames(fixture);
	const MotionError own = compute_motion_error(render_frames(fixture, "edge_count"), references);
	const MotionError fallback = compute_motion_error(
			render_frames(fixture, ShadowRegistry::find_fallback()->id), references);
	CHECK(own.pixel_count > 500);
	CHECK(own.reference_rms > 0.005); // the shadow does move
	// Both masks are rounded to 16-bit floats, with an error of 0.0002 each.
	CHECK(own.rmse < 0.001);
	CHECK(own.maximum < 0.02);
	CHECK(own.rmse < 0.1 * fallback.rmse);
}
