#include "modules/shadows/tests/mask_fixture.h"
#include "modules/shadows/translucent_casters.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

using namespace gnomon;

namespace {

std::shared_ptr<const Material> make_glass(const glm::vec3 &p_color, float p_transmission = 1.0f) {
	auto material = std::make_shared<Material>();
	material->base_color = p_color;
	material->transmission = p_transmission;
	return material;
}

const glm::vec3 RED(0.9f, 0.25f, 0.125f);
const glm::vec3 BLUE(0.125f, 0.5f, 0.75f);

TranslucentCasters find_casters(const SmallScene &p_scene) {
	const auto snapshot = p_scene.snap();
	return find_translucent_casters(*snapshot, snapshot->lights[0]);
}

/// Adds a thin horizontal pane.
MeshInstance3D &add_pane(SmallScene &r_scene, const std::string &p_name, const glm::vec3 &p_color,
		const glm::dvec3 &p_position) {
	MeshInstance3D &pane = add_mesh(
			r_scene.scene, p_name, make_box_mesh(p_name, glm::vec3(0.4f, 0.02f, 0.4f)), p_position);
	pane.surfaces[0].material = make_glass(p_color);
	return pane;
}

std::vector<std::string> list_technique_ids() {
	std::vector<std::string> ids;
	for (const ShadowTechniqueInfo &info : ShadowRegistry::get_all()) {
		ids.push_back(info.id);
	}
	return ids;
}

} // namespace

TEST_CASE("[TranslucentCasters] casters of one colour share a group when no ray hits two of them") {
	SmallScene scene;
	CHECK(find_casters(scene).is_empty());
	scene.box->surfaces[0].material = make_glass(RED);
	CHECK(find_casters(scene).groups.size() == 1);
	add_pane(scene, "Near", RED, { 2.9, 0.6, -2.4 });
	REQUIRE(find_casters(scene).groups.size() == 1);
	CHECK(find_casters(scene).groups[0].instances.size() == 2);
	CHECK(find_casters(scene).groups[0].transmittance == RED);
	MeshInstance3D &behind = add_pane(scene, "Behind", RED, { -0.2, 0.3, -0.2 });
	CHECK(find_casters(scene).groups.size() == 2);
	behind.surfaces[0].material = make_glass(BLUE);
	CHECK(find_casters(scene).groups.size() == 2);
	behind.casts_shadow = false;
	CHECK(find_casters(scene).groups.size() == 1);
	behind.casts_shadow = true;
	behind.surfaces[0].material = make_glass(glm::vec3(1.0f)); // casts no shadow
	CHECK(find_casters(scene).groups.size() == 1);
	CHECK_FALSE(find_casters(scene).is_empty());
}

TEST_CASE("[TranslucentCasters] casters around the light or with overlapping shadows share no "
		  "group") {
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		CAPTURE(get_light_type_name(type));
		SmallScene scene(type);
		scene.box->surfaces[0].material = make_glass(RED);
		const bool has_position = type != LightType::DIRECTIONAL;
		add_pane(scene, "Far", RED,
				has_position ? glm::dvec3(2.9, 0.6, -2.4) : glm::dvec3(1.9, 0.6, -1.2));
		CHECK(find_casters(scene).groups.size() == 1);
		scene.light->properties["light_size"] = 3.0; // so wide that the shadows overlap
		scene.light->properties["light_angular_distance"] = 90.0;
		CHECK(find_casters(scene).groups.size() == 2);
	}
	SmallScene scene(LightType::OMNI);
	scene.box->surfaces[0].material = make_glass(RED);
	MeshInstance3D &lamp = add_pane(scene, "Lamp", RED, { 1.2, 4.0, 0.8 }); // around the light
	CHECK(find_casters(scene).groups.size() == 2);
	// In front of the light, so near that its shadow's cone is wide.
	lamp.parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 3.7, 0.6));
	CHECK(find_casters(scene).groups.size() == 2);
}

TEST_CASE("[TranslucentCasters] casters far apart along a directional light may share a ray") {
	SmallScene scene(LightType::DIRECTIONAL);
	scene.light->parent_from_node = look_at({ 0, 50, 0 }, { 0, 0, 0 });
	scene.light->properties["light_angular_distance"] = 10.0;
	scene.box->surfaces[0].material = make_glass(RED);
	add_pane(scene, "Near", RED, { 2.4, 1.0, 0.0 });
	CHECK(find_casters(scene).groups.size() == 1);
	MeshInstance3D &above = add_pane(scene, "Above", RED, { 2.4, 21.0, 0.0 });
	CHECK(find_casters(scene).groups.size() == 2); // although the scene size is only 4 m
	above.parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(-6.0, 21.0, 0.0));
	CHECK(find_casters(scene).groups.size() == 1);
}

TEST_CASE("[TranslucentCasters] beyond the maximum group count, casters join the nearest colour") {
	SmallScene scene;
	for (int i = 0; i < 12; ++i) { // from dark to light
		add_pane(scene, "Pane " + std::to_string(i), glm::vec3(0.05f + 0.07f * float(i)),
				{ 0.0, 0.2 + 0.1 * i, 0.0 });
	}
	const TranslucentCasters casters = find_casters(scene);
	CHECK(casters.groups.size() == TranslucentCasters::MAX_GROUP_COUNT);
	CHECK(casters.merged_count == 4);
	// The four lightest are nearest to the eighth, the last one that has got a group of its own.
	CHECK(casters.groups.back().instances.size() == 5);
}

TEST_CASE("[TranslucentCasters] transmittance is in 0..1, and 0 where the material has NaN") {
	const float nan = std::numeric_limits<float>::quiet_NaN();
	Material material = *make_glass(RED, nan);
	CHECK(material.compute_transmittance(/*p_scale=*/1.0f) == glm::vec3(0.0f));
	material = *make_glass(glm::vec3(nan, 0.5f, 2.0f));
	CHECK(material.compute_transmittance(/*p_scale=*/1.0f) == glm::vec3(0.0f, 0.5f, 1.0f));
	material.thickness_m = 1e4f;
	material.attenuation_distance_m = 1e-6f;
	material.attenuation_color = glm::vec3(0.0f, 0.5f, 1.0f);
	CHECK(material.compute_transmittance(/*p_scale=*/1.0f) == glm::vec3(0.0f, 0.0f, 1.0f));
}

TEST_CASE("[GPU][TranslucentCasters] every technique's shadow gets the caster's colour") {
	MaskFixture fixture;
	SmallScene opaque;
	SmallScene glass;
	glass.box->surfaces[0].material = make_glass(RED);
	SmallScene empty;
	empty.box->casts_shadow = false;
	for (const std::string &id : list_technique_ids()) {
		CAPTURE(id);
		const MaskResult hidden = fixture.render_mask(opaque, id);
		const MaskResult open = fixture.render_mask(empty, id);
		const MaskResult tinted = fixture.render_mask(glass, id);
		CHECK(hidden.colors.empty());
		REQUIRE(tinted.colors.size() == tinted.visibility.size());
		CHECK(is_valid_mask(tinted));
		float worst = 0;
		size_t dark_count = 0;
		for (size_t index = 0; index < tinted.colors.size(); ++index) {
			const float before = open.visibility[index];
			const float fraction = before > 0
					? std::clamp(1.0f - hidden.visibility[index] / before, 0.0f, 1.0f)
					: 0.0f;
			const glm::vec3 expected = before * (1.0f - fraction * (1.0f - RED));
			const glm::vec3 difference = glm::abs(tinted.colors[index] - expected);
			worst = std::max({ worst, difference.x, difference.y, difference.z });
			dark_count += fraction > 0.9f;
		}
		CHECK(worst < 0.002f); // half floats; the reference's own rounding
		CHECK(dark_count > 20);
	}
}

TEST_CASE("[GPU][TranslucentCasters] light through two panes gets both colours, as ray tracing "
		  "does") {
	const ShadowTechniqueInfo *reference = ShadowRegistry::find_reference();
	REQUIRE(reference != nullptr);
	MaskFixture fixture;
	SmallScene scene;
	scene.scene.root->remove_child(*scene.box);
	scene.light->properties["light_size"] = 0.0;
	add_pane(scene, "Upper", RED, { 0.65, 1.6, 0.0 });
	add_pane(scene, "Lower", BLUE, { 0.1, 0.8, -0.4 });
	const MaskResult expected = fixture.render_mask(scene, reference->id, glm::uvec2(96));
	const MaskResult result =
			fixture.render_mask(scene, ShadowRegistry::find_default()->id, glm::uvec2(96));
	// Of light that passes no pane, the upper one, the lower one, and both.
	const std::vector<glm::vec3> shades = { glm::vec3(1.0f), RED, BLUE, RED * BLUE };
	std::vector<size_t> counts(shades.size());
	size_t differing_count = 0;
	for (size_t index = 0; index < expected.colors.size(); ++index) {
		if (expected.receiver[index] == 0) {
			continue;
		}
		size_t nearest = 0;
		for (size_t shade = 1; shade < shades.size(); ++shade) {
			nearest = glm::distance(expected.colors[index], shades[shade]) <
							glm::distance(expected.colors[index], shades[nearest])
					? shade
					: nearest;
		}
		CHECK(glm::distance(expected.colors[index], shades[nearest]) < 1e-5f);
		++counts[nearest];
		differing_count += glm::distance(result.colors[index], expected.colors[index]) > 0.01f;
	}
	for (const size_t count : counts) {
		CHECK(count > 30);
	}
	CHECK(differing_count < 20); // of thousands: pixels at the shadows' edges
	CHECK_FALSE(result.plan.is_skipped("Light", "translucent 2: light view 0"));
}

TEST_CASE("[GPU][TranslucentCasters] a soft coloured shadow matches the reference") {
	const ShadowTechniqueInfo *reference = ShadowRegistry::find_reference();
	REQUIRE(reference != nullptr);
	MaskFixture fixture;
	SmallScene scene;
	scene.light->properties["light_size"] = 0.4;
	scene.box->surfaces[0].material = make_glass(BLUE);
	add_pane(scene, "Upper", RED, { 0.3, 1.9, 0.3 });
	const auto opaque_mesh = make_box_mesh("Post", glm::vec3(0.1f, 0.6f, 0.1f));
	add_mesh(scene.scene, "Post", opaque_mesh, { 0.7, 0.6, -0.3 });
	const MaskResult expected = fixture.render_mask(scene, reference->id);
	const MaskResult result = fixture.render_mask(scene, ShadowRegistry::find_default()->id);
	double error = 0;
	size_t count = 0;
	for (size_t index = 0; index < expected.colors.size(); ++index) {
		if (expected.receiver[index] > 0) {
			error += glm::length(expected.colors[index] - result.colors[index]);
			++count;
		}
	}
	REQUIRE(count > 0);
	CHECK(error / double(count) < 0.004);
	CHECK(expected.standard_error > 0);
}

TEST_CASE("[GPU][TranslucentCasters] adding and removing glass does not change opaque frames") {
	MaskFixture fixture;
	SmallScene scene;
	const std::string id = ShadowRegistry::find_default()->id;
	const MaskResult before = fixture.render_mask(scene, id);
	const auto material = scene.box->surfaces[0].material;
	for (int round = 0; round < 2; ++round) {
		scene.box->surfaces[0].material = make_glass(RED);
		const MaskResult glass = fixture.render_mask(scene, id);
		CHECK_FALSE(glass.colors.empty());
		CHECK(fixture.render_mask(scene, id).colors == glass.colors);
		scene.box->surfaces[0].material = material;
		const MaskResult again = fixture.render_mask(scene, id);
		CHECK(again.colors.empty());
		CHECK(again.visibility == before.visibility);
	}
	// The passes that are skipped would not change the mask.
	scene.box->surfaces[0].material = make_glass(RED);
	CHECK(fixture.render_mask(scene, id).colors ==
			fixture.render_mask(scene, id, glm::uvec2(64), /*p_may_skip=*/false).colors);
}

TEST_CASE("[GPU][TranslucentCasters] a translucent receiver spreads coloured light") {
	MaskFixture fixture;
	SmallScene scene;
	const std::string id = ShadowRegistry::find_default()->id;
	scene.light->properties["light_size"] = 0.0;
	scene.box->surfaces[0].material = make_glass(RED);
	const MaskResult sharp = fixture.render_mask(scene, id);
	auto wax = std::make_shared<Material>();
	wax->scatter = 1.0f;
	wax->scatter_distance_m = 0.5f;
	scene.ground->surfaces[0].material = wax;
	const MaskResult soft = fixture.render_mask(scene, id);
	REQUIRE(soft.colors.size() == sharp.colors.size());
	size_t between_count = 0;
	for (size_t index = 0; index < soft.colors.size(); ++index) {
		const glm::vec3 color = soft.colors[index];
		between_count += color.z > 0.2f && color.z < 0.9f;
		if (soft.receiver[index] > 0) {
			// The colour is between the glass's colour and white.
			const float fraction = (color.z - RED.z) / (1.0f - RED.z);
			CHECK(glm::distance(color, glm::mix(RED, glm::vec3(1.0f), fraction)) < 0.01f);
		}
	}
	CHECK(between_count > 50);
}
