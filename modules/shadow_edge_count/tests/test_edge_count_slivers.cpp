// Meshes with faces below float precision.

#include "modules/mesh_tools/tests/sliver_meshes.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

TEST_CASE("[GPU][EdgeCount] slivers in a mesh do not change its mask") {
	TestRandom random;
	MaskFixture fixture;
	const auto box = make_box_mesh("box", { 0.9f, 0.05f, 0.6f });
	for (const LightType type : { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI }) {
		CAPTURE(std::string(get_light_type_name(type)));
		SmallScene scene(type);
		scene.light->properties["light_size"] = 0.8;
		scene.light->properties["light_angular_distance"] = 24.0;
		scene.box->parent_from_node = scene.box->parent_from_node *
				glm::rotate(glm::dmat4(1.0), 0.4, glm::dvec3(0.3, 1.0, -0.2));
		const auto render = [&](const std::shared_ptr<const Mesh> &p_mesh) {
			scene.box->surfaces[0].mesh = p_mesh;
			return render_frame(fixture, scene, { .size_px = glm::uvec2(72) });
		};
		const MaskResult clean = render(box);
		for (const double height : { 0.0, 1e-9, 1e-7, 1e-5 }) {
			CAPTURE(height);
			std::vector<glm::vec3> positions = box->positions_node;
			std::vector<uint32_t> indices = box->indices;
			test_meshes::add_slivers(12, height, random, positions, indices);
			const MaskResult with_slivers =
					render(make_mesh("box with slivers", positions, {}, indices));
			const MaskDifference difference = compare_masks(with_slivers.visibility, clean);
			CHECK(difference.receiver_count > 1000);
			CHECK(difference.penumbra_mean < 0.001);
			CHECK(difference.maximum < 0.05);
		}
	}
}
