#include "modules/shadows/light_view.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// A light, and its views as C++ and as the shaders see them. w: see LightViewConstants.
struct LightCase {
	SceneSnapshot scene;
	LightSnapshot light;
	std::vector<LightView> views;
	shader::LightViewsConstants constants;

	explicit LightCase(LightType p_type, double p_cone_rad = 0.8) {
		scene.scene_size_m = 4;
		scene.camera.position_world = { 20, -3, 8 };
		InstanceSnapshot instance; // gives the directional view its extent
		instance.bounds_world.add(glm::dvec3(15, -8, 3));
		instance.bounds_world.add(glm::dvec3(25, 2, 13));
		scene.instances.push_back(instance);
		light.type = p_type;
		light.position_world = { 21, -1, 9 };
		light.outer_cone_rad = static_cast<float>(p_cone_rad);
		light.world_from_light =
				glm::dmat3(glm::mat3_cast(glm::normalize(glm::dquat(0.5, -0.6, 0.3, 0.4))));
		views = build_light_views(light, scene, /*p_map_size_px=*/512, /*p_border_px=*/1);
		constants = compute_light_views_constants(light, scene.camera, views);
	}

	/// A world position that the light reaches: 0.5 to 4 m from it, or for a directional light at
	/// most 3 m from the middle of the instance.
	glm::dvec3 make_position(TestRandom &r_random) const {
		if (light.type == LightType::DIRECTIONAL) {
			return glm::dvec3(20, -3, 8) + 3.0 * r_random.next() * r_random.next_unit();
		}
		glm::dvec3 direction = r_random.next_unit();
		while (light.type == LightType::SPOT &&
				glm::dot(direction, light.get_direction_world()) <
						std::cos(double(light.outer_cone_rad))) {
			direction = r_random.next_unit();
		}
		return light.position_world + r_random.next(0.5, 4) * direction;
	}
};

/// The cube face that a direction in the light's axes hits, in the order +x -x +y -y +z -z: its
/// largest component.
uint32_t find_face(const glm::dvec3 &p_direction_light) {
	const glm::dvec3 size = glm::abs(p_direction_light);
	const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
	return static_cast<uint32_t>(2 * axis + (p_direction_light[axis] >= 0 ? 0 : 1));
}

/// Compares the shaders with the same formulas in double precision, at random points of random
/// planes.
void check_case(KernelFixture &r_fixture, const LightCase &p_case) {
	TestRandom random;
	const size_t item_count = 3000;
	std::vector<glm::vec4> input;
	std::vector<glm::dvec3> positions;
	const auto relative = [&](const glm::dvec3 &p_world) {
		return glm::vec4(p_case.scene.to_camera_relative(p_world), 1.0f);
	};
	while (positions.size() < item_count) {
		const glm::dvec3 position = p_case.make_position(random);
		glm::dvec3 normal = random.next_unit();
		const glm::dvec3 to_light = p_case.light.type == LightType::DIRECTIONAL
				? -p_case.light.get_direction_world()
				: glm::normalize(p_case.light.position_world - position);
		if (glm::dot(normal, to_light) < 0.1) {
			continue; // on grazing planes w changes too steeply for float
		}
		const glm::dvec3 tangent = glm::normalize(glm::cross(normal, random.next_unit()));
		positions.push_back(position);
		input.push_back(relative(position));
		input.push_back(relative(position + 0.02 * tangent));
		input.push_back(glm::vec4(glm::vec3(normal), 0.0f));
	}
	const std::vector<glm::vec4> results =
			r_fixture.run_with_constants("light_view.comp", p_case.constants, input, item_count, 3);
	size_t wrong_view_count = 0;
	size_t outside_count = 0;
	double largest_w_error = 0;
	double largest_xy_error = 0;
	double largest_slope_error = 0;
	for (size_t index = 0; index < item_count; ++index) {
		const glm::dvec4 first(results[3 * index]);
		const glm::dvec4 second(results[3 * index + 1]);
		const glm::dvec4 slope_texels(results[3 * index + 2]);
		const uint32_t view_index = static_cast<uint32_t>(first.w);
		const glm::dvec3 direction_light = glm::transpose(p_case.light.world_from_light) *
				(positions[index] - p_case.light.position_world);
		wrong_view_count +=
				view_index != (p_case.views.size() == 1 ? 0 : find_face(direction_light));
		const LightView &view = p_case.views[view_index];
		const glm::dvec3 position_view(view.view_from_world * glm::dvec4(positions[index], 1.0));
		const double z = position_view.z;
		const double w = view.is_orthographic ? double(view.far_m) - z : 1 / z;
		const glm::dvec2 xy =
				view.is_orthographic ? glm::dvec2(position_view) : glm::dvec2(position_view) / z;
		largest_w_error = std::max(largest_w_error, std::abs(first.z - w) / w);
		largest_xy_error = std::max(largest_xy_error, glm::distance(glm::dvec2(first), xy));
		const bool is_outside = glm::any(glm::lessThan(glm::dvec2(slope_texels.z, slope_texels.w),
										glm::dvec2(0))) ||
				slope_texels.z > view.size_px.x || slope_texels.w > view.size_px.y;
		outside_count += is_outside;
		const double predicted = first.z +
				glm::dot(glm::dvec2(slope_texels), glm::dvec2(second) - glm::dvec2(first));
		largest_slope_error = std::max(largest_slope_error, std::abs(predicted - second.z) / w);
	}
	CHECK(wrong_view_count == 0);
	CHECK(outside_count == 0);
	CHECK(largest_w_error < 1e-5);
	CHECK(largest_xy_error < 1e-5);
	CHECK(largest_slope_error < 1e-5);
}

} // namespace

TEST_CASE("[GPU][Shaders] w is linear on a plane, and a point finds the view that contains it") {
	KernelFixture fixture;
	SUBCASE("omni") {
		check_case(fixture, LightCase(LightType::OMNI));
	}
	SUBCASE("spot of one view") {
		check_case(fixture, LightCase(LightType::SPOT));
	}
	SUBCASE("spot so wide that it has six views") {
		check_case(fixture, LightCase(LightType::SPOT, 1.4));
	}
	SUBCASE("directional") {
		check_case(fixture, LightCase(LightType::DIRECTIONAL));
	}
}

TEST_CASE("[GPU][Shaders] a point behind the view has w = 0, one without a normal has no slope") {
	KernelFixture fixture;
	const LightCase light_case(LightType::SPOT);
	const glm::dmat3 &axes = light_case.light.world_from_light;
	const glm::dvec3 &light = light_case.light.position_world;
	const auto relative = [&](const glm::dvec3 &p_world) {
		return glm::vec4(light_case.scene.to_camera_relative(p_world), 1.0f);
	};
	const glm::dvec3 behind = light + axes[2];
	const glm::dvec3 in_front = light - axes[2];
	const std::vector<glm::vec4> results =
			fixture.run_with_constants("light_view.comp", light_case.constants,
					{ relative(behind), relative(light), glm::vec4(glm::vec3(axes[2]), 0.0f),
							relative(in_front), relative(in_front), glm::vec4(0.0f) },
					/*p_item_count=*/2, /*p_output_per_item=*/3);
	CHECK(results[0].z == 0.0f);
	CHECK(std::isfinite(results[1].z)); // at the light: any finite value, but never NaN
	CHECK(results[3].z == doctest::Approx(1.0).epsilon(1e-5)); // 1 m in front of the light
	CHECK(glm::vec2(results[5]) == glm::vec2(0.0f));		   // no normal: no slope
}
