#include "modules/mesh_tools/tests/test_meshes.h"
#include "modules/shadow_penumbra_fins/tests/fins_fixture.h"
#include "modules/shadows/tests/setting_scope.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Makes horizontal squares, one per height, each of which covers the light's whole view.
std::shared_ptr<const Mesh> make_squares(const std::vector<float> &p_heights_m) {
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	for (float height_m : p_heights_m) {
		const uint32_t first = static_cast<uint32_t>(positions.size());
		for (const glm::vec2 corner :
				{ glm::vec2(-1, -1), glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1) }) {
			positions.emplace_back(50.0f * corner.x, height_m, 50.0f * corner.y);
		}
		for (uint32_t offset : { 0u, 1u, 2u, 0u, 2u, 3u }) {
			indices.push_back(first + offset);
		}
	}
	return make_mesh("squares", positions, {}, indices);
}

/// Makes a scene of p_mesh alone (may be null), with a light at y = 4 m that looks almost straight
/// down.
SmallScene make_layer_scene(const std::shared_ptr<const Mesh> &p_mesh, LightType p_type) {
	SmallScene scene(p_type);
	scene.ground->surfaces.clear();
	scene.box->surfaces.clear();
	if (p_mesh) {
		add_mesh(scene.scene, "Mesh", p_mesh, { 0, 0, 0 });
	}
	scene.light->parent_from_node = look_at({ 0, 4, 0 }, { 0, 0, 0.001 });
	return scene;
}

} // namespace

TEST_CASE("[GPU][PenumbraFins] the three nearest of five squares are the layers, equal ones count "
		  "once") {
	FinsFixture fixture;
	// Squares at 3, 2 (twice), 1, 0 and -1 m: 1, 2, 3, 4, 5 m below the light.
	SmallScene scene = make_layer_scene(make_squares({ -1, 1, 3, 2, 0, 2 }), LightType::SPOT);
	// Exactly straight down, so that a square has the same depth at all texels.
	scene.light->parent_from_node = glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0),
			glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 4, 0, 1));
	const FinsFixture::Frame frame = fixture.make_frame(scene, 64);
	for (Peeling peeling : { Peeling::PASSES, Peeling::ONE_PASS }) {
		const auto layers = fixture.find_layers(frame, 3, peeling)[0];
		for (size_t texel = 0; texel < layers[0].size(); ++texel) {
			for (uint32_t layer = 0; layer < 3; ++layer) {
				const double expected = double(frame.views[0].near_m) / (layer + 1); // near / z
				CHECK(layers[layer][texel] == doctest::Approx(expected).epsilon(1e-5));
			}
		}
	}
}

TEST_CASE("[GPU][PenumbraFins] layers are sorted, and one pass finds the same as three passes, bit "
		  "for bit") {
	FinsFixture fixture;
	using namespace test_meshes;
	const std::pair<const char *, Mesh> meshes[] = { { "torus", make_torus(60, 30) },
		{ "moebius band", make_moebius(40) }, { "soup", make_soup(7, 20, 60) },
		{ "nested spheres", join(make_sphere(3), make_sphere(4)) } };
	for (const auto &[name, mesh] : meshes) {
		for (LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
			CAPTURE(name);
			SmallScene scene =
					make_layer_scene(make_mesh(name, mesh.positions_node, {}, mesh.indices), type);
			const FinsFixture::Frame frame = fixture.make_frame(scene, 128);
			const auto peeled = fixture.find_layers(frame, 3, Peeling::PASSES);
			CHECK(peeled == fixture.find_layers(frame, 3, Peeling::ONE_PASS));
			size_t filled_count = 0;
			bool is_sorted = true;
			for (const auto &layers : peeled) {
				for (size_t texel = 0; texel < layers[0].size(); ++texel) {
					for (uint32_t layer = 1; layer < 3; ++layer) {
						const float nearer = layers[layer - 1][texel];
						const float here = layers[layer][texel];
						filled_count += here > 0;
						is_sorted = is_sorted && (here < nearer || (here == 0 && nearer == 0));
					}
				}
			}
			CHECK(is_sorted);
			CHECK(filled_count > 100); // layers 2 and 3 are not empty
		}
	}
}

TEST_CASE("[GPU][PenumbraFins] a scene with one layer has two empty ones, peeled or not") {
	FinsFixture fixture;
	const SmallScene scene = make_layer_scene(make_squares({ 1 }), LightType::SPOT);
	const FinsFixture::Frame frame = fixture.make_frame(scene, 32);
	for (Peeling peeling : { Peeling::PASSES, Peeling::ONE_PASS }) {
		const auto layers = fixture.find_layers(frame, 3, peeling)[0];
		CHECK(layers[0][0] > 0);
		CHECK(layers[1] == std::vector<float>(32 * 32, 0.0f));
		CHECK(layers[2] == std::vector<float>(32 * 32, 0.0f));
	}
}

TEST_CASE("[GPU][PenumbraFins] casters across the light's near plane are clamped to depths in "
		  "0..1, with both peelings alike") {
	FinsFixture fixture;
	SmallScene scene =
			make_layer_scene(make_box_mesh("rod", { 0.5f, 4.5f, 0.5f }), LightType::SPOT);
	const FinsFixture::Frame frame = fixture.make_frame(scene, 32); // the light is inside the rod
	const auto peeled = fixture.find_layers(frame, 3, Peeling::PASSES);
	CHECK(peeled == fixture.find_layers(frame, 3, Peeling::ONE_PASS));
	for (const std::vector<float> &layer : peeled[0]) {
		for (float depth : layer) {
			CHECK_MESSAGE((depth >= 0.0f && depth <= 1.0f), depth);
		}
	}
}

TEST_CASE("[GPU][PenumbraFins] the plan reports a layer 3 that is drawn only if layer 2 is not "
		  "empty, and the mask stays the same") {
	MaskFixture fixture;
	const auto is_conditional = [&](const SmallScene &p_scene) {
		const MaskResult lean = fixture.render_mask(p_scene, "penumbra_fins");
		const MaskResult all =
				fixture.render_mask(p_scene, "penumbra_fins", glm::uvec2(64), /*p_may_skip=*/false);
		CHECK(lean.visibility == all.visibility);
		CHECK(all.plan.to_text().find("layer 3 only if") == std::string::npos);
		return lean.plan.to_text().find("layer 3 only if layer 2 is not empty, views: 1") !=
				std::string::npos;
	};
	SmallScene square = make_layer_scene(make_squares({ 1.0f }), LightType::SPOT);
	const SettingScope scope("penumbra_fins", "peeling", "passes");
	add_mesh(square.scene, "Floor", make_box_mesh("floor", { 3, 0.1f, 3 }), { 0, -0.2, 0 })
			.casts_shadow = false;
	CHECK(is_conditional(square) == fixture.device->get_features().conditional_rendering);
	SmallScene solid; // a box has back faces, so layer 2 is not empty
	CHECK_FALSE(is_conditional(solid));
}
