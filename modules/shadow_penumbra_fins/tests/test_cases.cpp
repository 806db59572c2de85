#include "modules/shadow_penumbra_fins/tests/fins_fixture.h"
#include "modules/shadows/tests/setting_scope.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <numbers>

using namespace gnomon;

namespace {

constexpr double WIDTH_M = 0.3; // r and t
constexpr uint32_t SIZE_PX = 320;

struct Cube {
	glm::dvec3 centre;
	double half_m;
};
// Figure 7 of Sun et al. 2010: a small cube over a large one, both in the air over the ground.
const Cube UPPER = { { 0, 3.2, 0 }, 0.4 };
const Cube LOWER = { { 0, 1.9, 0 }, 0.8 };

SmallScene make_case_scene(LightType p_type = LightType::DIRECTIONAL) {
	SmallScene scene(p_type);
	scene.box->surfaces.clear();
	for (const Cube &cube : { UPPER, LOWER }) {
		add_mesh(scene.scene, cube.half_m == UPPER.half_m ? "Upper" : "Lower",
				make_box_mesh("cube", glm::vec3(float(cube.half_m))), cube.centre);
	}
	// Light that shines exactly straight down makes the positions of the shadows' borders known.
	scene.light->parent_from_node = glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0),
			glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 7, 0, 1));
	scene.light->properties["penumbra_outer_width"] = WIDTH_M;
	scene.light->properties["penumbra_inner_width"] = WIDTH_M;
	scene.camera->vertical_fov_rad = 0.9f;
	return scene;
}

/// Returns the first hit of a pixel's ray with the cubes or the ground, if it is on a top face.
std::optional<glm::dvec3> find_top(const SceneSnapshot &p_scene, glm::uvec2 p_pixel) {
	const CameraSnapshot &camera = p_scene.camera;
	const double tangent = std::tan(0.5 * double(camera.vertical_fov_rad));
	const glm::dvec2 ndc = (glm::dvec2(p_pixel) + 0.5) / double(SIZE_PX) * 2.0 - 1.0;
	const glm::dvec3 direction =
			camera.world_from_camera * glm::dvec3(ndc.x * tangent, -ndc.y * tangent, -1.0);
	double nearest = 1e30;
	std::optional<glm::dvec3> top;
	const Cube ground = { { 0, -50, 0 }, 50 }; // its top is at y = 0, as that of the scene's plate
	for (const Cube &cube : { UPPER, LOWER, ground }) {
		const glm::dvec3 low = (cube.centre - cube.half_m - camera.position_world) / direction;
		const glm::dvec3 high = (cube.centre + cube.half_m - camera.position_world) / direction;
		const glm::dvec3 first = glm::min(low, high);
		const double enter = std::max({ first.x, first.y, first.z });
		const glm::dvec3 last = glm::max(low, high);
		if (enter > std::min({ last.x, last.y, last.z }) || enter < 0 || enter > nearest) {
			continue;
		}
		nearest = enter;
		const bool is_top = enter == first.y && direction.y < 0;
		top = is_top ? std::optional(camera.position_world + enter * direction) : std::nullopt;
	}
	return top;
}

/// Cases: 1 outer penumbra, 2 lit, 3 umbra without a fin, 4 umbra under an outer fin, 5 inner
/// penumbra, 6 umbra behind the third layer.
struct Expected {
	int case_number = 0; // 0: too near to a border to decide
	double visibility = 0;
};

/// Returns the case and visibility of a point on a top face, from figure 7, with light straight
/// down. A fin at the corner of a cube leans out along (1, 1, 1), so that it covers r / sqrt(3) in
/// x and z.
Expected compute_expected(const glm::dvec3 &p_point) {
	const double reach_m = WIDTH_M / std::sqrt(3.0);
	const double margin_m = 0.03; // pixels and texels at a border may go either way
	const double from_axis_m = std::max(std::abs(p_point.x), std::abs(p_point.z));
	for (double border_m : { UPPER.half_m - reach_m, UPPER.half_m, UPPER.half_m + reach_m,
				 LOWER.half_m - reach_m, LOWER.half_m, LOWER.half_m + reach_m }) {
		if (std::abs(from_axis_m - border_m) < margin_m) {
			return {};
		}
	}
	// Visibility across a fin, section 2.1.3.
	const auto outer = [&](const Cube &p_cube) {
		const double theta = 0.5 + 0.5 * (from_axis_m - p_cube.half_m) / reach_m;
		return std::sin((theta - 0.5) * std::numbers::pi) * 0.7 + 0.3;
	};
	const auto inner = [&](const Cube &p_cube) {
		const double theta = 0.5 + 0.5 * (from_axis_m - p_cube.half_m) / reach_m;
		return (1 - std::cos(theta * std::numbers::pi)) * 0.3;
	};
	const bool is_ground = p_point.y < 0.1;
	const bool is_upper = p_point.y > 3.0;
	if (is_upper) {
		return { 2, 1 };
	}
	if (from_axis_m < UPPER.half_m - reach_m) {
		return { 3, 0 };
	}
	if (from_axis_m < UPPER.half_m) {
		return is_ground ? Expected{ 6, 0 } : Expected{ 5, inner(UPPER) };
	}
	if (from_axis_m < UPPER.half_m + reach_m) {
		return is_ground ? Expected{ 4, 0 } : Expected{ 1, outer(UPPER) };
	}
	if (!is_ground || from_axis_m > LOWER.half_m + reach_m) {
		return { 2, 1 };
	}
	if (from_axis_m < LOWER.half_m - reach_m) {
		return { 3, 0 };
	}
	return from_axis_m < LOWER.half_m ? Expected{ 5, inner(LOWER) } : Expected{ 1, outer(LOWER) };
}

} // namespace

TEST_CASE("[GPU][PenumbraFins] each of the six cases of figure 7 is reached, where it should be") {
	MaskFixture fixture;
	std::map<int, int> right_counts;
	// From above, and from below the large cube's bottom to see the ground under it.
	for (const glm::dvec3 eye : { glm::dvec3(-2.5, 6.0, 3.0), glm::dvec3(-3.5, 1.0, 4.2) }) {
		SmallScene scene = make_case_scene();
		scene.camera->parent_from_node = look_at(eye, { 0, 1.0, 0 });
		MaskRequest request;
		request.scene = scene.snap();
		request.size_px = glm::uvec2(SIZE_PX);
		request.technique_override = "penumbra_fins";
		const std::shared_ptr<const SceneSnapshot> snapshot = request.scene;
		const MaskResult mask = fixture.render_mask(scene, "penumbra_fins", request.size_px);
		request.debug_view = "case";
		const std::vector<float> cases = fixture.render(request).debug_values;
		// For each expected case, how often each value of the debug view occurs. Pixels too near to
		// a border are skipped.
		std::map<int, std::map<float, int>> classes;
		for (uint32_t y = 0; y < SIZE_PX; ++y) {
			for (uint32_t x = 0; x < SIZE_PX; ++x) {
				const size_t pixel = size_t(y) * SIZE_PX + x;
				const std::optional<glm::dvec3> point = find_top(*snapshot, { x, y });
				const Expected expected = point ? compute_expected(*point) : Expected();
				if (expected.case_number == 0 || mask.receiver[pixel] == 0) {
					continue;
				}
				++classes[expected.case_number][cases[pixel]];
				const bool is_right = std::abs(mask.visibility[pixel] - expected.visibility) < 0.05;
				CHECK_MESSAGE(is_right, "pixel ", x, " ", y, ": case ", expected.case_number,
						", visibility ", mask.visibility[pixel], ", expected ",
						expected.visibility);
				right_counts[expected.case_number] += is_right;
			}
		}
		// Each case has one debug value, and no two cases have the same.
		std::set<float> seen;
		for (const auto &[case_number, counts] : classes) {
			CAPTURE(case_number);
			CHECK(counts.size() == 1);
			CHECK(seen.insert(counts.begin()->first).second);
		}
	}
	for (int case_number = 1; case_number <= 6; ++case_number) {
		CAPTURE(case_number);
		CHECK(right_counts[case_number] > 30);
	}
}

TEST_CASE("[GPU][PenumbraFins] r = t = 0 gives a mask of 0 and 1, and skips fins and layers") {
	MaskFixture fixture;
	for (LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		SmallScene scene(type);
		scene.light->properties["penumbra_outer_width"] = 0.0;
		scene.light->properties["penumbra_inner_width"] = 0.0;
		for (const std::string id : { "penumbra_fins", "outer_fins" }) {
			const MaskResult lean = fixture.render_mask(scene, id);
			const MaskResult all =
					fixture.render_mask(scene, id, glm::uvec2(64), /*p_may_skip=*/false);
			CHECK(lean.visibility == all.visibility);
			for (float value : lean.visibility) {
				CHECK((value == 0.0f || value == 1.0f));
			}
			CHECK(lean.plan.is_skipped("Light", "fins"));
			CHECK(lean.plan.is_skipped("Light", "layers 2 and 3") == (id == "penumbra_fins"));
			for (const PassTiming &timing : lean.timings) {
				CHECK(timing.name.find("fins view") == std::string::npos);
				CHECK(timing.name.find("layer 2") == std::string::npos);
			}
		}
	}
}

TEST_CASE("[GPU][PenumbraFins] a width of 0 skips only its half, and the mask stays the same") {
	MaskFixture fixture;
	for (const char *width : { "penumbra_outer_width", "penumbra_inner_width" }) {
		CAPTURE(width);
		SmallScene scene = make_case_scene(LightType::SPOT);
		scene.light->properties[width] = 0.0;
		const MaskResult lean = fixture.render_mask(scene, "penumbra_fins");
		const MaskResult all =
				fixture.render_mask(scene, "penumbra_fins", glm::uvec2(64), /*p_may_skip=*/false);
		CHECK(lean.visibility == all.visibility);
		const bool is_inner = std::string(width) == "penumbra_inner_width";
		CHECK(lean.plan.is_skipped("Light", is_inner ? "inner fins" : "outer fins"));
		CHECK(lean.plan.is_skipped("Light", "layers 2 and 3") == is_inner);
	}
}

TEST_CASE("[GPU][PenumbraFins] all peeling and fin methods give the same mask") {
	MaskFixture fixture;
	for (LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		SmallScene scene = make_case_scene(type);
		const MaskResult first = fixture.render_mask(scene, "penumbra_fins");
		for (const std::string peeling : { "passes", "one_pass" }) {
			for (const std::string method : { "geometry_shader", "compute" }) {
				const SettingScope peels("penumbra_fins", "peeling", peeling);
				const SettingScope fins("penumbra_fins", "method", method);
				CHECK(fixture.render_mask(scene, "penumbra_fins").visibility == first.visibility);
			}
		}
	}
}

TEST_CASE("[GPU][PenumbraFins] the mask is valid with widths larger than the casters, and with "
		  "lights inside these") {
	MaskFixture fixture;
	for (LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		for (const std::string id : { "penumbra_fins", "outer_fins" }) {
			for (double width_m : { 1.0, 10.0, 1e4 }) {
				SmallScene scene = make_case_scene(type);
				scene.light->properties["penumbra_outer_width"] = width_m;
				scene.light->properties["penumbra_inner_width"] = width_m;
				CHECK(is_valid_mask(fixture.render_mask(scene, id)));
				scene.light->parent_from_node = look_at(LOWER.centre, { 0, 0, 0.1 });
				CHECK(is_valid_mask(fixture.render_mask(scene, id)));
			}
		}
	}
}

TEST_CASE("[GPU][PenumbraFins] the plan reports an instance that is scaled to a line") {
	MaskFixture fixture;
	SmallScene scene = make_case_scene(LightType::SPOT);
	add_mesh(scene.scene, "Flat", make_box_mesh("flat", glm::vec3(0.5f)), { 0, 0, 0 })
			.parent_from_node =
			glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(1, 1.5, 0)), glm::dvec3(1, 0, 0));
	const MaskResult result = fixture.render_mask(scene, "penumbra_fins");
	CHECK(is_valid_mask(result));
	CHECK(result.plan.is_skipped("Light", "fins of 1 instances"));
}
