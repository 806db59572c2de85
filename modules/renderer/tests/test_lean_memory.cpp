// Checks that what a frame does not need is neither compiled nor cached, for every registered
// technique.

#include "modules/core/error.h"
#include "modules/core/module_registry.h"
#include "modules/mesh_tools/topology.h"
#include "modules/renderer/tests/lean_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;

namespace {

/// Disables the enabled modules that are not in p_requested and may be disabled. Appends their
/// names to r_off.
void disable_all_but(const std::vector<std::string> &p_requested, std::vector<std::string> &r_off) {
	for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
		if (module.can_disable && module.is_enabled &&
				std::find(p_requested.begin(), p_requested.end(), module.name) ==
						p_requested.end()) {
			r_off.push_back(module.name);
		}
	}
	for (const std::string &name : r_off) {
		ModuleRegistry::set_enabled(name, false);
	}
}

/// Returns the module that registers the technique: if it is disabled, the technique is gone.
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

struct ResourceUse {
	uint32_t pipeline_count = 0;
	uint64_t bytes = 0;
	std::vector<std::string> resources;
	bool operator==(const ResourceUse &) const = default;
};

ResourceUse measure_use(RenderingDevice &r_device) {
	r_device.wait_idle();
	r_device.begin_commands(); // collects what was freed
	r_device.submit_commands(RenderingDevice::SubmitMode::WAIT);
	return { get_pipeline_count(r_device), r_device.get_memory_use().used_bytes,
		list_live_resources(r_device) };
}

} // namespace

TEST_CASE("[GPU][Lean] techniques that no light uses allocate and compile nothing") {
	std::vector<std::string> ids;
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		ids.push_back(info.id);
	}
	const auto measure = [](const std::string &p_id) {
		RenderFixture fixture(DeviceChoice::NEW);
		SmallScene scene;
		fixture.render_image(scene, p_id);
		return measure_use(*fixture.device);
	};
	for (const std::string &id : ids) {
		if (ShadowRegistry::get(id).is_reference) {
			continue; // it traces rays on the CPU, without pipelines of its own
		}
		CAPTURE(id);
		const ResourceUse among_others = measure(id);
		std::vector<std::string> off;
		disable_all_but({ find_module(id) }, off);
		CHECK_FALSE(off.empty());
		const ResourceUse alone = measure(id);
		for (const std::string &name : off) {
			ModuleRegistry::set_enabled(name, true);
		}
		CHECK(among_others == alone);
		CHECK(among_others.pipeline_count > 0);
	}
	// Check the measurement itself: two techniques in use need more pipelines than one.
	RenderFixture fixture(DeviceChoice::NEW);
	TwoLights lights;
	const auto count_pipelines = [&](const std::string &p_second) {
		lights.scene.light->properties["shadow_technique"] = ids.front();
		lights.second.properties["shadow_technique"] = p_second;
		fixture.render_image(lights.scene);
		return get_pipeline_count(*fixture.device);
	};
	const uint32_t one = count_pipelines(ids.front());
	CHECK(count_pipelines(ids.front()) == one);
	CHECK(count_pipelines(ShadowRegistry::find_default()->id == ids.front()
						  ? ShadowRegistry::find_fallback()->id
						  : ShadowRegistry::find_default()->id) > one);
}

TEST_CASE("[GPU][Lean] closing a scene frees all of its memory") {
	RenderFixture fixture(DeviceChoice::NEW);
	const ResourceUse without_frames = measure_use(*fixture.device);
	const size_t topology_count = get_cached_topology_count();
	SmallScene empty;
	empty.scene.root->children.pop_back(); // the light
	empty.ground->surfaces.clear();
	empty.box->surfaces.clear();
	const auto render_empty = [&] {
		for (int frame = 0; frame < 64; ++frame) { // above MAX_UNUSED_FRAMES: caches expire
			fixture.render_image(empty);
		}
		return measure_use(*fixture.device);
	};
	const ResourceUse before = render_empty();
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		if (info.is_reference) {
			continue;
		}
		CAPTURE(info.id);
		{
			SmallScene scene(LightType::OMNI);
			add_mesh(scene.scene, "More", make_box_mesh("more", glm::vec3(0.2f)), { 1, 1, 1 });
			fixture.render_image(scene, info.id);
			fixture.render_mask(scene, info.id);
			CHECK(fixture.device->get_memory_use().used_bytes > before.bytes);
		}
		ResourceUse after = render_empty();
		CHECK(after.bytes == before.bytes);
		CHECK(after.resources == before.resources);
		CHECK(get_cached_topology_count() <= topology_count);
	}
	fixture.renderer.reset();
	const ResourceUse without_renderer = measure_use(*fixture.device);
	CHECK(without_renderer.bytes == without_frames.bytes);
	CHECK(without_renderer.resources == without_frames.resources);
}

TEST_CASE("[GPU][Lean] the maps of a light out of view are freed after a while, not at once") {
	RenderFixture fixture(DeviceChoice::NEW);
	TwoLights lights;
	const std::string id = ShadowRegistry::find_default()->id;
	constexpr int EXPIRY_FRAME_COUNT = 64; // above MAX_UNUSED_FRAMES
	const ResourceUse without = [&] {
		lights.aim_second_light({ 1, 3, 0 }, { 1.2, 9, 0 });
		for (int frame = 0; frame < EXPIRY_FRAME_COUNT; ++frame) {
			fixture.render_image(lights.scene, id);
		}
		return measure_use(*fixture.device);
	}();
	// Whether resources named after the second light exist.
	const auto has_own = [&] {
		const std::vector<std::string> names = list_live_resources(*fixture.device);
		return std::any_of(names.begin(), names.end(), [](const std::string &p_name) {
			return p_name.find("Second") != std::string::npos;
		});
	};
	CHECK_FALSE(has_own());
	lights.aim_second_light({ 1, 3, 0 }, { 0, 0, 0 });
	fixture.render_image(lights.scene, id);
	CHECK(has_own());
	lights.aim_second_light({ 1, 3, 0 }, { 1.2, 9, 0 });
	fixture.render_image(lights.scene, id);
	CHECK(has_own()); // the light may come back into view
	for (int frame = 0; frame < EXPIRY_FRAME_COUNT; ++frame) {
		fixture.render_image(lights.scene, id);
	}
	CHECK_FALSE(has_own());
	CHECK(measure_use(*fixture.device).bytes == without.bytes);
}

TEST_CASE("[GPU][Lean] 256 lights of which 4 are visible need the work and memory of 4") {
	const auto measure = [](int p_hidden_count, ResourceUse &r_used) {
		RenderFixture fixture(DeviceChoice::NEW);
		SmallScene scene;
		for (int index = 1; index < 4; ++index) {
			scene.add_light(text("Visible ", index), LightType::SPOT, { 0.8 * index, 3.5, -0.5 },
					{ 0, 0, 0 });
		}
		const LightType types[] = { LightType::SPOT, LightType::OMNI };
		for (int index = 0; index < p_hidden_count; ++index) {
			const glm::dvec3 position(3.0 * (index % 16) - 24, 4.0, 8.0 + index / 16);
			Light3D &light = scene.add_light(text("Hidden ", index), types[index % 2], position,
					position + glm::dvec3(0, 1, 0.1));
			// Spots point away from the scene, omni lights have a short range.
			light.range_m = index % 2 ? 2.0f : 0.0f;
		}
		fixture.render_image(scene); // fills the caches
		const RenderResult result = fixture.render_image(scene);
		r_used = measure_use(*fixture.device);
		return result;
	};
	ResourceUse of_many;
	ResourceUse of_few;
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
	CHECK(find_skip_reason(many, "Hidden 0") != "");
	CHECK(find_skip_reason(many, "Visible 3") == "");
}
