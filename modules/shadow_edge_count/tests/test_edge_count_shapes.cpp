// The two shapes of the passes that count edges, for CPU drivers and for GPUs: equal masks.

#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Overlapping casters near the ground, and a large light, so that all kinds of leaves occur.
SmallScene make_shapes_scene(LightType p_type, const char *p_quality) {
	SmallScene scene(p_type);
	add_globe(scene);
	add_mesh(scene.scene, "Second globe", make_count_sphere(0.5, 24), { 0.5, 0.9, 0.4 });
	add_mesh(scene.scene, "Third globe", make_count_sphere(0.3, 12), { 0.2, 1.5, 0.1 });
	scene.light->properties["light_size"] = 0.5;
	scene.light->properties["light_angular_distance"] = 15.0;
	scene.light->properties["edge_count_quality"] = std::string(p_quality);
	return scene;
}

} // namespace

TEST_CASE(
		"[GPU][EdgeCount] the shapes for CPU drivers and for GPUs give equal masks, bit for bit") {
	MaskFixture on_cpu;
	MaskFixture on_gpu("", { &DeviceFeatures::runs_on_cpu });
	REQUIRE_FALSE(on_gpu.device->get_features().runs_on_cpu);
	for (const LightType type : { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI }) {
		for (const char *quality : { "64", "256" }) {
			CAPTURE(std::string(get_light_type_name(type)));
			CAPTURE(std::string(quality));
			SmallScene scene = make_shapes_scene(type, quality);
			for (const double interpolation : { 0.0, 0.5 }) {
				scene.light->properties["edge_count_interpolation"] = interpolation;
				const MaskResult expected = render_frame(on_cpu, scene);
				CHECK(render_frame(on_gpu, scene).visibility == expected.visibility);
				CHECK(std::count_if(expected.visibility.begin(), expected.visibility.end(),
							  [](float p_value) { return p_value > 0.0f && p_value < 1.0f; }) >
						500);
			}
		}
	}
}

TEST_CASE("[GPU][EdgeCount] both shapes count what their lists have no room for, and in rounds") {
	MaskFixture on_cpu;
	MaskFixture on_gpu("", { &DeviceFeatures::runs_on_cpu });
	for (const char *quality : { "64", "256" }) {
		CAPTURE(std::string(quality));
		SmallScene scene(LightType::OMNI);
		// More edges than one dispatch counts.
		add_mesh(scene.scene, "Globe", make_count_sphere(0.5, 96), { -0.3, 1.2, 0.3 });
		scene.light->properties["light_size"] = 1.5;
		scene.light->properties["edge_count_quality"] = std::string(quality);
		const FrameOptions options = { .size_px = glm::uvec2(16) };
		CHECK(render_frame(on_gpu, scene, options).visibility ==
				render_frame(on_cpu, scene, options).visibility);
	}
}
