#include "modules/editor/scene_rays.h"
#include "modules/scene/box_mesh.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

using namespace gnomon;

namespace {

/// A card of two by two metres in the plane z = 0, whose left half is there.
std::unique_ptr<MeshInstance3D> make_half_card(AlphaMode p_mode) {
	const std::vector<glm::vec3> positions = { { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 },
		{ -1, 1, 0 } };
	MeshAttributes attributes;
	attributes.uvs[0] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
	auto material = std::make_shared<Material>();
	material->alpha_mode = p_mode;
	material->base_color_texture.image =
			make_image("half", { 2, 1 }, { 255, 255, 255, 255, 255, 255, 255, 0 });
	material->base_color_texture.wrap_u = TextureWrap::CLAMP;
	auto card = std::make_unique<MeshInstance3D>();
	card->name = "Card";
	card->surfaces.push_back(
			{ make_mesh("card", positions, {}, { 0, 1, 2, 0, 2, 3 }, attributes), material });
	return card;
}

std::string pick(SceneRays &r_rays, double p_x) {
	const auto hit = r_rays.find_nearest(glm::dvec3(p_x, 0.25, 5), glm::dvec3(0, 0, -1));
	return hit ? hit->instance->node->name : "";
}

} // namespace

TEST_CASE("[SceneRays] a ray through a hole picks what is behind it") {
	for (const AlphaMode mode : { AlphaMode::MASK, AlphaMode::OPAQUE }) {
		Scene scene;
		scene.root->add_child(make_half_card(mode));
		auto wall = std::make_unique<MeshInstance3D>();
		wall->name = "Wall";
		wall->surfaces.push_back(
				{ make_box_mesh("wall", glm::vec3(4, 4, 0.1f)), std::make_shared<Material>() });
		wall->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -2));
		scene.root->add_child(std::move(wall));
		SceneRays rays;
		rays.follow(scene);
		CHECK(pick(rays, -0.5) == "Card");
		CHECK(pick(rays, 0.5) == (mode == AlphaMode::MASK ? "Wall" : "Card"));
		CHECK(pick(rays, 2.0) == "Wall");
		CHECK(pick(rays, 9.0) == "");
	}
}
