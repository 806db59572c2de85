// Meshes with faces below float precision.

#include "modules/mesh_tools/tests/sliver_meshes.h"
#include "modules/shadow_edge_count/tests/edge_count_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Disables the receivers of which the two frames see different surfaces: slivers may move the
/// receiver's own surface, and change which face covers a pixel at the outline of another one.
void keep_equal_surfaces(const MaskResult &p_frame, MaskResult &r_reference) {
	for (size_t index = 0; index < r_reference.receiver.size(); ++index) {
		const SurfacePoint &point = p_frame.surfaces[index];
		const SurfacePoint &reference = r_reference.surfaces[index];
		const bool is_equal = glm::distance(point.position, reference.position) < 1e-6f &&
				glm::dot(point.geometric_normal, reference.geometric_normal) > 0.999f;
		r_reference.receiver[index] *= is_equal ? 1.0f : 0.0f;
	}
}

} // namespace

TEST_CASE("[GPU][EdgeCount] slivers in a mesh do not change its mask") {
	TestRandom random;
	MaskFixture fixture;
	const FrameOptions options = { .size_px = glm::uvec2(72), .wants_surfaces = true };
	const auto box = make_box_mesh("box", { 0.9f, 0.05f, 0.6f });
	for (const LightType type : { LightType::SPOT, LightType::DIRECTIONAL, LightType::OMNI }) {
		CAPTURE(std::string(get_light_type_name(type)));
		// Beyond 1.8 rad the sun's disc crosses the plane of a side of the box that the camera
		// sees.
		for (const double angle_rad : { 0.4, 1.9, 2.0, 2.1 }) {
			CAPTURE(angle_rad);
			SmallScene scene(type);
			scene.light->properties["light_size"] = 0.8;
			scene.light->properties["light_angular_distance"] = 24.0;
			scene.box->parent_from_node = scene.box->parent_from_node *
					glm::rotate(glm::dmat4(1.0), angle_rad, glm::dvec3(0.3, 1.0, -0.2));
			const auto render = [&](const std::shared_ptr<const Mesh> &p_mesh) {
				scene.box->surfaces[0].mesh = p_mesh;
				return render_frame(fixture, scene, options);
			};
			const MaskResult clean = render(box);
			for (const double height : { 0.0, 1e-9, 5e-8, 1e-7, 2e-7, 1e-5 }) {
				CAPTURE(height);
				std::vector<glm::vec3> positions = box->positions_node;
				std::vector<uint32_t> indices = box->indices;
				test_meshes::add_slivers(12, height, random, positions, indices);
				const MaskResult with_slivers =
						render(make_mesh("box with slivers", positions, {}, indices));
				MaskResult reference = clean;
				keep_equal_surfaces(with_slivers, reference);
				const MaskDifference difference = compare_masks(with_slivers.visibility, reference);
				CHECK(difference.receiver_count > 1000);
				CHECK(difference.penumbra_mean < 0.001);
				CHECK(difference.maximum < (height > 1e-6 ? 0.05 : 0.02));
			}
		}
	}
}
