#pragma once

#include "modules/renderer/renderer.h"
#include "modules/shadows/tests/mask_fixture.h"

// A device with validation layers and a renderer, for the tests of the renderer.

namespace gnomon {

struct RenderFixture {
	TemporaryCache cache;
	TestDevice device;
	std::unique_ptr<Renderer> renderer;

	/// p_device: as DeviceOptions::device.
	explicit RenderFixture(const std::string &p_device = "", const FeatureList &p_denied = {},
			DeviceChoice p_choice = DeviceChoice::ANY) :
			device(create_test_device(p_choice, p_device, p_denied)) {
		renderer = std::make_unique<Renderer>(*device);
	}
	explicit RenderFixture(DeviceChoice p_choice) : RenderFixture("", {}, p_choice) {}

	RenderResult render_mask(const SmallScene &p_scene, const std::string &p_technique,
			glm::uvec2 p_size_px = glm::uvec2(64), bool p_may_skip = true) {
		RenderRequest request;
		request.scene = p_scene.snap();
		request.size_px = p_size_px;
		request.technique_override = p_technique;
		request.mask_light = p_scene.light->name;
		request.wants_mask = true;
		request.may_skip = p_may_skip;
		return renderer->render(request);
	}
	RenderResult render_image(const SmallScene &p_scene, const std::string &p_technique = "",
			bool p_may_skip = true) {
		RenderRequest request;
		request.scene = p_scene.snap();
		request.size_px = glm::uvec2(64);
		request.technique_override = p_technique;
		request.wants_image = true;
		request.may_skip = p_may_skip;
		return renderer->render(request);
	}
};

} // namespace gnomon
