#include "modules/stability_report/stability_sweeps.h"
#include "modules/stability_report/visibility_condition.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace gnomon;

namespace {

/// A light 2 m above the origin, and a plate 1 m above the origin that covers x > 0: its edge is at
/// x = 0.
struct HalfPlane {
	SceneSnapshot scene;

	explicit HalfPlane(double p_radius_m, const glm::dvec3 &p_offset = glm::dvec3(0.0)) {
		scene.scene_size_m = 4.0;
		glm::dmat4 world_from_node(1.0);
		world_from_node[3] = glm::dvec4(p_offset + glm::dvec3(0, 1, 0), 1.0);
		scene.instances.push_back(make_instance(
				make_mesh("plate",
						{ { 0, 0, -100 }, { 0, 0, 100 }, { 100, 0, 100 }, { 100, 0, -100 } }, {},
						{ 0, 1, 2, 0, 2, 3 }),
				nullptr, world_from_node, "plate"));
		LightSnapshot light;
		light.position_world = p_offset + glm::dvec3(0, 2, 0);
		light.light_size_m = float(p_radius_m);
		scene.lights.push_back(light);
		scene.camera.position_world = p_offset;
	}
	const LightSnapshot &get_light() const { return scene.lights[0]; }
};

} // namespace

TEST_CASE("[Condition] behind a half plane, visibility is the visible fraction of the disc") {
	const HalfPlane small(0.2);
	const DoubleVisibility exact(small.scene, small.get_light());
	CHECK(exact.compute({ -1, 0, 0 }) == 1.0);
	CHECK(exact.compute({ 1, 0, 0 }) == 0.0);
	// The edge is halfway between receiver and light: from x, the light is hidden beyond -x.
	for (const double x : { -0.15, -0.05, 0.0, 0.1 }) {
		const double d = -x / 0.2; // distance of the edge from the disc's centre, in R
		const double seen = (std::acos(-d) + d * std::sqrt(1 - d * d)) / std::numbers::pi;
		CHECK(exact.compute({ x, 0, 0 }) == doctest::Approx(seen).epsilon(0.04));
	}
	// No precision is lost far from the origin.
	const glm::dvec3 offset(3e6, -2e6, 1e6);
	const HalfPlane far(0.2, offset);
	CHECK(DoubleVisibility(far.scene, far.get_light()).compute(offset + glm::dvec3(-0.05, 0, 0)) ==
			exact.compute({ -0.05, 0, 0 }));
}

TEST_CASE("[Condition] the cause of an error is the method, rounding or the reference") {
	// Soft: v changes by about 1 over 0.4 m, 2 m from the light.
	const HalfPlane soft(0.2);
	const ConditionPoint point = { .position = { -0.01f, 0, 0 }, .reference = 0.53, .error = 0.3 };
	const VisibilityCondition smooth =
			compute_visibility_condition(soft.scene, soft.get_light(), { &point, 1 });
	CHECK(smooth.number < 100); // 39 if one of 256 rays changes over the displacement 1e-4
	CHECK(smooth.rounding < 0.02);
	CHECK(smooth.reference_error < 0.03);
	CHECK(smooth.error == 0.3);
	CHECK(smooth.cause == ErrorCause::METHOD);
	// A penumbra so narrow that rounding alone moves a receiver from light to shadow.
	const HalfPlane sharp(1e-7);
	const ConditionPoint edge = { .position = { -1e-7f, 0, 0 }, .reference = 1.0, .error = 1.0 };
	const VisibilityCondition stiff =
			compute_visibility_condition(sharp.scene, sharp.get_light(), { &edge, 1 });
	CHECK(stiff.number > 1e5);
	CHECK(stiff.rounding == 1.0);
	CHECK(stiff.cause == ErrorCause::ROUNDING);
	// A wrong reference: dark at a lit point.
	const ConditionPoint wrong_reference = {
		.position = { -1.0f, 0, 0 }, .reference = 0.0, .error = 1.0
	};
	CHECK(compute_visibility_condition(soft.scene, soft.get_light(), { &wrong_reference, 1 })
					.cause == ErrorCause::REFERENCE);
	CHECK(compute_visibility_condition(soft.scene, soft.get_light(), {}).error == 0.0);
}
