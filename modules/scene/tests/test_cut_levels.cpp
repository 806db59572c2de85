#include "modules/scene/cut_levels.h"
#include "modules/scene/cut_mesh.h"
#include "modules/scene/scene_snapshot.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

using namespace gnomon;

namespace {

const uint32_t IMAGE_SIZE_PX = 64;

/// A disc that covers half of its image.
std::shared_ptr<const Material> make_disc_material() {
	std::vector<uint8_t> texels;
	for (uint32_t y = 0; y < IMAGE_SIZE_PX; ++y) {
		for (uint32_t x = 0; x < IMAGE_SIZE_PX; ++x) {
			const glm::dvec2 position = (glm::dvec2(x, y) + 0.5) / double(IMAGE_SIZE_PX) - 0.5;
			const double distance_outside =
					glm::length(position) - std::sqrt(0.5 / 3.141592653589793);
			// Falls from 1 to 0 over four texels.
			const double alpha =
					std::clamp(0.5 - distance_outside * IMAGE_SIZE_PX * 0.25, 0.0, 1.0);
			texels.insert(texels.end(), { 255, 255, 255, static_cast<uint8_t>(alpha * 255) });
		}
	}
	auto material = std::make_shared<Material>();
	material->alpha_mode = AlphaMode::MASK;
	material->base_color_texture.image =
			make_image("disc", glm::uvec2(IMAGE_SIZE_PX), std::move(texels));
	return material;
}

/// A card of one square metre perpendicular to z, which shows p_repeats x p_repeats tiles.
std::shared_ptr<const Mesh> make_card(float p_repeats) {
	MeshAttributes attributes;
	attributes.uvs[0] = { { 0, 0 }, { p_repeats, 0 }, { p_repeats, p_repeats }, { 0, p_repeats } };
	return make_mesh("card", { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }, {},
			{ 0, 1, 2, 0, 2, 3 }, attributes);
}

double compute_levels_area(const Mesh &p_mesh) {
	double area = 0;
	for (size_t i = 0; i < p_mesh.indices.size(); i += 3) {
		const glm::dvec3 a(p_mesh.positions_node[p_mesh.indices[i]]);
		const glm::dvec3 b(p_mesh.positions_node[p_mesh.indices[i + 1]]);
		const glm::dvec3 c(p_mesh.positions_node[p_mesh.indices[i + 2]]);
		area += glm::length(glm::cross(b - a, c - a)) / 2;
	}
	return area;
}

/// A card two metres above a ground.
SceneSnapshot make_scene(const std::shared_ptr<const Mesh> &p_card) {
	SceneSnapshot scene;
	const glm::dmat4 card = glm::translate(glm::dmat4(1.0), glm::dvec3(-0.5, -0.5, 2.0));
	scene.instances.push_back(make_instance(p_card, make_disc_material(), card, "Card"));
	const glm::dmat4 ground = glm::translate(
			glm::scale(glm::dmat4(1.0), glm::dvec3(8.0, 8.0, 1.0)), glm::dvec3(-0.5, -0.5, 0.0));
	scene.instances.push_back(make_instance(make_card(1), nullptr, ground, "Ground"));
	return scene;
}

/// Makes a light that shines down from four metres above the ground. p_size: its radius, or the
/// tangent of half its angular size.
LightSnapshot make_light(LightType p_type, float p_size) {
	LightSnapshot light;
	light.type = p_type;
	light.position_world = glm::dvec3(0, 0, 4);
	light.light_size_m = p_size;
	light.light_angular_distance_deg = glm::degrees(2 * std::atan(p_size));
	return light;
}

} // namespace

TEST_CASE("[CutLevels] coarser outlines have fewer edges and as much area") {
	const auto card = make_card(1);
	const CutMesh cut = get_cut_mesh(card, make_disc_material());
	REQUIRE(cut.levels);
	CHECK(cut.levels->get_mesh(CutLevels::BASE_LEVEL) == cut.mesh);
	uint32_t finer_count = 1u << 30;
	for (uint32_t level = 0; level < CutLevels::TOLERANCES_PX.size(); ++level) {
		CAPTURE(level);
		const auto mesh = cut.levels->get_mesh(level);
		REQUIRE(mesh);
		CHECK(mesh == cut.levels->get_mesh(level));
		CHECK(mesh->get_triangle_count() < finer_count);
		finer_count = mesh->get_triangle_count();
		CHECK(compute_levels_area(*mesh) == doctest::Approx(0.5).epsilon(0.002));
	}
	CHECK(finer_count < 30); // the coarsest level
}

TEST_CASE("[CutLevels] a wider penumbra gets a coarser level, a hard shadow the base level") {
	const CutLevels &levels = *get_cut_mesh(make_card(1), make_disc_material()).levels;
	CHECK(levels.choose_level(0) == CutLevels::BASE_LEVEL);
	CHECK(levels.choose_level(1e-9) == 0);
	// Never coarser: a receiver that touches its caster has a narrow penumbra under any light.
	CHECK(CutLevels::TOLERANCES_PX[levels.choose_level(1e9)] == 0.25);
	uint32_t before = 0;
	for (double half_width = 0.01; half_width < 10; half_width *= 1.2) {
		const uint32_t level = levels.choose_level(half_width);
		CHECK(level >= before);
		// 1/80 where a level qualifies; at 0.01 m none does, and the finest has 1/20.5.
		CHECK(CutLevels::TOLERANCES_PX[level] / IMAGE_SIZE_PX < half_width / 20);
		before = level;
	}
	// Texels are a third as large with three repeats, so an equal choice would need a third of the
	// half width; but the error of a texture that repeats does not average out.
	const CutLevels &repeated = *get_cut_mesh(make_card(3), make_disc_material()).levels;
	CHECK(repeated.choose_level(0.1) < levels.choose_level(0.3));
}

TEST_CASE("[CutLevels] a wide penumbra gets a second, coarse level for the receivers that see it") {
	const CutLevels &levels = *get_cut_mesh(make_card(1), make_disc_material()).levels;
	const uint32_t last = static_cast<uint32_t>(CutLevels::TOLERANCES_PX.size()) - 1;
	CHECK(levels.choose_coarse_level(3, 1e-9) == 3);
	CHECK(levels.choose_coarse_level(3, 1e9) == last);
	CHECK(levels.choose_coarse_level(last, 1e9) == last);
	CHECK(levels.choose_coarse_level(last - 1, 1e9) == last - 1); // one level is not worth it
	size_t coarse_count = 0;
	for (double half_width = 0.001; half_width < 10; half_width *= 1.2) {
		const uint32_t level = levels.choose_level(half_width);
		const uint32_t coarse = levels.choose_coarse_level(level, half_width);
		CHECK((coarse == level || coarse >= level + 2));
		if (coarse > level) {
			++coarse_count;
			CHECK(levels.get_min_half_width(coarse) < half_width);
			CHECK(levels.get_min_half_width(coarse) >= 4 * levels.get_min_half_width(level));
		}
	}
	CHECK(coarse_count > 5); // the checks above were not skipped
}

TEST_CASE("[CutLevels] a larger light gets coarser outlines") {
	const auto card = make_card(1);
	const SceneSnapshot scene = make_scene(card);
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		CAPTURE(int(type));
		size_t finer_count = 1u << 30;
		const float middle = type == LightType::DIRECTIONAL ? 0.06f : 0.2f;
		for (const float size : { 0.02f, middle, 2.0f }) {
			const auto selected = scene.select_casters(make_light(type, size));
			const InstanceSnapshot &instance = (selected ? *selected : scene).instances[0];
			CHECK(instance.mesh == card);
			CHECK(instance.caster_mesh->indices.size() < finer_count);
			finer_count = instance.caster_mesh->indices.size();
		}
		CHECK_FALSE(scene.select_casters(make_light(type, 0)));
	}
}

TEST_CASE("[CutLevels] the widest penumbra is that on the farthest receiver") {
	Bounds caster;
	caster.add(glm::dvec3(0, 0, 2));
	Bounds bounds = caster;
	bounds.add(glm::dvec3(-4, -4, 0));
	bounds.add(glm::dvec3(4, 4, 3));
	// The caster is halfway between light and ground.
	CHECK(make_light(LightType::SPOT, 0.3f).compute_max_penumbra_half_width(caster, bounds) ==
			doctest::Approx(0.15));
	CHECK(make_light(LightType::DIRECTIONAL, 0.1f)
					.compute_max_penumbra_half_width(caster, bounds) == doctest::Approx(0.2));
	CHECK(make_light(LightType::OMNI, 0).compute_max_penumbra_half_width(caster, bounds) == 0);
	// A caster at the light's position, and a scene without a receiver behind the caster.
	LightSnapshot light = make_light(LightType::OMNI, 0.3f);
	light.position_world = glm::dvec3(0, 0, 2);
	CHECK(light.compute_max_penumbra_half_width(caster, bounds) <= 0.3f);
	CHECK(light.compute_max_penumbra_half_width(caster, caster) == 0);
}
