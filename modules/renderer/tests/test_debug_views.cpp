// Checks the debug views of every registered technique.

#include "modules/core/error.h"
#include "modules/renderer/tests/render_fixture.h"
#include "modules/shadows/tests/each_technique.h"

#include <algorithm>

using namespace gnomon;

TEST_CASE("[GPU][Techniques] every debug view can be shown, and an unknown one is refused") {
	RenderFixture fixture;
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		SmallScene scene;
		use_cheap_settings(*scene.light);
		RenderRequest request;
		request.scene = scene.snap();
		request.size_px = glm::uvec2(32);
		request.technique_override = p_info.id;
		request.wants_image = true;
		request.debug_view = "mask";
		for (const std::string &id : fixture.renderer->render(request).debug_views) {
			CAPTURE(id);
			request.debug_view = id;
			CHECK(fixture.renderer->render(request).image.size() == 32 * 32 * 4);
		}
		request.debug_view = "no such view";
		CHECK_THROWS_WITH_AS(
				fixture.renderer->render(request), doctest::Contains("\"mask\""), Error);
		request.needs_debug_view = false;
		const std::vector<uint8_t> instead = fixture.renderer->render(request).image;
		request.debug_view = "";
		CHECK(instead == fixture.renderer->render(request).image);
	});
}

TEST_CASE("[GPU][Techniques] debug views of maps show near and far for every type of light") {
	RenderFixture fixture;
	size_t shown_count = 0;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		RenderRequest request;
		request.scene = scene.snap();
		request.size_px = glm::uvec2(64);
		request.technique_override = p_info.id;
		request.wants_image = true;
		request.debug_view = "map";
		request.needs_debug_view = false;
		const RenderResult result = fixture.renderer->render(request);
		if (std::find(result.debug_views.begin(), result.debug_views.end(), "map") ==
				result.debug_views.end()) {
			return;
		}
		std::vector<uint8_t> reds;
		for (size_t byte = 0; byte < result.image.size(); byte += 4) {
			reds.push_back(result.image[byte]);
		}
		std::sort(reds.begin(), reds.end());
		reds.erase(std::unique(reds.begin(), reds.end()), reds.end());
		CHECK(reds.size() >= 3);				// at least background, box and ground
		CHECK(reds.back() - reds.front() > 64); // a quarter of the range
		++shown_count;
	});
	CHECK(shown_count > 0);
}
