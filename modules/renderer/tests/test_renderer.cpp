#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/core/module_registry.h"
#include "modules/renderer/tests/render_fixture.h"
#include "modules/shadows/light_properties.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Collects the lines of the log during its lifetime, instead of printing them.
struct CaughtLines {
	std::vector<std::string> lines;
	LogSink before;
	CaughtLines() {
		before = set_log_sink(
				[this](LogLevel, const std::string &p_line) { lines.push_back(p_line); });
	}
	~CaughtLines() { set_log_sink(before); }
};

double compute_mean(const RenderResult &p_result) {
	double sum = 0;
	for (uint8_t byte : p_result.image) {
		sum += byte;
	}
	return sum / double(p_result.image.size());
}

} // namespace

TEST_CASE("[GPU][Renderer] a light's shadow makes the image darker") {
	RenderFixture fixture;
	SmallScene scene;
	// Any technique works; the available ones depend on the build.
	const std::string any = ShadowRegistry::get_all().at(0).id;
	scene.light->properties["shadow_enabled"] = false;
	const RenderResult without_shadow = fixture.render_image(scene, any);
	scene.light->properties["shadow_enabled"] = true;
	const RenderResult with_shadow = fixture.render_image(scene, any);
	CHECK(compute_mean(with_shadow) < compute_mean(without_shadow));
	CHECK(without_shadow.plan.is_skipped("Light", "shadow"));
	CHECK_FALSE(with_shadow.plan.is_skipped("Light", "shadow"));
}

TEST_CASE(
		"[GPU][Renderer] an antialiased image is the mean of a larger one, masks keep their size") {
	const auto decode = [](uint8_t p_byte) {
		const double value = p_byte / 255.0;
		return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
	};
	const auto encode = [](double p_linear) {
		return 255 *
				(p_linear <= 0.0031308 ? 12.92 * p_linear
									   : 1.055 * std::pow(p_linear, 1 / 2.4) - 0.055);
	};
	RenderFixture fixture;
	SmallScene scene;
	RenderRequest request;
	request.scene = scene.snap();
	request.wants_image = true;
	for (const uint32_t factor : { 2u, 3u, 4u }) {
		CAPTURE(factor);
		request.size_px = { 24, 20 };
		request.antialiasing = factor;
		const std::vector<uint8_t> found = fixture.renderer->render(request).image;
		REQUIRE(found.size() == 24 * 20 * 4);
		request.size_px *= factor;
		request.antialiasing = 1;
		const std::vector<uint8_t> larger = fixture.renderer->render(request).image;
		double max_error = 0;
		for (uint32_t byte = 0; byte < found.size(); ++byte) {
			if (byte % 4 == 3) {
				continue;
			}
			const glm::uvec2 pixel(byte / 4 % 24, byte / 4 / 24);
			double sum = 0;
			for (uint32_t y = 0; y < factor; ++y) {
				for (uint32_t x = 0; x < factor; ++x) {
					const glm::uvec2 texel = pixel * factor + glm::uvec2(x, y);
					sum += decode(larger[4 * (texel.y * 24 * factor + texel.x) + byte % 4]);
				}
			}
			max_error = std::max(
					max_error, std::abs(encode(sum / (factor * factor)) - double(found[byte])));
		}
		CHECK(max_error <= 1.5); // of 255; both images are rounded to 8 bits
	}
	request.antialiasing = 4;
	request.mask_light = scene.light->name;
	request.wants_mask = true;
	request.size_px = { 24, 20 };
	CHECK(fixture.renderer->render(request).visibility.size() == 24 * 20);
	request.mask_light = "";
	request.wants_mask = false;
	for (const uint32_t invalid_factor : { 0u, 5u }) {
		request.antialiasing = invalid_factor;
		CHECK_THROWS_WITH_AS(
				fixture.renderer->render(request), doctest::Contains("must be 1..4"), Error);
	}
	request.antialiasing = 4;
	request.size_px = { 8000, 4 }; // drawn 32000 wide, above MAX_IMAGE_SIZE_PX
	CHECK_THROWS_WITH_AS(
			fixture.renderer->render(request), doctest::Contains("with antialiasing 4"), Error);
}

TEST_CASE("[GPU][Renderer] skipping a light whose range ends before the view does not change the "
		  "image") {
	RenderFixture fixture;
	SmallScene scene;
	Light3D &far_light = scene.add_light("Far", LightType::OMNI, { 0, 2, 500 }, { 0, 0, 500 });
	far_light.range_m = 5.0f;
	const RenderResult lean = fixture.render_image(scene);
	const RenderResult whole = fixture.render_image(scene, "", false);
	CHECK(lean.plan.is_skipped("Far", "light"));
	CHECK_FALSE(whole.plan.is_skipped("Far", "light"));
	CHECK(lean.image == whole.image);
	CHECK(lean.timings.size() < whole.timings.size());
}

TEST_CASE(
		"[GPU][Renderer] scenes without lights, with many, and without meshes in view are drawn") {
	RenderFixture fixture;
	SmallScene scene;
	for (int index = 0; index < 64; ++index) {
		const double angle = index * 0.1;
		scene.add_light(text("Light ", index), index % 2 ? LightType::SPOT : LightType::OMNI,
				{ 3 * std::cos(angle), 3.0, 3 * std::sin(angle) }, { 0, 0, 0 });
	}
	CHECK(fixture.render_image(scene).image.size() == 64 * 64 * 4);
	scene.camera->parent_from_node = look_at({ 0, 50, 0 }, { 0, 100, 0.1 });
	const RenderResult nothing = fixture.render_image(scene);
	CHECK(nothing.image.size() == 64 * 64 * 4);
	SmallScene dark;
	dark.scene.root->children.pop_back(); // the light
	RenderRequest request;
	request.scene = dark.snap();
	request.size_px = glm::uvec2(16);
	request.wants_image = true;
	CHECK(fixture.renderer->render(request).image.size() == 16 * 16 * 4);
}

TEST_CASE("[GPU][Renderer] an unknown technique or light, or a size out of range, is an error") {
	RenderFixture fixture;
	SmallScene scene;
	CHECK_THROWS_WITH_AS(fixture.render_image(scene, "no_such_technique"),
			doctest::Contains("no_such_technique"), Error);
	CHECK_THROWS_AS(fixture.render_mask(scene, "", { 0, 4 }), Error);
	CHECK_THROWS_AS(fixture.render_mask(scene, "", { 100000, 4 }), Error);
	scene.light->name = "Lamp";
	RenderRequest request;
	request.scene = scene.snap();
	request.mask_light = "Other";
	CHECK_THROWS_AS(fixture.renderer->render(request), Error);
	CHECK(fixture.render_image(scene).image.size() == 64 * 64 * 4); // the renderer still works
}

TEST_CASE("[GPU][Renderer] a light whose technique is missing takes the fallback and warns once") {
	const ShadowTechniqueInfo *fallback = ShadowRegistry::find_fallback();
	RenderFixture fixture;
	SmallScene scene;
	scene.light->properties["shadow_technique"] = std::string("from_another_build");
	scene.light->properties["from_another_build_quality"] = int64_t(7);
	CaughtLines log;
	const RenderResult result = fixture.render_image(scene);
	fixture.render_image(scene);
	REQUIRE(log.lines.size() == 1);
	CHECK(log.lines[0].find("from_another_build") != std::string::npos);
	CHECK(result.plan.is_skipped("Light", fallback ? "from_another_build" : "shadow"));
	CHECK(scene.light->properties.count("from_another_build_quality") == 1);
}

TEST_CASE("[GPU][Renderer] technique modules can be switched off and on between frames") {
	RenderFixture fixture;
	SmallScene scene;
	const RenderResult before = fixture.render_image(scene);
	std::vector<std::string> names;
	for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
		if (module.can_disable && module.is_enabled) {
			names.push_back(module.name);
		}
	}
	CaughtLines log;
	const size_t technique_count = ShadowRegistry::get_all().size();
	for (const std::string &name : names) {
		ModuleRegistry::set_enabled(name, false);
		CHECK(fixture.render_image(scene).image.size() == before.image.size());
	}
	CHECK(ShadowRegistry::get_all().empty());
	const RenderResult none = fixture.render_image(scene);
	CHECK(none.plan.is_skipped("Light", "shadow"));
	for (const std::string &name : names) {
		ModuleRegistry::set_enabled(name, true);
	}
	CHECK(ShadowRegistry::get_all().size() == technique_count);
	CHECK(fixture.render_image(scene).image == before.image);
}

TEST_CASE("[GPU][Renderer] a value out of range is reported once and its default is used") {
	RenderFixture fixture;
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		for (const PropertyInfo &property :
				ShadowRegistry::get_light_properties(info.id).get_properties()) {
			if (property.type != PropertyType::INT) {
				continue;
			}
			LightSnapshot light;
			light.name = "Lamp of " + property.name;
			light.properties[property.name] = int64_t(-77);
			CaughtLines log;
			const PropertyValues values =
					resolve_light_properties(light, ShadowRegistry::get_light_properties(info.id));
			resolve_light_properties(light, ShadowRegistry::get_light_properties(info.id));
			CHECK(values.at(property.name) == property.default_value);
			REQUIRE(log.lines.size() == 1);
			CHECK(log.lines[0].find("-77") != std::string::npos);
		}
	}
}

TEST_CASE("[GPU][Renderer] memory does not grow when the scene is replaced") {
	RenderFixture fixture;
	uint64_t used_bytes = 0;
	for (int round = 0; round < 3; ++round) {
		SmallScene scene; // new meshes each time
		fixture.render_image(scene);
		fixture.render_image(scene);
		if (round > 0) {
			CHECK(fixture.device->get_memory_use().used_bytes <= used_bytes + 4096);
		}
		used_bytes = fixture.device->get_memory_use().used_bytes;
	}
}

TEST_CASE("[GPU][Renderer] a mirrored single-sided box has the same mask as the box") {
	RenderFixture fixture;
	SmallScene scene;
	const RenderResult plain = fixture.render_mask(scene, "");
	// A box is its own mirror image.
	scene.box->parent_from_node =
			scene.box->parent_from_node * glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1));
	const RenderResult mirrored = fixture.render_mask(scene, "");
	CHECK(compute_mask_difference(plain, mirrored) < 1e-3);
}

TEST_CASE("[GPU][Renderer] surfaces are within the bounds of the meshes and face the camera") {
	RenderFixture fixture;
	SmallScene scene;
	RenderRequest request;
	request.scene = scene.snap();
	request.size_px = glm::uvec2(48, 32);
	request.mask_light = "Light";
	request.wants_mask = true;
	request.technique_override = ShadowRegistry::get_all().at(0).id;
	CHECK(fixture.renderer->render(request).surfaces.empty());
	request.wants_surfaces = true;
	const RenderResult result = fixture.renderer->render(request);
	REQUIRE(result.surfaces.size() == 48 * 32);
	Bounds bounds;
	for (const InstanceSnapshot &instance : request.scene->instances) {
		bounds.add(instance.bounds_world);
	}
	size_t count = 0;
	for (size_t index = 0; index < result.surfaces.size(); ++index) {
		const SurfacePoint &point = result.surfaces[index];
		CHECK((point.is_valid || result.receiver[index] == 0.0f));
		if (!point.is_valid) {
			continue;
		}
		++count;
		CHECK(glm::length(point.geometric_normal) == doctest::Approx(1.0));
		CHECK(glm::dot(point.geometric_normal, point.position) < 0.0f);
		const glm::dvec3 world = glm::dvec3(point.position) + request.scene->camera.position_world;
		CHECK(glm::all(glm::greaterThan(world, bounds.minimum - 1e-3)));
		CHECK(glm::all(glm::lessThan(world, bounds.maximum + 1e-3)));
	}
	CHECK(count > 48 * 32 / 8);
}

TEST_CASE("[GPU][Renderer] the standard error falls with the samples, the default has none") {
	const ShadowTechniqueInfo *reference = ShadowRegistry::find_reference();
	if (!reference) {
		return; // no technique of this build samples
	}
	RenderFixture fixture;
	SmallScene scene;
	scene.light->properties["light_size"] = 0.5;
	const auto render = [&](int64_t p_samples) {
		scene.light->properties[reference->id + "_samples"] = p_samples;
		return fixture.render_mask(scene, reference->id).standard_error;
	};
	const float rough = render(16);
	const float fine = render(1024);
	CHECK(fine > 0.0f);
	CHECK(rough > 4.0f * fine); // 64 times the samples: about an eighth of the error
	CHECK(fixture.render_mask(scene, ShadowRegistry::find_default()->id).standard_error == 0.0f);
}

TEST_CASE("[GPU][Renderer] without geometry shaders less than 2 % of an image differs") {
	RenderFixture fixture;
	RenderFixture limited("", { &DeviceFeatures::geometry_shader });
	SmallScene scene;
	RenderRequest request;
	request.scene = scene.snap();
	request.size_px = glm::uvec2(64);
	request.wants_image = true;
	request.technique_override = ShadowRegistry::get_all().at(0).id;
	const RenderResult expected = fixture.renderer->render(request);
	const RenderResult found = limited.renderer->render(request);
	REQUIRE(found.image.size() == expected.image.size());
	CHECK(found.plan.to_text().find("normals from depth") != std::string::npos);
	size_t different_count = 0;
	for (size_t byte = 0; byte < found.image.size(); ++byte) {
		different_count += std::abs(int(found.image[byte]) - int(expected.image[byte])) > 2;
	}
	CHECK(different_count < found.image.size() / 50);
}
