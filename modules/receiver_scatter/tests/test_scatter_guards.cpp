// Tests extreme materials, image sizes, scene sizes and light positions.

#include "modules/receiver_scatter/tests/scatter_fixture.h"

#include <doctest/doctest.h>

#include <limits>

using namespace gnomon;

namespace {

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
constexpr float INFINITE = std::numeric_limits<float>::infinity();

} // namespace

TEST_CASE("[GPU][ReceiverScatter] extreme materials and images give valid masks") {
	MaskFixture fixture;
	SmallScene scene;
	const MaskResult opaque = fixture.render_mask(scene, get_sharp_technique());
	const auto render = [&](float p_scatter, float p_distance_m, glm::uvec2 p_size_px) {
		scene.ground->surfaces[0].material = make_translucent_material(p_scatter, p_distance_m);
		return fixture.render_mask(scene, get_sharp_technique(), p_size_px);
	};
	for (const float scatter : { 0.0f, NOT_A_NUMBER, -1.0f }) {
		CAPTURE(scatter);
		CHECK(render(scatter, 0.5f, glm::uvec2(64)).visibility == opaque.visibility);
	}
	for (const float scatter : { 1e-4f, 1.0f, 5.0f, INFINITE }) {
		for (const float distance_m : { 0.0f, 1e-6f, 0.5f, 1e4f, INFINITE, NOT_A_NUMBER }) {
			CAPTURE(scatter);
			CAPTURE(distance_m);
			CHECK(is_valid_mask(render(scatter, distance_m, glm::uvec2(64))));
		}
	}
	// A radius far below a pixel has no visible effect.
	CHECK(compute_mask_difference(render(1.0f, 1e-5f, glm::uvec2(64)), opaque) < 1e-3);
	for (const glm::uvec2 size_px :
			{ glm::uvec2(1, 1), glm::uvec2(1, 64), glm::uvec2(64, 1), glm::uvec2(3, 5) }) {
		CAPTURE(size_px.x);
		CAPTURE(size_px.y);
		for (const float distance_m : { 0.0f, 0.5f }) {
			CHECK(is_valid_mask(render(1.0f, distance_m, size_px)));
		}
	}
	// A fully lit ground stays lit up to the image's border: samples outside are ignored.
	scene.box->casts_shadow = false;
	scene.light->properties["receiver_scatter_refusal"] = std::string("on");
	for (const float distance_m : { 0.0f, 2.0f }) {
		CAPTURE(distance_m);
		const MaskResult lit = render(1.0f, distance_m, glm::uvec2(64));
		size_t dark_count = 0;
		for (size_t index = 0; index < lit.visibility.size(); ++index) {
			dark_count += lit.receiver[index] > 0 && lit.visibility[index] < 0.999f; // half float
		}
		CHECK(dark_count == 0);
	}
}

TEST_CASE("[GPU][ReceiverScatter] a receiver of few pixels keeps its mask") {
	MaskFixture fixture;
	SmallScene scene;
	// Boxes so small that each covers a few pixels or none, each with its own material.
	const auto crumb = make_box_mesh("crumb", glm::vec3(0.02f));
	for (int i = 0; i < 9; ++i) {
		MeshInstance3D &node = add_mesh(scene.scene, "Crumb " + std::to_string(i), crumb,
				glm::dvec3(-0.8 + 0.2 * i, 0.02, -0.3));
		node.surfaces[0].material = make_translucent_material(1.0f, 0.5f * float(i + 1));
	}
	scene.light->properties["receiver_scatter_enabled"] = false;
	const MaskResult before = fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(48));
	scene.light->properties["receiver_scatter_enabled"] = true;
	scene.light->properties["receiver_scatter_refusal"] = std::string("on");
	for (const char *method : { "metres", "pixels" }) {
		CAPTURE(method);
		scene.light->properties["receiver_scatter_method"] = std::string(method);
		const MaskResult after = fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(48));
		CHECK(is_valid_mask(after));
		// The pixels of one box have nearly the same visibility, so that averaging keeps it.
		CHECK(compute_mask_difference(before, after) < 1e-3);
		size_t black_count = 0;
		for (size_t index = 0; index < after.visibility.size(); ++index) {
			black_count += before.visibility[index] > 0.5f && after.visibility[index] < 0.2f;
		}
		CHECK(black_count == 0);
	}
}

TEST_CASE("[GPU][ReceiverScatter] a scene of another size or position has the same mask") {
	MaskFixture fixture;
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		const auto render = [&](double p_scale, const glm::dvec3 &p_origin, float p_distance_m) {
			SmallScene scene(type, p_scale, p_origin);
			scene.ground->surfaces[0].material = make_translucent_material(0.8f, p_distance_m);
			return fixture.render_mask(scene, get_sharp_technique());
		};
		for (const float distance_m : { 0.0f, 0.5f }) {
			CAPTURE(get_light_type_name(type));
			CAPTURE(distance_m);
			const MaskResult plain = render(1, glm::dvec3(0.0), distance_m);
			CHECK(is_valid_mask(plain));
			for (const double scale : { 1e-3, 1e3 }) {
				CAPTURE(scale);
				const MaskResult scaled =
						render(scale, glm::dvec3(0.0), distance_m * static_cast<float>(scale));
				CHECK(compute_mask_difference(plain, scaled) < 0.002);
			}
			const MaskResult moved = render(1, glm::dvec3(1e5, -1e5, 1e5), distance_m);
			CHECK(compute_mask_difference(plain, moved) < 0.002);
		}
	}
}

TEST_CASE("[GPU][ReceiverScatter] extreme lights, no receivers, and 64 lights give masks") {
	MaskFixture fixture;
	SmallScene scene;
	scene.ground->surfaces[0].material = make_translucent_material(1.0f, 0.7f);
	scene.box->surfaces[0].material = make_translucent_material(0.4f, 0.0f);
	const glm::dvec3 positions[] = { { 0, 1.0, 0 }, // inside the box
		{ 0, 0, 0 }, { 0.3, 1e-6, 0.3 },			// on the ground
		{ 0, -3, 0 },								// below it
		{ 40, 0.01, 0 } };							// 40 m away, the cone misses it
	for (const glm::dvec3 &position : positions) {
		CAPTURE(position.x);
		CAPTURE(position.y);
		scene.light->parent_from_node = look_at(position, position + glm::dvec3(0.1, -1, 0.2));
		for (const double size_m : { 0.0, 0.3, 50.0 }) {
			scene.light->properties["light_size"] = size_m;
			CHECK(is_valid_mask(fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(32))));
		}
	}
	// The camera looks at the sky: there are no receivers.
	scene.camera->parent_from_node = look_at({ 0, 5, 0 }, { 0.1, 20, 0 });
	CHECK(count_receivers(fixture.render_mask(scene, get_sharp_technique(), glm::uvec2(32))) == 0);
	for (int i = 0; i < 63; ++i) {
		scene.add_light("Light " + std::to_string(i), LightType::OMNI, { 0.1 * i - 3.0, 2.5, 0.5 },
				{ 0, 0, 0 });
	}
	MaskRequest request;
	request.scene = scene.snap();
	CHECK(fixture.render(request).masks.size() == 64);
}
