#include "modules/rendering_device/tests/device_fixture.h"
#include "modules/shadows/light_properties.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/tests/mask_fixture.h"
#include "modules/shadows/tests/setting_scope.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// A technique that adds the value of its setting `way` to the plan.
class SettingProbe : public ShadowTechnique {
public:
	void get_light_properties(PropertyList &r_list) const override {
		// The light properties setting_probe_old and setting_probe_older were removed.
		add_moved_setting("setting_probe", "old", r_list);
		add_moved_setting("setting_probe", "older", r_list);
	}
	void get_settings(PropertyList &r_list) const override {
		r_list.add({ "way", PropertyType::ENUM, /*default_value=*/{}, "auto,short,long",
				"Which way.", /*unit=*/"", "Probe" });
		// Of the group that no list shows.
		r_list.add(
				{ "check", PropertyType::BOOL, false, "", "For tests.", "", TEST_SETTINGS_GROUP });
	}
	void plan(const Inputs &p_inputs, TechniquePlan &r_plan) override {
		r_plan.run("way " + std::get<std::string>(p_inputs.settings.at("way")));
	}
	RGTexture resolve(RenderGraph &r_graph, const Inputs &p_inputs) override {
		return add_constant_mask(r_graph, p_inputs.size_px, 1.0f);
	}
	std::vector<std::string> get_shader_files() const override { return {}; }
};

/// Registers SettingProbe as the technique "setting_probe" while it exists.
class SettingProbeScope {
public:
	SettingProbeScope() {
		ShadowRegistry::add({ "setting_probe", "Setting probe", "test", "#000000",
				[] { return std::make_unique<SettingProbe>(); } });
	}
	~SettingProbeScope() { ShadowRegistry::remove("setting_probe"); }
};

std::string catch_message(const std::function<void()> &p_function) {
	try {
		p_function();
	} catch (const Error &error) {
		return error.what();
	}
	return {};
}

} // namespace

TEST_CASE("[GPU][TechniqueSettings] a setting applies to the technique from the next frame on") {
	const SettingProbeScope probe;
	MaskFixture fixture;
	const SmallScene scene;
	CHECK(contains(fixture.render_mask(scene, "setting_probe").plan.to_text(), "way auto"));
	{
		const SettingScope scope("setting_probe", "way", "long");
		CHECK(contains(fixture.render_mask(scene, "setting_probe").plan.to_text(), "way long"));
	}
	CHECK(contains(fixture.render_mask(scene, "setting_probe").plan.to_text(), "way auto"));
}

TEST_CASE("[TechniqueSettings] a wrong id, name or value is an error that lists those that exist") {
	const SettingProbeScope probe;
	const auto set = [](const char *p_id, const char *p_name, const char *p_text) {
		return catch_message([&] { ShadowRegistry::set_setting(p_id, p_name, p_text); });
	};
	CHECK(contains(set("nothing", "way", "long"), "setting_probe"));
	CHECK(contains(set("setting_probe", "wai", "long"), "It has: way.")); // without `check`
	CHECK(contains(set("setting_probe", "way", "round"), "must be auto, short or long"));
	CHECK(std::get<std::string>(ShadowRegistry::get_setting_values("setting_probe").at("way")) ==
			"auto");
}

TEST_CASE("[TechniqueSettings] a project sets them; unknown ids and names only cause warnings") {
	const SettingProbeScope probe;
	const CaughtLog log;
	apply_technique_settings(Project::parse(
			"[technique.setting_probe]\nway=\"short\"\nwai=1\n[technique.gone]\nway=\"x\"\n",
			"/nowhere/project.cfg"));
	CHECK(std::get<std::string>(ShadowRegistry::get_setting_values("setting_probe").at("way")) ==
			"short");
	CHECK(log.lines.size() == 2); // about `wai` and `gone`
	apply_technique_settings(Project::parse("[project]\nname=\"other\"\n", "/nowhere/project.cfg"));
	CHECK(std::get<std::string>(ShadowRegistry::get_setting_values("setting_probe").at("way")) ==
			"auto");
}

TEST_CASE("[TechniqueSettings] light properties that became settings cause one warning per file") {
	const SettingProbeScope probe;
	const CaughtLog log;
	LightSnapshot light;
	light.file_path = "/nowhere/old.gltf";
	for (const char *name : { "First", "Second" }) {
		light.name = name;
		light.properties["setting_probe_old"] = std::string("x");
		light.properties["setting_probe_older"] = true;
		CHECK(resolve_light_properties(light, ShadowRegistry::get_light_properties("setting_probe"))
						.empty());
	}
	REQUIRE(log.lines.size() == 1);
	CHECK(contains(log.lines[0], "setting_probe_old, setting_probe_older"));
	CHECK(contains(log.lines[0], "[technique.setting_probe]"));
	CHECK(find_removed_light_property("setting_probe_old") != nullptr);
	CHECK(find_removed_light_property("setting_probe_new") == nullptr);
}
