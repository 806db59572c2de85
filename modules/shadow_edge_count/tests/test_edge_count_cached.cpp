// Results that are reused from frame to frame: when they are invalidated, and that masks are equal
// bit for bit with and without reuse.

#include "modules/core/files.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

#include <functional>

using namespace gnomon;

namespace {

MaskResult render_again(
		MaskFixture &r_fixture, const SmallScene &p_scene, bool p_may_reuse = true) {
	return render_frame(
			r_fixture, p_scene, { .size_px = glm::uvec2(48), .may_reuse = p_may_reuse });
}

/// Number of casters whose edges the frame found, or reused if p_is_found is false.
int count_casters(const MaskResult &p_result, bool p_is_found) {
	const std::string begin = "find edges, casters: ";
	for (const FramePlanEntry &entry : p_result.plan.get_entries()) {
		if (entry.runs == p_is_found && entry.pass.starts_with(begin)) {
			return std::stoi(entry.pass.substr(begin.size()));
		}
	}
	return 0;
}

/// Number of passes that ran and have p_name in their name.
size_t count_passes(const MaskResult &p_result, const std::string &p_name) {
	return size_t(std::count_if(
			p_result.timings.begin(), p_result.timings.end(), [&](const PassTiming &p_timing) {
				return p_timing.name.find(p_name) != std::string::npos;
			}));
}

/// Changes one thing after another. Each mask must equal that of a renderer without reuse.
void check_changes(LightType p_type) {
	MaskFixture caching;
	MaskFixture fresh;
	SmallScene scene(p_type);
	MeshInstance3D &globe = add_globe(scene);
	const auto set = [&](const char *p_name, PropertyValue p_value) {
		return [&scene, p_name, p_value] { scene.light->properties[p_name] = p_value; };
	};
	struct Step {
		const char *what;
		std::function<void()> change;
		bool finds; // edges of some caster are found again
	};
	const std::vector<Step> steps = {
		{ "first frame", [] {}, true },
		{ "camera", [&] { scene.camera->parent_from_node[3].x += 0.2; }, false },
		{ "R", set("light_size", 0.35), true },
		{ "r without t", set("penumbra_outer_width", 0.1), true },
		{ "256 points, the default", set("edge_count_quality", std::string("256")), false },
		{ "64 points", set("edge_count_quality", std::string("64")), false },
		// The filter reads a depth map, which is drawn together with all other results.
		{ "budget", set("edge_count_budget", int64_t(100)), true },
		{ "no budget", set("edge_count_budget", int64_t(-1)), false },
		{ "light's position", [&] { scene.light->parent_from_node[3].x += 0.3; }, true },
		{ "intensity", [&] { scene.light->intensity = 3.0f; }, false },
		{ "one caster fewer", [&] { scene.box->casts_shadow = false; }, true },
		{ "that caster again", [&] { scene.box->casts_shadow = true; }, true },
		{ "another mesh", [&] { globe.surfaces[0].mesh = make_box_mesh("cube", glm::vec3(0.3f)); },
				true },
		{ "no casters",
				[&] {
					scene.box->casts_shadow = scene.ground->casts_shadow = false;
					globe.casts_shadow = false;
				},
				false },
		{ "all casters",
				[&] {
					scene.box->casts_shadow = scene.ground->casts_shadow = true;
					globe.casts_shadow = true;
				},
				true },
		{ "R = 0", set("light_size", 0.0), true },
		{ "S", [&] { scene.scene.scene_size_m = 6.0; }, true },
	};
	for (const Step &step : steps) {
		CAPTURE(std::string(step.what));
		step.change();
		const MaskResult reused = render_again(caching, scene);
		CHECK((count_casters(reused, /*p_is_found=*/true) > 0) == step.finds);
		CHECK(reused.visibility == render_again(fresh, scene, /*p_may_reuse=*/false).visibility);
	}
}

} // namespace

TEST_CASE("[GPU][EdgeCount] in a static scene no faces or edges are found again") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI }) {
		CAPTURE(int(type));
		SmallScene scene(type);
		add_globe(scene);
		const MaskResult first = render_again(fixture, scene);
		const MaskResult second = render_again(fixture, scene);
		CHECK(first.visibility == second.visibility);
		CHECK(count_casters(first, /*p_is_found=*/true) >= 3);
		CHECK(count_casters(first, /*p_is_found=*/false) == 0);
		CHECK(count_casters(second, /*p_is_found=*/true) == 0);
		for (const char *pass : { "caster faces", "mark edges", "list edges", "bound clusters" }) {
			CAPTURE(std::string(pass));
			CHECK(count_passes(first, pass) > 0);
			CHECK(count_passes(second, pass) == 0);
		}
		size_t cached_count = 0;
		for (const FramePlanEntry &entry : second.plan.get_entries()) {
			cached_count += !entry.runs && entry.pass.starts_with("light view") ? 1 : 0;
		}
		CHECK(cached_count == (type == LightType::OMNI ? 6 : 1));
	}
}

TEST_CASE("[GPU][EdgeCount] edges of a static caster are reused, and the mask equals that of a "
		  "fresh frame") {
	MaskFixture caching;
	MaskFixture fresh;
	SmallScene scene;
	MeshInstance3D &globe = add_globe(scene);
	const auto check = [&](int p_found_count, int p_cached_count) {
		const MaskResult reused = render_again(caching, scene);
		CHECK(count_casters(reused, /*p_is_found=*/true) == p_found_count);
		CHECK(count_casters(reused, /*p_is_found=*/false) == p_cached_count);
		CHECK(reused.visibility == render_again(fresh, scene, /*p_may_reuse=*/false).visibility);
		CHECK(reused.visibility == render_again(caching, scene).visibility);
	};
	check(3, 0);
	for (int step = 0; step < 3; ++step) {
		CAPTURE(step);
		globe.parent_from_node = glm::translate(globe.parent_from_node, { 0.07, 0.03, -0.05 });
		check(1, 2);
	}
	scene.box->parent_from_node = glm::rotate(scene.box->parent_from_node, 0.3, { 0.2, 1.0, 0.0 });
	globe.parent_from_node = glm::translate(globe.parent_from_node, { 0.07, 0.03, -0.05 });
	check(2, 1);
	// A mirrored caster has other flags, which invalidates all results.
	globe.parent_from_node = glm::scale(globe.parent_from_node, { -1.0, 1.0, 1.0 });
	check(3, 0);
}

TEST_CASE("[GPU][EdgeCount] after any change the mask equals that of a fresh frame, bit for bit") {
	check_changes(LightType::SPOT);
}

TEST_CASE("[GPU][EdgeCount] after any change to an omni light with empty views the mask equals "
		  "that of a fresh frame") {
	check_changes(LightType::OMNI);
}

TEST_CASE("[GPU][EdgeCount] masks are equal bit for bit in repeated frames and on new devices") {
	std::vector<float> first[2];
	for (int device = 0; device < 2; ++device) {
		MaskFixture fixture;
		for (const LightType type : { LightType::SPOT, LightType::OMNI }) {
			SmallScene scene(type);
			add_globe(scene);
			// Many overlapping faces, since the order of leaves may vary.
			for (int plate = 0; plate < 8; ++plate) {
				add_mesh(scene.scene, text("Plate ", plate),
						make_box_mesh("plate", { 0.6f, 0.01f, 0.6f }),
						{ 0.05 * plate, 1.4 + 0.1 * plate, 0 });
			}
			scene.light->properties["light_size"] = 0.5;
			for (int repeat = 0; repeat < 3; ++repeat) {
				CAPTURE(device);
				CAPTURE(repeat);
				const std::vector<float> mask =
						render_again(fixture, scene, /*p_may_reuse=*/false).visibility;
				std::vector<float> &expected = first[type == LightType::OMNI ? 1 : 0];
				expected = expected.empty() ? mask : expected;
				CHECK(mask == expected);
			}
		}
	}
}

TEST_CASE("[GPU][EdgeCount] the mask does not depend on previous contents of memory") {
	// Five of the light's views have no casters, and some pixels without a receiver are next to
	// pixels in a shadow: the shadow on the box ends where the box does.
	SmallScene scene(LightType::OMNI);
	scene.ground->surfaces.clear();
	add_mesh(scene.scene, "Globe", make_count_sphere(0.4, 12), { 0.35, 1.9, 0.2 });
	const auto fill_memory = [](RenderingDevice &r_device, uint32_t p_value) {
		// Small enough to share a block of device memory, which remains when they are freed.
		std::vector<OwnedBuffer> buffers;
		const std::vector<uint32_t> words(4u << 20, p_value);
		for (int index = 0; index < 3; ++index) {
			buffers.emplace_back(r_device,
					r_device.create_buffer_with_data(
							{ text("fill ", index), 16u << 20, BufferUsage::STORAGE },
							bytes_of(std::span<const uint32_t>(words))));
		}
		r_device.begin_commands();
		r_device.submit_commands(RenderingDevice::SubmitMode::WAIT);
	};
	std::vector<float> expected;
	// As floats: 0, NaN, 3.4e38 and almost 0.
	for (const uint32_t value : { 0u, 0xffffffffu, 0x7f7f7f7fu, 0x00000fffu }) {
		CAPTURE(value);
		MaskFixture fixture;
		fill_memory(*fixture.device, value);
		const MaskResult result = render_again(fixture, scene);
		expected = expected.empty() ? result.visibility : expected;
		CHECK(result.visibility == expected);
	}
}
