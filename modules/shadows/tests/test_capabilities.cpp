// Masks do not depend on optional device features.

#include "modules/shadows/tests/each_technique.h"

using namespace gnomon;

namespace {

/// Renders three lights at once, so that transient textures have memory to share, and two frames,
/// so that what is cached between frames is used. Two of the lights have 1 view, the omni light has
/// 6.
std::map<std::string, MaskValues> render_lights(
		MaskFixture &r_fixture, const std::string &p_technique) {
	SmallScene scene(LightType::SPOT);
	Light3D &omni = scene.add_light("Omni", LightType::OMNI, { -1.5, 3.5, 1.0 }, { 0, 0.3, 0 });
	Light3D &sun =
			scene.add_light("Sun", LightType::DIRECTIONAL, { 0.5, 4.0, -1.0 }, { 0, 0.3, 0 });
	for (Light3D *light : { scene.light, &omni, &sun }) {
		use_cheap_settings(*light);
	}
	MaskRequest request;
	request.scene = scene.snap();
	request.size_px = glm::uvec2(48);
	request.technique_override = p_technique;
	request.has_normals = false; // devices without geometry shaders cannot draw them
	r_fixture.render(request);
	return r_fixture.render(request).masks;
}

void check_each_technique(const FeatureList &p_denied) {
	MaskFixture able;
	MaskFixture limited(/*p_device=*/"", p_denied);
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		const auto expected = render_lights(able, p_info.id);
		const auto found = render_lights(limited, p_info.id);
		REQUIRE(found.size() == 3);
		for (const auto &[light, mask] : found) {
			CAPTURE(light);
			CHECK(count_receivers(mask) > 0);
			CHECK(mask.receiver == expected.at(light).receiver);
			CHECK(mask.visibility == expected.at(light).visibility);
		}
	});
}

} // namespace

TEST_CASE("[GPU][Techniques] without geometry shaders every technique has the same masks") {
	check_each_technique({ &DeviceFeatures::geometry_shader });
}

TEST_CASE("[GPU][Techniques] without aliased memory every technique has the same masks") {
	check_each_technique({ &DeviceFeatures::aliased_memory });
}

TEST_CASE("[GPU][Techniques] without conditional rendering every technique has the same masks") {
	check_each_technique({ &DeviceFeatures::conditional_rendering });
}

TEST_CASE("[GPU][Techniques] without depth bounds every technique has the same masks") {
	check_each_technique({ &DeviceFeatures::depth_bounds });
}

TEST_CASE("[GPU][Techniques] without buffers that are both storage and texel buffers every "
		  "technique has the same masks") {
	check_each_technique({ &DeviceFeatures::storage_and_texel_buffers });
}

TEST_CASE("[GPU][Techniques] without copies to textures every technique has the same masks") {
	check_each_technique({ &DeviceFeatures::copies_to_textures });
}
