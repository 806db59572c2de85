// Compares the renderer's error view with the error image of the same masks.

#include "modules/core/error.h"
#include "modules/masks/mask_png.h"
#include "modules/renderer/tests/render_fixture.h"

#include <doctest/doctest.h>

#include <cstdlib>

using namespace gnomon;

namespace {

/// The frame's mask with the receivers of every third column changed by up to 0.5.
MaskImage make_wrong_reference(const RenderResult &p_frame, glm::uvec2 p_size_px) {
	MaskImage reference = { p_size_px, p_frame.visibility, p_frame.receiver };
	for (size_t pixel = 0; pixel < reference.get_pixel_count(); ++pixel) {
		if (pixel % 3 == 0 && reference.is_receiver(pixel)) {
			const float change = 0.5f * float(pixel % 64) / 64.0f;
			const float visibility = reference.visibility[pixel];
			reference.visibility[pixel] =
					visibility > 0.5f ? visibility - change : visibility + change;
		}
	}
	return reference;
}

} // namespace

TEST_CASE("[GPU][ErrorView] the error view shows the colours of the error image") {
	RenderFixture fixture;
	const SmallScene scene;
	const std::string id = ShadowRegistry::get_all().front().id;
	const glm::uvec2 size_px(48, 40);
	const RenderResult frame = fixture.render_mask(scene, id, size_px);
	const MaskImage mask = { size_px, frame.visibility, frame.receiver };
	const MaskImage reference = make_wrong_reference(frame, size_px);
	RenderRequest request;
	request.scene = scene.snap();
	request.size_px = size_px;
	request.technique_override = id;
	request.wants_image = true;
	request.debug_view = "error";
	request.reference = std::make_shared<ReferenceMask>(
			reference.size_px, reference.visibility, reference.receiver);
	const std::vector<uint8_t> shown = fixture.renderer->render(request).image;
	const std::vector<uint8_t> expected = compute_error_pixels(reference, mask);
	REQUIRE(shown.size() == 4 * reference.get_pixel_count());
	int max_difference = 0;
	size_t colored_count = 0;
	for (size_t pixel = 0; pixel < reference.get_pixel_count(); ++pixel) {
		for (size_t channel = 0; channel < 3; ++channel) {
			max_difference = std::max(max_difference,
					std::abs(int(shown[4 * pixel + channel]) - int(expected[3 * pixel + channel])));
		}
		colored_count += shown[4 * pixel] != shown[4 * pixel + 2] ? 1 : 0;
	}
	CHECK(max_difference <= 1);
	// Without error a pixel is white or grey; make_wrong_reference changes up to a third of them.
	CHECK(colored_count > reference.get_pixel_count() / 5);
}

TEST_CASE("[GPU][ErrorView] an error view without a reference, or with one of another size, is "
		  "refused") {
	RenderFixture fixture;
	const SmallScene scene;
	RenderRequest request;
	request.scene = scene.snap();
	request.size_px = glm::uvec2(16);
	request.debug_view = "error";
	CHECK_THROWS_WITH_AS(
			fixture.renderer->render(request), doctest::Contains("--reference"), Error);
	const std::vector<float> values(12, 1.0f);
	request.reference = std::make_shared<ReferenceMask>(glm::uvec2(4, 3), values, values);
	CHECK_THROWS_WITH_AS(fixture.renderer->render(request),
			doctest::Contains("4 x 3 pixels, the frame 16 x 16"), Error);
}
