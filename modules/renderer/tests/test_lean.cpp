// What a frame does not need is not run, not compiled and not kept: asked of every technique that
// is registered; none is named here.

#include "modules/core/error.h"
#include "modules/core/module_registry.h"
#include "modules/mesh_tools/topology.h"
#include "modules/renderer/tests/render_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;

namespace {

/// The picture with the rules and without them, which must be one; returns the former.
RenderResult render_both(RenderFixture &r_fixture, const SmallScene &p_scene) {
	const RenderResult lean = r_fixture.render_picture(p_scene);
	const RenderResult whole = r_fixture.render_picture(p_scene, "", false);
	CHECK(lean.image == whole.image);
	for (const FramePlanEntry &entry : whole.plan.get_entries()) {
		CHECK_FALSE((entry.pass == "light" && !entry.runs)); // the rule is off
	}
	return lean;
}

/// Why the light was left out; empty when it was not.
std::string find_reason(const RenderResult &p_result, const std::string &p_light) {
	for (const FramePlanEntry &entry : p_result.plan.get_entries()) {
		if (entry.light == p_light && entry.pass == "light" && !entry.runs) {
			return entry.reason;
		}
	}
	return "";
}

/// A spot of 46 degrees to each side, and the ground and the box in view of a camera above them.
struct TwoLights {
	SmallScene scene;
	Light3D &second;
	TwoLights() : second(scene.add_light("Second", LightType::SPOT, { 1, 3, 0 }, { 0, 0, 0 })) {}
	void turn(const glm::dvec3 &p_from, const glm::dvec3 &p_to) {
		second.parent_from_node = look_at(p_from, p_to);
	}
};

void disable_all_but(const std::vector<std::string> &p_wanted, std::vector<std::string> &r_off) {
	for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
		if (module.can_disable && module.is_enabled &&
				std::find(p_wanted.begin(), p_wanted.end(), module.name) == p_wanted.end()) {
			r_off.push_back(module.name);
		}
	}
	for (const std::string &name : r_off) {
		ModuleRegistry::set_enabled(name, false);
	}
}

/// The module that registers the technique: the one without which it is gone.
std::string find_module(const std::string &p_technique) {
	for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
		if (!module.can_disable || !module.is_enabled) {
			continue;
		}
		ModuleRegistry::set_enabled(module.name, false);
		const bool is_gone = ShadowRegistry::find(p_technique) == nullptr;
		ModuleRegistry::set_enabled(module.name, true);
		if (is_gone) {
			return module.name;
		}
	}
	fail("no module registers ", p_technique);
}

struct Used {
	uint32_t pipeline_count = 0;
	uint64_t bytes = 0;
	std::vector<std::string> resources;
	bool operator==(const Used &) const = default;
};

Used measure_use(RenderingDevice &r_device) {
	r_device.wait_idle();
	r_device.begin_commands(); // collects what was freed
	r_device.submit_commands(RenderingDevice::SubmitMode::WAIT);
	return { r_device.get_pipeline_count(), r_device.get_memory_use().used_bytes,
		r_device.get_live_resources() };
}

} // namespace

TEST_CASE("[GPU][Lean] a light that reaches no surface in view is left out, the picture is the "
		  "same") {
	RenderFixture fixture;
	struct Case {
		const char *what;
		const char *reason; // empty: the light must not be left out
		void (*change)(TwoLights &r_lights);
	};
	const char *NOT_IN_CONE = "the camera sees no surface in its cone and range";
	const char *NOT_IN_RANGE = "the camera sees no surface in its range";
	const Case cases[] = {
		{ "a cone that points away from all that is seen", NOT_IN_CONE,
				[](TwoLights &r_lights) {
					r_lights.turn({ 1, 3, 0 }, { 1.2, 9, 0 });
				} },
		{ "a cone that lights a wall outside the view", NOT_IN_CONE,
				[](TwoLights &r_lights) {
					add_mesh(r_lights.scene.scene, "Wall", make_box_mesh("wall", { 1, 1, 1 }),
							{ 0, 0, 40 });
					r_lights.turn({ 0, 0, 30 }, { 0, 0, 40 });
				} },
		{ "a range that ends above everything, in the middle of the view", NOT_IN_RANGE,
				[](TwoLights &r_lights) {
					r_lights.second.type = LightType::OMNI;
					r_lights.second.range_m = 0.5f;
					r_lights.turn({ 0, 2.2, 0 }, { 0, 0, 0.1 });
				} },
		{ "any light, where the camera sees the sky alone", "the camera sees no surface",
				[](TwoLights &r_lights) {
					r_lights.second.type = LightType::DIRECTIONAL;
					r_lights.scene.camera->parent_from_node = look_at({ 0, 9, 0 }, { 0, 20, 0.1 });
				} },
		{ "one that is dark", "its intensity is 0",
				[](TwoLights &r_lights) { r_lights.second.intensity = 0.0f; } },
		{ "one that lights what is seen", "", [](TwoLights &) {} },
		{ "one whose range ends just on a surface", "",
				[](TwoLights &r_lights) {
					r_lights.second.type = LightType::OMNI;
					r_lights.second.range_m = 0.75f; // to the box's upper side at 1.3 m
					r_lights.turn({ 0, 2.0, 0 }, { 0, 0, 0.1 });
				} },
		{ "one behind the camera that lights the view", "",
				[](TwoLights &r_lights) {
					r_lights.turn({ -4.8, 7.2, 6.8 }, { 0, 0, 0 });
				} },
	};
	for (const Case &one : cases) {
		CAPTURE(one.what);
		TwoLights lights;
		one.change(lights);
		const RenderResult lean = render_both(fixture, lights.scene);
		CHECK(find_reason(lean, "Second") == one.reason);
		const bool has_wall = std::string(one.what).find("a wall outside") != std::string::npos;
		CHECK((lean.plan.is_left_out("", "1 instances") || !has_wall));
	}
}

TEST_CASE("[GPU][Lean] the light whose debug view is asked for is drawn wherever it shines") {
	RenderFixture fixture;
	TwoLights lights;
	lights.turn({ 1, 3, 0 }, { 1.2, 9, 0 });
	RenderRequest request;
	request.scene = lights.scene.snap();
	request.size_px = glm::uvec2(32);
	request.technique_override = ShadowRegistry::get_techniques().at(0).id;
	request.debug_view = "mask";
	request.debug_light = "Second";
	const RenderResult result = fixture.renderer->render(request);
	CHECK(find_reason(result, "Second") == "");
	CHECK(std::count(result.debug_views.begin(), result.debug_views.end(), "mask") == 1);
}

TEST_CASE("[GPU][Lean] the mask of a light that lights nothing in view runs no technique") {
	RenderFixture fixture;
	SmallScene scene;
	scene.light->parent_from_node = look_at({ 1.2, 4.0, 0.8 }, { 1.2, 9.0, 0.9 });
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_techniques()) {
		CAPTURE(info.id);
		const RenderResult lean = fixture.render_mask(scene, info.id);
		CHECK(lean.plan.is_left_out("Light", "shadow"));
		CHECK(count_receivers(lean) == 0);
		if (!info.is_reference) {
			const RenderResult whole = fixture.render_mask(scene, info.id, glm::uvec2(64), false);
			CHECK(lean.visibility == whole.visibility);
			CHECK(lean.find_light_passes("Light").size() < whole.find_light_passes("Light").size());
		}
	}
}

TEST_CASE("[GPU][Lean] views without receivers never change a mask, while the camera turns") {
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_techniques()) {
		if (info.is_reference) {
			continue; // it draws no views
		}
		CAPTURE(info.id);
		RenderFixture turning;
		RenderFixture whole;
		SmallScene scene(LightType::OMNI);
		scene.light->parent_from_node = look_at({ 0.2, 1.9, 0.3 }, { 0.1, 0, 0.2 });
		scene.light->properties["light_size"] = 0.1;
		for (const PropertyInfo &property :
				ShadowRegistry::get_light_properties(info.id).get_properties()) {
			if (property.name.ends_with("_map_size")) {
				scene.light->properties[property.name] = int64_t(128);
			} else if (property.name.ends_with("_count")) {
				scene.light->properties[property.name] = int64_t(2);
			}
		}
		// Walls about the light, so that each view has casters and receivers of its own.
		for (const double side : { -1.0, 1.0 }) {
			add_mesh(scene.scene, "Wall x", make_box_mesh("x", { 0.1f, 2, 2 }), { 2 * side, 1, 0 });
			add_mesh(scene.scene, "Wall z", make_box_mesh("z", { 2, 2, 0.1f }), { 0, 1, 2 * side });
		}
		for (const glm::dvec3 towards : { glm::dvec3(1, -0.2, 0), glm::dvec3(1, -0.2, 0),
					 glm::dvec3(-1, -0.3, 0.2), glm::dvec3(0, -1, 0.1), glm::dvec3(1, -0.2, 0) }) {
			scene.camera->parent_from_node =
					look_at({ 0, 1.2, 0 }, glm::dvec3(0, 1.2, 0) + towards);
			scene.camera->vertical_fov_rad = 0.7f;
			scene.light->parent_from_node[3].x += 0.01 * towards.y; // some frames differ, some not
			const RenderResult lean = turning.render_mask(scene, info.id, glm::uvec2(48));
			const RenderResult all = whole.render_mask(scene, info.id, glm::uvec2(48), false);
			CHECK(count_receivers(lean) > 500);
			CHECK(lean.visibility == all.visibility);
		}
	}
}

TEST_CASE("[GPU][Lean] techniques that no light uses allocate and compile nothing") {
	std::vector<std::string> ids;
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_techniques()) {
		ids.push_back(info.id);
	}
	const auto measure = [](const std::string &p_id) {
		RenderFixture fixture;
		SmallScene scene;
		fixture.render_picture(scene, p_id);
		return measure_use(*fixture.device);
	};
	for (const std::string &id : ids) {
		if (ShadowRegistry::get(id).is_reference) {
			continue; // rays: nothing on the device
		}
		CAPTURE(id);
		const Used among_others = measure(id);
		std::vector<std::string> off;
		disable_all_but({ find_module(id) }, off);
		CHECK_FALSE(off.empty());
		const Used alone = measure(id);
		for (const std::string &name : off) {
			ModuleRegistry::set_enabled(name, true);
		}
		CHECK(among_others == alone);
		CHECK(among_others.pipeline_count > 0);
	}
	// Two techniques at work are more: what is counted above does tell them apart.
	RenderFixture fixture;
	TwoLights lights;
	const auto count_pipelines = [&](const std::string &p_second) {
		lights.scene.light->properties["shadow_technique"] = ids.front();
		lights.second.properties["shadow_technique"] = p_second;
		fixture.render_picture(lights.scene);
		return fixture.device->get_pipeline_count();
	};
	const uint32_t one = count_pipelines(ids.front());
	CHECK(count_pipelines(ids.front()) == one);
	CHECK(count_pipelines(ShadowRegistry::find_default()->id == ids.front()
						  ? ShadowRegistry::find_fallback()->id
						  : ShadowRegistry::find_default()->id) > one);
}

TEST_CASE("[GPU][Lean] a scene that is closed gives back all memory") {
	RenderFixture fixture;
	const Used without_frames = measure_use(*fixture.device);
	const size_t topology_count = get_kept_topology_count();
	SmallScene empty;
	empty.scene.root->children.pop_back(); // the light
	empty.ground->surfaces.clear();
	empty.box->surfaces.clear();
	const auto render_empty = [&] {
		for (int frame = 0; frame < 64; ++frame) { // what is kept for a while goes too
			fixture.render_picture(empty);
		}
		return measure_use(*fixture.device);
	};
	const Used before = render_empty();
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_techniques()) {
		if (info.is_reference) {
			continue;
		}
		CAPTURE(info.id);
		{
			SmallScene scene(LightType::OMNI);
			add_mesh(scene.scene, "More", make_box_mesh("more", glm::vec3(0.2f)), { 1, 1, 1 });
			fixture.render_picture(scene, info.id);
			fixture.render_mask(scene, info.id);
			CHECK(fixture.device->get_memory_use().used_bytes > before.bytes);
		}
		Used after = render_empty();
		CHECK(after.bytes == before.bytes);
		CHECK(after.resources == before.resources);
		CHECK(get_kept_topology_count() <= topology_count);
	}
	fixture.renderer.reset();
	const Used without_renderer = measure_use(*fixture.device);
	CHECK(without_renderer.bytes == without_frames.bytes);
	CHECK(without_renderer.resources == without_frames.resources);
}

TEST_CASE("[GPU][Lean] a light out of view gives back its maps after a while, and not at once") {
	RenderFixture fixture;
	TwoLights lights;
	const std::string id = ShadowRegistry::find_default()->id;
	const Used without = [&] {
		lights.turn({ 1, 3, 0 }, { 1.2, 9, 0 });
		for (int frame = 0; frame < 64; ++frame) {
			fixture.render_picture(lights.scene, id);
		}
		return measure_use(*fixture.device);
	}();
	const auto has_own = [&] {
		const std::vector<std::string> names = fixture.device->get_live_resources();
		return std::any_of(names.begin(), names.end(), [](const std::string &p_name) {
			return p_name.find("Second") != std::string::npos;
		});
	};
	CHECK_FALSE(has_own());
	lights.turn({ 1, 3, 0 }, { 0, 0, 0 });
	fixture.render_picture(lights.scene, id);
	CHECK(has_own());
	lights.turn({ 1, 3, 0 }, { 1.2, 9, 0 });
	fixture.render_picture(lights.scene, id);
	CHECK(has_own()); // it may come back
	for (int frame = 0; frame < 64; ++frame) {
		fixture.render_picture(lights.scene, id);
	}
	CHECK_FALSE(has_own());
	CHECK(measure_use(*fixture.device).bytes == without.bytes);
}

TEST_CASE("[GPU][Lean] 256 lights of which 4 are visible do and hold what 4 do") {
	const auto measure = [](int p_hidden_count, Used &r_used) {
		RenderFixture fixture;
		SmallScene scene;
		for (int index = 1; index < 4; ++index) {
			scene.add_light(text("Visible ", index), LightType::SPOT, { 0.8 * index, 3.5, -0.5 },
					{ 0, 0, 0 });
		}
		const LightType types[] = { LightType::SPOT, LightType::OMNI };
		for (int index = 0; index < p_hidden_count; ++index) {
			const glm::dvec3 place(3.0 * (index % 16) - 24, 4.0, 8.0 + index / 16);
			Light3D &light = scene.add_light(
					text("Hidden ", index), types[index % 2], place, place + glm::dvec3(0, 1, 0.1));
			light.range_m = index % 2 ? 2.0f : 0.0f; // a spot points away, an omni light ends
		}
		fixture.render_picture(scene);
		const RenderResult result = fixture.render_picture(scene);
		r_used = measure_use(*fixture.device);
		return result;
	};
	Used of_many;
	Used of_few;
	const RenderResult many = measure(252, of_many);
	const RenderResult few = measure(0, of_few);
	CHECK(many.image == few.image);
	CHECK(many.timings.size() == few.timings.size());
	CHECK(many.commands.draws == few.commands.draws);
	CHECK(many.commands.dispatches == few.commands.dispatches);
	CHECK(many.aliased_bytes == few.aliased_bytes);
	CHECK(of_many == of_few);
	CHECK(few.commands.dispatches > 4);
	CHECK(few.commands.draws > 0);
	CHECK(find_reason(many, "Hidden 0") != "");
	CHECK(find_reason(many, "Visible 3") == "");
}
