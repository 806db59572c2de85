// Penumbra widths of lights that set none, and the settings that the error report compares.

#include "modules/core/log.h"
#include "modules/rendering_device/tests/device_fixture.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;

namespace {

const char *const IDS[] = { "penumbra_fins", "outer_fins" };

/// Returns the widths r and t, as multiples of R, that a light has with one quality setting.
glm::dvec2 find_widths(const std::string &p_id, LightType p_type, const std::string &p_setting) {
	SmallScene scene(p_type);
	const double size_m = scene.snap()->lights[0].size_m;
	const ShadowTechniqueInfo &info = ShadowRegistry::get(p_id);
	std::vector<QualitySetting> settings;
	info.make()->get_quality_settings(scene.snap()->lights[0], settings);
	const auto found = std::ranges::find(settings, p_setting, &QualitySetting::name);
	REQUIRE(found != settings.end());
	for (const auto &[name, value] : found->properties) {
		scene.light->properties[name] = value;
	}
	LightSnapshot light = scene.snap()->lights[0];
	light.derive_widths(info.derived_widths);
	return glm::dvec2(light.penumbra_outer_width_m, light.penumbra_inner_width_m) / size_m;
}

} // namespace

TEST_CASE("[PenumbraFins] quality settings have the widths that their names state") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		CAPTURE(get_light_type_name(type));
		const glm::dvec2 derived = find_widths("penumbra_fins", type, "r = R/4, t = R/2");
		CHECK(derived.x == doctest::Approx(0.25));
		CHECK(derived.y == doctest::Approx(0.5));
		const glm::dvec2 paper = find_widths("penumbra_fins", type, "r = t = R");
		CHECK(paper.x == doctest::Approx(1));
		CHECK(paper.y == doctest::Approx(1));
		CHECK(find_widths("outer_fins", type, "r = R/6").x == doctest::Approx(1.0 / 6.0));
		CHECK(find_widths("outer_fins", type, "r = R").x == doctest::Approx(1));
	}
}

TEST_CASE(
		"[GPU][PenumbraFins] lights that set no widths have a smaller error than with r = t = R") {
	MaskFixture fixture;
	const ShadowTechniqueInfo *reference = ShadowRegistry::find_reference();
	if (reference == nullptr) {
		return; // not in this build
	}
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		CAPTURE(get_light_type_name(type));
		SmallScene scene(type);
		scene.light->properties[reference->id + "_samples"] = int64_t(256);
		const double size_m = scene.snap()->lights[0].size_m;
		const glm::uvec2 size_px(128);
		const MaskResult exact = fixture.render_mask(scene, reference->id, size_px);
		for (const char *id : IDS) {
			CAPTURE(id);
			const MaskResult derived = fixture.render_mask(scene, id, size_px);
			SmallScene wide(type);
			wide.light->properties["penumbra_outer_width"] = size_m;
			wide.light->properties["penumbra_inner_width"] = size_m;
			const MaskResult paper = fixture.render_mask(wide, id, size_px);
			CHECK(is_valid_mask(derived));
			CHECK(compute_mask_difference(exact, derived) <
					0.75 * compute_mask_difference(exact, paper));
		}
	}
}

TEST_CASE("[GPU][PenumbraFins] a light of 0.3 S is within the limits, one of 0.35 S is not") {
	MaskFixture fixture;
	for (const double size_m : { 1.19, 1.4 }) {
		SmallScene scene; // S = 4 m
		scene.light->parent_from_node = look_at(glm::dvec3(2.4, 8.0, 1.6), glm::dvec3(0, 0.3, 0));
		scene.light->properties["light_size"] = size_m;
		const CaughtLog log;
		fixture.render_mask(scene, "penumbra_fins");
		REQUIRE(log.lines.size() == (size_m < 1.2 ? 0 : 1));
		for (const std::string &line : log.lines) {
			CHECK(contains(line, "penumbra_inner_width, derived from light_size, is 0.7 m"));
		}
	}
}
