// Requirements on every technique, checked for all that are registered.

#include "modules/core/embedded_shaders.h"
#include "modules/core/error.h"
#include "modules/shadows/tests/each_technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <set>

using namespace gnomon;

// Minimum counts of pixels, such as 500 and 30, only show that there are such receivers: images
// have 64 x 64 pixels unless a size is given.

TEST_CASE("[GPU][Techniques] masks are finite, in 0..1, and contain light and shadow") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		const MaskResult result = fixture.render_mask(scene, p_info.id);
		CHECK(is_valid_mask(result));
		size_t lit_count = 0;
		size_t dark_count = 0;
		for (size_t index = 0; index < result.visibility.size(); ++index) {
			lit_count += result.receiver[index] > 0 && result.visibility[index] > 0.95f;
			dark_count += result.receiver[index] > 0 && result.visibility[index] < 0.05f;
		}
		CHECK(lit_count > 500);
		CHECK(dark_count > 30);
	});
}

TEST_CASE(
		"[GPU][Techniques] receivers farther from the light than all casters are hidden by them") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		scene.ground->casts_shadow = false;
		scene.box->parent_from_node[3].y += 0.7; // higher above the ground
		const MaskResult result = fixture.render_mask(scene, p_info.id);
		size_t dark_count = 0;
		for (size_t index = 0; index < result.visibility.size(); ++index) {
			dark_count += result.receiver[index] > 0 && result.visibility[index] < 0.05f;
		}
		CHECK(dark_count > 30);
	});
}

TEST_CASE("[GPU][Techniques] without casters every receiver sees all of the light, exactly") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		scene.ground->casts_shadow = false;
		scene.box->casts_shadow = false;
		const MaskResult result = fixture.render_mask(scene, p_info.id);
		CHECK(count_receivers(result) > 1000);
		CHECK(result.visibility == result.receiver);
	});
}

TEST_CASE("[GPU][Techniques] under a plate that hides the whole light nothing is lit") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		// Some techniques shadow only planar receivers. The ground is one already.
		scene.box->is_planar_receiver = true;
		// Wide, and between the light and everything that the camera sees.
		add_mesh(
				scene.scene, "Plate", make_box_mesh("plate", { 9.0f, 0.02f, 9.0f }), { 0, 3.7, 0 });
		const MaskResult result = fixture.render_mask(scene, p_info.id);
		CHECK(count_receivers(result) > 0);
		for (size_t index = 0; index < result.visibility.size(); ++index) {
			// Below one step of 8 bits, not 0: techniques may round counts of samples at edges.
			CHECK_MESSAGE(result.visibility[index] < 1.0f / 255.0f, "pixel ", index);
			if (result.visibility[index] >= 1.0f / 255.0f) {
				break;
			}
		}
	});
}

TEST_CASE("[GPU][Techniques] faces turned away from the light are receivers on their far side if "
		  "the host lights them") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		scene.ground->is_planar_receiver = false;
		scene.light->parent_from_node = look_at({ 2.4, 2.4, 1.8 }, { 0, 0.3, 0 });
		// It sees two sides of the box and one of a sheet, all turned away from the light.
		scene.camera->parent_from_node = look_at({ -3.0, 1.3, -2.6 }, { -0.3, 0.6, -0.3 });
		add_mesh(scene.scene, "Sheet",
				make_mesh("sheet", { { 0, 0, 0 }, { 0, 0, 1 }, { 0, 1, 1 }, { 0, 1, 0 } }, {},
						{ 0, 1, 2, 0, 2, 3 }),
				{ -1.0, 0.2, -1.8 });
		MaskRequest request;
		request.technique_override = p_info.id;
		request.light = scene.light->name;
		request.scene = scene.snap();
		const MaskResult plain = fixture.render(request);
		auto two_sided = std::make_shared<SceneSnapshot>(*request.scene);
		two_sided->has_far_sides = true;
		request.scene = two_sided;
		const MaskResult both = fixture.render(request);
		CHECK(is_valid_mask(both));
		size_t plain_dark_count = 0;
		size_t changed_count = 0;
		size_t lit_count = 0;
		size_t dark_count = 0;
		for (size_t index = 0; index < both.visibility.size(); ++index) {
			const float visibility = both.visibility[index];
			if (plain.receiver[index] > 0) {
				plain_dark_count += plain.visibility[index] < 0.05f;
				changed_count += std::abs(visibility - plain.visibility[index]) > 0.01f;
			} else if (both.receiver[index] > 0) {
				lit_count += visibility > 0.95f;
				dark_count += visibility < 0.05f;
			}
		}
		CHECK(changed_count <= 4);
		CHECK(lit_count > 50); // the sheet
		// Some techniques shadow only planar receivers.
		CHECK((dark_count > 100 || plain_dark_count == 0)); // the box
	});
}

TEST_CASE("[GPU][Techniques] skipping and caching do not change one bit of the mask") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		scene.ground->casts_shadow = false; // so that some views of the light have no casters
		const MaskResult unskipped =
				fixture.render_mask(scene, p_info.id, glm::uvec2(64), /*p_may_skip=*/false);
		const MaskResult first = fixture.render_mask(scene, p_info.id);
		const MaskResult second = fixture.render_mask(scene, p_info.id); // may fill or use caches
		const MaskResult third = fixture.render_mask(scene, p_info.id);	 // may use all of them
		CHECK(unskipped.visibility == first.visibility);
		CHECK(unskipped.visibility == second.visibility);
		CHECK(unskipped.visibility == third.visibility);
	});
}

TEST_CASE("[GPU][Techniques] very small, very large and distant scenes have nearly the same mask") {
	const double MAX_MEAN_DIFFERENCE = 5e-3; // only rounding may differ
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		const MaskResult result = fixture.render_mask(scene, p_info.id);
		for (double scale : { 1e-3, 1e3 }) {
			SmallScene scaled(p_type, scale);
			use_cheap_settings(*scaled.light);
			CAPTURE(scale);
			CHECK(compute_mask_difference(result, fixture.render_mask(scaled, p_info.id)) <
					MAX_MEAN_DIFFERENCE);
		}
		SmallScene moved(p_type, 1.0, { 1e5, -3e4, 7e4 });
		use_cheap_settings(*moved.light);
		CHECK(compute_mask_difference(result, fixture.render_mask(moved, p_info.id)) <
				MAX_MEAN_DIFFERENCE);
	});
}

TEST_CASE("[GPU][Techniques] a wide sun over 40 km has the penumbra that it has over 4 m") {
	const double MAX_MEAN_DIFFERENCE = 5e-3; // only rounding may differ
	MaskFixture fixture;
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		CAPTURE(p_info.id);
		const auto render = [&](double p_scale) {
			SmallScene scene(LightType::DIRECTIONAL, p_scale);
			use_cheap_settings(*scene.light);
			scene.light->properties["light_angular_distance"] = 60.0; // derived widths: 23 km
			return fixture.render_mask(scene, p_info.id);
		};
		CHECK(compute_mask_difference(render(1.0), render(1e4)) < MAX_MEAN_DIFFERENCE);
	});
}

namespace {

/// An extreme or broken scene.
struct HostileCase {
	const char *name;
	void (*change)(SmallScene &r_scene);
};

const HostileCase HOSTILE_CASES[] = {
	{ "a light without size",
			[](SmallScene &r_scene) {
				r_scene.light->properties["light_size"] = 0.0;
				r_scene.light->properties["light_angular_distance"] = 0.0;
			} },
	{ "a light larger than the scene",
			[](SmallScene &r_scene) {
				r_scene.light->properties["light_size"] = 10.0;
				r_scene.light->properties["light_angular_distance"] = 90.0;
				r_scene.light->properties["penumbra_outer_width"] = 10.0;
			} },
	{ "the light inside the box",
			[](SmallScene &r_scene) {
				r_scene.light->parent_from_node = look_at({ 0, 1.0, 0 }, { 0, 0, 0.01 });
			} },
	{ "the light on the ground",
			[](SmallScene &r_scene) {
				r_scene.light->parent_from_node = look_at({ 1, 0, 0 }, { 0, 0, 0 });
			} },
	{ "the light below everything",
			[](SmallScene &r_scene) {
				r_scene.light->parent_from_node = look_at({ 0, -5, 0 }, { 0, -8, 0.1 });
			} },
	{ "a caster across the light's near plane",
			[](SmallScene &r_scene) {
				add_mesh(r_scene.scene, "Rod", make_box_mesh("rod", { 0.02f, 3.0f, 0.02f }),
						{ 1.2, 3.0, 0.8 });
			} },
	{ "a caster at 100 times the scene's size",
			[](SmallScene &r_scene) {
				add_mesh(r_scene.scene, "Far", make_box_mesh("far", { 200.0f, 1.0f, 200.0f }),
						{ 0, -400, 0 });
			} },
	{ "silhouette edges seen end-on",
			[](SmallScene &r_scene) {
				r_scene.light->parent_from_node =
						glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0),
								glm::dvec4(0, 1, 0, 0), glm::dvec4(0.5, 4, 0.4, 1));
			} },
	{ "widths larger than the casters",
			[](SmallScene &r_scene) {
				r_scene.light->properties["penumbra_outer_width"] = 30.0;
				r_scene.light->properties["penumbra_inner_width"] = 1e4;
			} },
	{ "the light at a corner of the box",
			[](SmallScene &r_scene) {
				r_scene.light->parent_from_node = look_at({ 0.5, 1.3, 0.4 }, { 0, 0, 0 });
			} },
	{ "twelve casters behind each other",
			[](SmallScene &r_scene) {
				for (int plate = 0; plate < 12; ++plate) {
					add_mesh(r_scene.scene, text("Plate ", plate),
							make_box_mesh("plate", { 0.6f, 0.01f, 0.6f }),
							{ 0, 1.4 + 0.1 * plate, 0 });
				}
			} },
	{ "slivers, duplicates, zero area and zero normals",
			[](SmallScene &r_scene) {
				std::vector<glm::vec3> positions = { { 0, 2, 0 }, { 1, 2, 0 }, { 2, 2, 0 },
					{ 0.5f, 2, 1e-7f }, { 0, 2, 0 }, { 0, 2, 1 } };
				add_mesh(r_scene.scene, "Odd",
						make_mesh("odd", positions, std::vector<glm::vec3>(6, glm::vec3(0.0f)),
								{ 0, 1, 2, 0, 1, 3, 0, 0, 0, 0, 4, 5, 0, 1, 5, 0, 1, 5, 5, 1, 0 }),
						{ 0, 0, 0 });
			} },
	{ "coincident receivers and casters",
			[](SmallScene &r_scene) {
				add_mesh(r_scene.scene, "Twin", make_box_mesh("twin", glm::vec3(0.5f, 0.3f, 0.4f)),
						{ 0, 1.0, 0 });
			} },
	{ "a narrow cone", [](SmallScene &r_scene) { r_scene.light->outer_cone_rad = 1e-3f; } },
	{ "a cone of half a sphere",
			[](SmallScene &r_scene) { r_scene.light->outer_cone_rad = 1.5707963f; } }, // pi / 2
};

} // namespace

TEST_CASE("[GPU][Techniques] hostile lights and meshes give masks in 0..1") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		for (const HostileCase &hostile : HOSTILE_CASES) {
			CAPTURE(hostile.name);
			SmallScene scene(p_type);
			use_cheap_settings(*scene.light);
			hostile.change(scene);
			CHECK(is_valid_mask(fixture.render_mask(scene, p_info.id, glm::uvec2(32))));
		}
	});
}

TEST_CASE("[GPU][Techniques] a camera shifted by one pixel gives the same mask one pixel apart") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		scene.light->properties["light_size"] = 0.0;
		scene.light->properties["light_angular_distance"] = 0.0;
		MaskRequest request;
		request.technique_override = p_info.id;
		request.scene = scene.snap();
		const MaskResult plain = fixture.render(request);
		SceneSnapshot snapshot = *request.scene;
		snapshot.camera.shift = 2.0f / glm::vec2(request.size_px); // the image moves left and down
		request.scene = std::make_shared<const SceneSnapshot>(std::move(snapshot));
		const MaskResult shifted = fixture.render(request);
		const uint32_t width = request.size_px.x;
		size_t compared_count = 0;
		size_t different_count = 0;
		for (uint32_t y = 1; y < request.size_px.y; ++y) {
			for (uint32_t x = 0; x + 1 < width; ++x) {
				const size_t to = y * width + x;
				const size_t from = to + 1 - width;
				if (plain.receiver[from] > 0 && shifted.receiver[to] > 0) {
					++compared_count;
					different_count +=
							std::abs(plain.visibility[from] - shifted.visibility[to]) > 0.5f;
				}
			}
		}
		CHECK(compared_count > 1000);
		CHECK(different_count <= 3); // rounding at borders of shadows
	});
}

TEST_CASE("[GPU][Techniques] a camera that sees only the sky gets a mask without receivers") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		scene.camera->parent_from_node = look_at({ 0, 9, 0 }, { 0, 20, 0.1 }); // the sky
		const MaskResult result = fixture.render_mask(scene, p_info.id, glm::uvec2(16));
		CHECK(count_receivers(result) == 0);
		CHECK(is_valid_mask(result));
	});
}

TEST_CASE("[GPU][Techniques] sixty-four lights are drawn in one frame, and change no later mask") {
	MaskFixture fixture;
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		SmallScene scene;
		use_cheap_settings(*scene.light);
		const PropertyValues properties = scene.light->properties;
		for (int index = 1; index < 64; ++index) {
			const double angle_rad = 0.1 * index;
			scene.add_light(text("Light ", index), ALL_TYPES[index % 3],
						 { 2 * std::cos(angle_rad), 3.5, 2 * std::sin(angle_rad) }, { 0, 0, 0 })
					.properties = properties;
		}
		MaskRequest request;
		request.scene = scene.snap();
		request.size_px = glm::uvec2(16);
		request.technique_override = p_info.id;
		CHECK(fixture.render(request).masks.size() == 64);
		// A light's mask does not depend on the lights that were drawn before.
		request.light = "Light 40";
		const MaskResult result = fixture.render(request);
		CHECK(is_valid_mask(result));
		MaskFixture new_fixture; // has drawn no other light
		CHECK(new_fixture.render(request).visibility == result.visibility);
	});
}

TEST_CASE(
		"[GPU][Techniques] a caster scaled to zero thickness casts the shadow of a very thin one") {
	MaskFixture fixture;
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		SmallScene scene;
		use_cheap_settings(*scene.light);
		const glm::dmat4 transform =
				glm::rotate(scene.box->parent_from_node, 0.4, glm::normalize(glm::dvec3(1, 2, 3)));
		std::vector<float> masks[2];
		for (const int thickness : { 0, 1 }) {
			scene.box->parent_from_node =
					glm::scale(transform, glm::dvec3(1.3, 1e-6 * thickness, 0.8));
			const MaskResult result = fixture.render_mask(scene, p_info.id);
			CHECK(is_valid_mask(result));
			masks[thickness] = result.visibility;
		}
		double difference = 0;
		double hidden = 0;
		for (size_t index = 0; index < masks[0].size(); ++index) {
			difference += std::abs(double(masks[0][index]) - masks[1][index]);
			hidden += 1.0 - masks[1][index];
		}
		CHECK(difference < 0.01 * hidden);
	});
}

TEST_CASE("[GPU][Techniques] masks of one pixel and of odd sizes are valid") {
	MaskFixture fixture;
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		SmallScene scene;
		use_cheap_settings(*scene.light);
		CHECK(fixture.render_mask(scene, p_info.id, { 1, 1 }).visibility.size() == 1);
		CHECK(is_valid_mask(fixture.render_mask(scene, p_info.id, { 67, 13 })));
	});
}

TEST_CASE("[Techniques] every shader file exists, every property has a tooltip and a range") {
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		for (const std::string &file : p_info.make()->get_shader_files()) {
			CHECK_FALSE(find_embedded_shader(file).empty());
		}
		for (const PropertyInfo &property :
				ShadowRegistry::get_light_properties(p_info.id).get_properties()) {
			CHECK_MESSAGE(property.tooltip.size() > 10, property.name);
			CHECK_MESSAGE(
					(property.type == PropertyType::BOOL || property.type == PropertyType::STRING ||
							property.hint.find(',') != std::string::npos),
					property.name);
		}
		CHECK_FALSE(p_info.name.empty());
		CHECK_FALSE(p_info.source.empty());
	});
}

TEST_CASE("[GPU][Techniques] a light without widths has the mask of one with the derived widths") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		const auto render = [&](SmallScene &r_scene, const DerivedWidths &p_widths) {
			const double size_m = r_scene.snap()->lights[0].size_m;
			r_scene.light->properties["penumbra_outer_width"] = p_widths.outer_per_size * size_m;
			r_scene.light->properties["penumbra_inner_width"] = p_widths.inner_per_size * size_m;
			return fixture.render_mask(r_scene, p_info.id);
		};
		SmallScene scene(p_type);
		use_cheap_settings(*scene.light);
		const MaskResult derived = fixture.render_mask(scene, p_info.id);
		const MaskResult same = render(scene, p_info.derived_widths);
		CHECK(compute_mask_difference(derived, same) < 1e-4);
		const DerivedWidths size;
		if (p_info.derived_widths.outer_per_size != size.outer_per_size ||
				p_info.derived_widths.inner_per_size != size.inner_per_size) {
			CHECK(compute_mask_difference(derived, render(scene, size)) > 1e-3);
		}
	});
}

TEST_CASE("[Techniques] quality settings name properties that exist, with values in range") {
	LightSnapshot light;
	light.light_size_m = 0.4f;
	light.size_m = 0.4f;
	light.derive_widths({});
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		std::vector<QualitySetting> settings;
		p_info.make()->get_quality_settings(light, settings);
		std::set<std::string> names;
		for (const QualitySetting &setting : settings) {
			CAPTURE(setting.name);
			CHECK(names.insert(setting.name).second);
			for (const auto &[name, value] : setting.properties) {
				const PropertyInfo *property =
						ShadowRegistry::get_light_properties(p_info.id).find(name);
				property = property ? property : Light3D::get_property_list().find(name);
				REQUIRE_MESSAGE(property, name);
				CHECK(check_property(*property, value) == "");
			}
		}
	});
}

TEST_CASE("[Techniques] each technique has its own colour") {
	std::set<std::string> colors;
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		CHECK(p_info.color.size() == 7);
		CHECK(p_info.color.find_first_not_of("0123456789abcdef", 1) == std::string::npos);
		CHECK(p_info.color[0] == '#');
		CHECK(colors.insert(p_info.color).second);
	});
}
