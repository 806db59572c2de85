// Levels of detail of cut-outs, chosen for each receiver.

#include "modules/scene/cut_mesh.h"
#include "modules/shadow_edge_count/count_mesh.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include "tests/test_random.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace gnomon;

namespace {

const glm::uvec2 LEVELS_SIZE_PX(192);

/// A round leaf with a radius of 26 of its image's 64 texels. Alpha changes over 5 texels.
Material make_leaf_material() {
	std::vector<uint8_t> texels;
	for (int y = 0; y < 64; ++y) {
		for (int x = 0; x < 64; ++x) {
			const double distance = glm::distance(glm::dvec2(x, y), glm::dvec2(31.5));
			const double alpha = std::clamp(0.5 + 0.2 * (26 - distance), 0.0, 1.0);
			texels.insert(texels.end(), { 255, 255, 255, uint8_t(std::lround(255 * alpha)) });
		}
	}
	Material material;
	material.alpha_mode = AlphaMode::MASK;
	material.base_color_texture.image = make_image("leaf", { 64, 64 }, std::move(texels));
	return material;
}

/// Cuts a mesh of triangles that show the leaf, given three corners each, and converts the result.
CountMesh cut_triangles(const std::vector<glm::vec3> &p_corners) {
	MeshAttributes attributes;
	std::vector<uint32_t> indices;
	for (uint32_t corner = 0; corner < p_corners.size(); ++corner) {
		attributes.uvs[0].emplace_back(corner % 3 == 1 ? 1 : 0, corner % 3 == 2 ? 1 : 0);
		indices.push_back(corner);
	}
	const auto source =
			make_mesh("source", p_corners, {}, std::move(indices), std::move(attributes));
	const CutMesh cut = cut_mesh(source, make_leaf_material());
	REQUIRE(cut.mesh);
	return build_count_mesh(*get_topology(cut.mesh), cut.mesh->source);
}

/// Round leaves above the ground, under a large light.
SmallScene make_leaves(LightType p_type) {
	SmallScene scene(p_type);
	scene.box->surfaces.clear();
	TestRandom random;
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	MeshAttributes attributes;
	for (uint32_t leaf = 0; leaf < 24; ++leaf) {
		const glm::dvec3 middle(
				random.next(-0.6, 0.6), random.next(0.2, 1.3), random.next(-0.6, 0.6));
		const glm::dvec3 along = 0.2 * random.next_unit();
		const glm::dvec3 across =
				0.2 * glm::normalize(glm::cross(along, glm::dvec3(random.next_unit())));
		for (const auto &[u, v] :
				{ std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1) }) {
			positions.emplace_back(middle + (u - 0.5) * along + (v - 0.5) * across);
			attributes.uvs[0].emplace_back(u, v);
		}
		for (const uint32_t corner : { 0u, 1u, 2u, 0u, 2u, 3u }) {
			indices.push_back(4 * leaf + corner);
		}
	}
	MeshInstance3D &tree = add_mesh(scene.scene, "Tree",
			make_mesh("tree", positions, {}, indices, std::move(attributes)), {});
	tree.surfaces[0].material = std::make_shared<const Material>(make_leaf_material());
	scene.light->properties["light_size"] = 0.3;
	scene.light->properties["light_angular_distance"] = 8.0;
	return scene;
}

/// Renders the mask, with or without a coarse level. Without, each caster has only the level that
/// select_casters chooses for the light.
MaskResult render_levels(MaskFixture &r_fixture, const SmallScene &p_scene, bool p_has_levels) {
	auto snapshot = std::make_shared<SceneSnapshot>(*p_scene.snap());
	const LightSnapshot light = snapshot->lights[0];
	if (!p_has_levels) {
		if (const auto selected = snapshot->select_casters(light)) {
			*snapshot = *selected;
		}
		snapshot->instances.edit_all(
				[](InstanceSnapshot &r_instance) { r_instance.caster_levels = nullptr; });
	}
	MaskRequest request;
	request.scene = snapshot;
	request.size_px = LEVELS_SIZE_PX;
	request.technique_override = "edge_count";
	request.light = light.name;
	request.wants_surfaces = true;
	MaskResult result = r_fixture.render(request);
	CHECK(is_valid_mask(result));
	return result;
}

} // namespace

TEST_CASE("[EdgeCount] source parts are connected by edges, whatever their winding") {
	const glm::vec3 low(0, 0, 0);
	const glm::vec3 high(0, 1, 0);
	// Three half cards about an axis, one of them turned over.
	const CountMesh fan = cut_triangles(
			{ low, high, { 1, 0, 0 }, low, high, { -1, 0, 0.5f }, high, low, { -1, 0, -0.5f } });
	REQUIRE(fan.source_parts.size() == 1);
	CHECK(fan.source_parts[0].w > 0.9f); // the radius: the fan is 2 wide
	const CountMesh apart =
			cut_triangles({ low, high, { 1, 0, 0 }, { 5, 0, 0 }, { 5, 1, 0 }, { 6, 0, 0 } });
	REQUIRE(apart.source_parts.size() == 2);
	for (const shader::CountMeshFace &face : apart.faces) {
		CHECK((face.kind & EDGE_COUNT_SOURCE_PART_MASK) < 2);
	}
	CHECK(apart.faces.front().kind != apart.faces.back().kind);
	// Two corners at the same position: the source's topology drops the triangle, which still is a
	// source part.
	CHECK(cut_triangles({ low, low, { 1, 0, 0 } }).source_parts.size() == 1);
}

TEST_CASE("[GPU][EdgeCount] only receivers that see a wide penumbra get coarse outlines") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI }) {
		CAPTURE(std::string(get_light_type_name(type)));
		const SmallScene scene = make_leaves(type);
		const auto snapshot = scene.snap();
		const MaskResult fine = render_levels(fixture, scene, /*p_has_levels=*/false);
		const MaskResult found = render_levels(fixture, scene, /*p_has_levels=*/true);
		REQUIRE(found.receiver == fine.receiver);
		// Receivers high on leaves: the leaves above them are near, so their penumbras are narrow.
		size_t near_count = 0;
		size_t changed_near_count = 0;
		size_t changed_count = 0;
		float max_change = 0;
		for (size_t index = 0; index < found.visibility.size(); ++index) {
			if (found.receiver[index] == 0) {
				continue;
			}
			const double height_m =
					snapshot->camera.position_world.y + found.surfaces[index].position.y;
			const bool is_near = height_m > 0.6;
			const float change = std::abs(found.visibility[index] - fine.visibility[index]);
			max_change = std::max(max_change, change);
			changed_count += change > 0 ? 1 : 0;
			near_count += is_near ? 1 : 0;
			changed_near_count += is_near && change > 0 ? 1 : 0;
		}
		CHECK(changed_count > 200);
		CHECK(max_change < 0.03f);
		CHECK(near_count > 200);
		CHECK(changed_near_count == 0);
	}
}
