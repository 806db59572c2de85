// Penumbra widths that a light leaves unset are those that its technique derives.

#include "modules/rendering_device/tests/device_fixture.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Collects the widths of the lights that it gets, r and t. Its limit is r = 0.1 S.
class WidthProbe : public ShadowTechnique {
public:
	inline static std::vector<glm::vec2> widths_m;

	ShadowLimits get_limits(const PropertyValues & /*p_properties*/) const override {
		return { .max_outer_width_sizes = 0.1 };
	}
	void get_light_views(const LightSnapshot &p_light, const LightScene & /*p_scene*/,
			const PropertyValues & /*p_properties*/,
			std::vector<LightView> & /*r_views*/) const override {
		add(p_light);
	}
	void plan(const Inputs &p_inputs, TechniquePlan & /*r_plan*/) override { add(p_inputs.light); }
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override {
		add(p_inputs.light);
		return add_constant_mask(r_graph, p_inputs.size_px, 1.0f);
	}
	std::vector<std::string> get_shader_files() const override { return {}; }

private:
	static void add(const LightSnapshot &p_light) {
		widths_m.emplace_back(p_light.penumbra_outer_width_m, p_light.penumbra_inner_width_m);
	}
};

/// Registers WidthProbe twice while it exists: as "narrow_probe", which derives r = R/4 and t =
/// R/2, and as "plain_probe".
class WidthProbeScope {
public:
	WidthProbeScope() {
		for (const char *id : { "narrow_probe", "plain_probe" }) {
			ShadowTechniqueInfo info = { id, "Width probe", "test", "#000000",
				[] { return std::make_unique<WidthProbe>(); } };
			if (info.id == "narrow_probe") {
				info.derived_widths = { 0.25f, 0.5f };
			}
			ShadowRegistry::add(std::move(info));
		}
	}
	~WidthProbeScope() {
		ShadowRegistry::remove("plain_probe");
		ShadowRegistry::remove("narrow_probe");
	}
};

/// Returns the widths that every hook of the technique gets in one frame, which must be equal.
glm::vec2 find_widths_m(
		MaskFixture &r_fixture, const SmallScene &p_scene, const std::string &p_override) {
	WidthProbe::widths_m.clear();
	r_fixture.render_mask(p_scene, p_override);
	REQUIRE(WidthProbe::widths_m.size() >= 3);
	for (const glm::vec2 &widths_m : WidthProbe::widths_m) {
		CHECK(widths_m == WidthProbe::widths_m[0]);
	}
	return WidthProbe::widths_m[0];
}

} // namespace

TEST_CASE("[GPU][DerivedWidths] widths follow the technique that runs, also when it is replaced") {
	const WidthProbeScope probes;
	MaskFixture fixture;
	SmallScene scene; // R = 0.2 m
	scene.light->properties["shadow_technique"] = std::string("narrow_probe");
	const glm::vec2 narrow_m = { 0.05f, 0.1f };
	const glm::vec2 plain_m = { 0.2f, 0.2f };
	CHECK(find_widths_m(fixture, scene, "") == narrow_m);
	CHECK(find_widths_m(fixture, scene, "plain_probe") == plain_m);
	CHECK(find_widths_m(fixture, scene, "narrow_probe") == narrow_m);
	scene.light->properties["shadow_technique"] = std::string("plain_probe");
	CHECK(find_widths_m(fixture, scene, "") == plain_m);
	CHECK(find_widths_m(fixture, scene, "narrow_probe") == narrow_m);
}

TEST_CASE("[GPU][DerivedWidths] a directional light's widths are multiples of its tangent x S") {
	const WidthProbeScope probes;
	MaskFixture fixture;
	SmallScene scene(LightType::DIRECTIONAL); // 6 degrees, S = 4 m
	const glm::vec2 widths_m = find_widths_m(fixture, scene, "narrow_probe");
	CHECK(widths_m.x == doctest::Approx(0.25 * 4.0 * std::tan(glm::radians(3.0))));
	CHECK(widths_m.y == doctest::Approx(0.50 * 4.0 * std::tan(glm::radians(3.0))));
}

TEST_CASE("[GPU][DerivedWidths] widths that a light sets are the same for every technique") {
	const WidthProbeScope probes;
	MaskFixture fixture;
	SmallScene scene;
	scene.light->properties["penumbra_outer_width"] = 0.3;
	CHECK(find_widths_m(fixture, scene, "narrow_probe") == glm::vec2(0.3f, 0.1f));
	CHECK(find_widths_m(fixture, scene, "plain_probe") == glm::vec2(0.3f, 0.2f));
	scene.light->properties["penumbra_inner_width"] = 0.0;
	CHECK(find_widths_m(fixture, scene, "narrow_probe") == glm::vec2(0.3f, 0.0f));
	CHECK(find_widths_m(fixture, scene, "plain_probe") == glm::vec2(0.3f, 0.0f));
}

TEST_CASE("[GPU][DerivedWidths] translucent casters are drawn with the same widths") {
	const WidthProbeScope probes;
	MaskFixture fixture;
	SmallScene scene;
	auto glass = std::make_shared<Material>();
	glass->transmission = 0.8f;
	scene.box->surfaces[0].material = glass;
	CHECK(find_widths_m(fixture, scene, "narrow_probe") == glm::vec2(0.05f, 0.1f));
	CHECK(WidthProbe::widths_m.size() == 6); // three hooks without the box and three with it
}

TEST_CASE("[GPU][DerivedWidths] limits apply to the widths that the technique derives") {
	const WidthProbeScope probes;
	MaskFixture fixture;
	const auto list_warnings = [&](double p_light_size_m, const char *p_technique) {
		SmallScene scene; // S = 4 m: r is at most 0.4 m
		scene.scene.scene_size_m = 4.0;
		// Farther from the casters than R.
		scene.light->parent_from_node = look_at(glm::dvec3(2.4, 8.0, 1.6), glm::dvec3(0, 0.3, 0));
		scene.light->properties["light_size"] = p_light_size_m;
		const CaughtLog log;
		fixture.shadows = std::make_unique<ShadowSystem>(*fixture.device); // warns again
		fixture.render_mask(scene, p_technique);
		return log.lines;
	};
	CHECK(list_warnings(0.3, "plain_probe").empty());
	CHECK(list_warnings(1.5, "plain_probe").size() == 1);
	CHECK(list_warnings(1.5, "narrow_probe").empty()); // r is 0.375 m
	const std::vector<std::string> warnings = list_warnings(1.7, "narrow_probe");
	REQUIRE(warnings.size() == 1);
	CHECK(contains(warnings[0], "penumbra_outer_width, derived from light_size, is 0.425 m"));
	CHECK(contains(warnings[0], "narrow_probe is wrong above 0.4 m"));
}
