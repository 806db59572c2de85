#include "modules/shadows/tests/mask_fixture.h"
#include "modules/shadows/view_fit.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

constexpr uint32_t FIT_MAP_SIZE_PX = 256;
constexpr uint32_t FIT_BORDER_PX = 1;
constexpr double REACH_M = 0.5;
constexpr double HALF_SIZE_M = 2.0; // of the receivers' box

/// A directional view over a ground of 200 m. fit() narrows it to receivers in a box at p_center.
struct FittedScene {
	SmallScene scene = SmallScene(LightType::DIRECTIONAL);
	std::shared_ptr<const SceneSnapshot> snapshot;
	LightView whole;

	FittedScene() {
		add_mesh(scene.scene, "Far", make_box_mesh("far", { 100.0f, 0.1f, 100.0f }), { 0, -1, 0 });
		snapshot = scene.snap();
		whole = build_light_views(
				snapshot->lights[0], *snapshot, FIT_MAP_SIZE_PX, FIT_BORDER_PX)[0];
	}
	VisibleReceivers make_receivers(const glm::dvec3 &p_center, double p_half_size_m) const {
		VisibleReceivers receivers;
		VisibleReceiver receiver;
		receiver.bounds_world.add(p_center - p_half_size_m);
		receiver.bounds_world.add(p_center + p_half_size_m);
		receivers.add(receiver);
		return receivers;
	}
	LightView fit(
			const glm::dvec3 &p_center, double p_half_size_m, double p_reach_m = REACH_M) const {
		LightView view = whole;
		fit_to_receivers(view, find_bounds_in_view(view, make_receivers(p_center, p_half_size_m)),
				p_reach_m);
		return view;
	}
};

} // namespace

TEST_CASE("[LightView] a directional view is narrowed to the receivers plus the reach") {
	const FittedScene scene;
	for (const glm::dvec3 &center :
			{ glm::dvec3(0.0), glm::dvec3(31.0, 0.0, -17.0), glm::dvec3(-90.0, 0.0, 80.0) }) {
		CAPTURE(center.x);
		const LightView view = scene.fit(center, HALF_SIZE_M);
		CHECK(view.half_extent.x < 0.1f * scene.whole.half_extent.x);
		CHECK(view.near_m == scene.whole.near_m);
		CHECK(view.far_m == scene.whole.far_m);
		for (int corner = 0; corner < 8; ++corner) {
			Bounds box;
			box.add(center - HALF_SIZE_M);
			box.add(center + HALF_SIZE_M);
			const glm::dvec3 seen(view.view_from_world * glm::dvec4(box.get_corner(corner), 1.0));
			CHECK(std::abs(seen.x) + REACH_M <= view.half_extent.x);
			CHECK(std::abs(seen.y) + REACH_M <= view.half_extent.y);
		}
	}
}

TEST_CASE("[LightView] a narrowed view stays the same while the receivers move a little") {
	const FittedScene scene;
	int change_count = 0;
	LightView last = scene.fit(glm::dvec3(0.0), HALF_SIZE_M);
	for (int step = 1; step <= 100; ++step) {
		const LightView view = scene.fit(glm::dvec3(0.01 * step, 0.0, 0.0), HALF_SIZE_M);
		change_count += view == last ? 0 : 1;
		last = view;
	}
	// The steps of the view's centre are longer than this 1 m: at most one in x and one in y.
	CHECK(change_count <= 2);
}

TEST_CASE("[LightView] mostly visible views, views without receivers and spot views are not "
		  "narrowed") {
	const FittedScene scene;
	CHECK(scene.fit(glm::dvec3(0.0), 90.0) == scene.whole);
	CHECK(scene.fit(glm::dvec3(0.0), HALF_SIZE_M, /*p_reach_m=*/1000.0) == scene.whole);
	CHECK(scene.fit(glm::dvec3(10000.0), HALF_SIZE_M) == scene.whole);
	LightView view = scene.whole;
	fit_to_receivers(view, /*p_receivers=*/{}, REACH_M);
	CHECK(view == scene.whole);
	SmallScene spot(LightType::SPOT);
	const auto snapshot = spot.snap();
	const LightView before =
			build_light_views(snapshot->lights[0], *snapshot, FIT_MAP_SIZE_PX, FIT_BORDER_PX)[0];
	view = before;
	fit_to_receivers(
			view, find_bounds_in_view(view, scene.make_receivers(glm::dvec3(0.0), 0.1)), 0.01);
	CHECK(view == before);
}

TEST_CASE("[LightView] the reach grows with the light's angle and with its penumbra widths") {
	const FittedScene scene;
	LightSnapshot light = scene.snapshot->lights[0];
	light.light_angular_distance_deg = 2.0f;
	light.penumbra_outer_width_m = light.penumbra_inner_width_m = 0.0f;
	const double depth_m = scene.whole.far_m - scene.whole.near_m;
	const double narrow_m =
			compute_fit_reach_m(scene.whole, light, *scene.snapshot, /*p_receivers=*/{});
	CHECK(narrow_m >= depth_m * std::tan(glm::radians(1.0)));
	// A receiver far behind all casters, along the light's direction.
	const glm::dvec3 far_world(
			glm::inverse(scene.whole.view_from_world) * glm::dvec4(0.0, 0.0, 10.0 * depth_m, 1.0));
	const Bounds far_view = find_bounds_in_view(scene.whole, scene.make_receivers(far_world, 0.1));
	CHECK(compute_fit_reach_m(scene.whole, light, *scene.snapshot, far_view) >=
			9.0 * depth_m * std::tan(glm::radians(1.0)));
	light.penumbra_outer_width_m = 1.0f;
	CHECK(compute_fit_reach_m(scene.whole, light, *scene.snapshot, /*p_receivers=*/{}) > narrow_m);
}
