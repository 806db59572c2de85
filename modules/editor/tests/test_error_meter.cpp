#include "modules/editor/error_meter.h"
#include "modules/gltf_scene/tests/animated_test_file.h"
#include "modules/renderer/tests/render_fixture.h"
#include "modules/shadows/shadow_registry.h"

#include <doctest/doctest.h>

#include <thread>

using namespace gnomon;

TEST_CASE("[ErrorMeter] nothing is measured while an animation plays; when it is paused, the shown "
		  "pose is measured") {
	if (ShadowRegistry::find_reference() == nullptr) {
		return;
	}
	const GltfTestFolder folder;
	folder.write("scene.gltf", make_animated(folder).dump());
	RenderFixture fixture;
	EditorDocument document(folder.path / "scene.gltf", StageMode::AUTO); // which adds a light
	Timeline &timeline = document.get_timeline();
	EditorContext context{ document, fixture.device->get_info() };
	context.viewport.size_px = glm::uvec2(32);
	context.viewport.camera.frame(document.compute_selected_bounds());
	context.error.is_shown = true;
	context.error.sample_count = BackgroundReference::FIRST_SAMPLE_COUNT;
	ErrorMeter meter(*fixture.device, *fixture.renderer);
	uint32_t image_count = 0;
	const auto measure = [&] {
		++image_count;
		do {
			meter.update(context, image_count);
			REQUIRE(context.error.refusal == "");
			std::this_thread::yield();
		} while (!context.error.reference);
		return context.error.reference_hash;
	};
	timeline.play();
	for (int frame = 0; frame < 3; ++frame) {
		CHECK(timeline.advance(0.1));
		meter.update(context, ++image_count);
		CHECK(context.error.reference_hash == 0);
		CHECK_FALSE(context.error.is_tracing);
	}
	timeline.pause();
	const double time_s = timeline.get_time_s();
	const uint64_t hash = measure();
	timeline.play();
	CHECK(timeline.advance(0.5));
	meter.update(context, ++image_count);
	CHECK_FALSE(context.error.is_tracing);
	CHECK(context.error.reference_hash == hash); // the last result stays
	timeline.pause();
	meter.update(context, ++image_count); // discards the old reference, so that measure() waits
	CHECK(measure() != hash);
	timeline.seek(time_s);
	meter.update(context, ++image_count);
	CHECK(measure() == hash);
}
