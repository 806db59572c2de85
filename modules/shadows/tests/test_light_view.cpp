#include "modules/shadows/camera_view.h"
#include "modules/shadows/light_view.h"
#include "modules/shadows/tests/mask_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

constexpr uint32_t MAP_SIZE_PX = 512;
constexpr uint32_t BORDER_PX = 1;
constexpr float CASTER_MARGIN_M = 0.5f;

} // namespace

TEST_CASE("[LightView] depth is 1 at the near plane, falls with distance and stays above 0") {
	SmallScene scene;
	const std::shared_ptr<const SceneSnapshot> snapshot = scene.snap();
	const LightView view =
			build_light_views(snapshot->lights[0], *snapshot, MAP_SIZE_PX, BORDER_PX).at(0);
	const glm::dmat4 clip = view.compute_clip_from_view();
	const auto depth_at = [&](double p_z) {
		const glm::dvec4 p = clip * glm::dvec4(0, 0, p_z, 1);
		return p.z / p.w;
	};
	CHECK(depth_at(view.near_m) == doctest::Approx(1.0));
	CHECK(depth_at(1.0) > depth_at(2.0));
	CHECK(depth_at(1e6) > 0.0);
}

TEST_CASE("[LightView] the six views of an omni light see every direction") {
	SmallScene scene(LightType::OMNI);
	const std::shared_ptr<const SceneSnapshot> snapshot = scene.snap();
	const std::vector<LightView> views =
			build_light_views(snapshot->lights[0], *snapshot, MAP_SIZE_PX, /*p_border_px=*/2);
	REQUIRE(views.size() == 6);
	for (int index = 0; index < 500; ++index) {
		const double z = 1 - 2 * (index + 0.5) / 500;
		const double angle = 2.4 * index; // golden angle, rad: evenly spread directions
		const glm::dvec3 direction(
				std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z);
		Bounds point;
		point.add(snapshot->lights[0].position_world + direction);
		int seen_count = 0;
		for (const LightView &view : views) {
			seen_count += view.may_see(point);
		}
		CHECK(seen_count >= 1);
	}
}

TEST_CASE("[LightView] a directional view contains every caster") {
	SmallScene scene(LightType::DIRECTIONAL);
	const std::shared_ptr<const SceneSnapshot> snapshot = scene.snap();
	const LightView view =
			build_light_views(snapshot->lights[0], *snapshot, MAP_SIZE_PX, BORDER_PX).at(0);
	for (const InstanceSnapshot &instance : snapshot->instances) {
		for (const glm::vec3 &position : instance.mesh->positions_node) {
			const glm::dvec4 clip = view.compute_clip_from_view() * view.view_from_world *
					instance.world_from_node * glm::dvec4(position, 1.0);
			CHECK(std::abs(clip.x) <= 1.0);
			CHECK(std::abs(clip.y) <= 1.0);
			CHECK(clip.z >= 0.0);
			CHECK(clip.z <= 1.0);
		}
	}
}

TEST_CASE("[LightView] a box outside or behind a view is not seen by it") {
	LightView view;
	view.half_extent = glm::vec2(0.5f); // at z = 2 the view reaches to x = 1
	const auto may_see = [&](const glm::dvec3 &p_centre) {
		Bounds bounds;
		bounds.add(p_centre - 0.1);
		bounds.add(p_centre + 0.1);
		return view.may_see(bounds);
	};
	CHECK(may_see({ 0, 0, 2 }));
	CHECK(may_see({ 1.05, 0, 2 }));
	CHECK_FALSE(may_see({ 1.5, 0, 2 }));
	CHECK_FALSE(may_see({ 0, 0, -2 }));
	CHECK_FALSE(view.may_see(Bounds()));
}

TEST_CASE("[LightView] a rotated caster is culled by its oriented box, not by its world bounds") {
	SmallScene scene;
	// A long rod outside the view, parallel to its right side, x = z / 2. Its world bounds reach
	// into the view.
	MeshInstance3D &rod = add_mesh(
			scene.scene, "Rod", make_box_mesh("rod", { 2.0f, 0.01f, 0.01f }), { 1.3, 0, 2 });
	rod.parent_from_node = glm::rotate(rod.parent_from_node, -std::atan(2.0), glm::dvec3(0, 1, 0));
	const auto snapshot = scene.snap();
	const InstanceSnapshot &instance = snapshot->instances.back();
	LightView view;
	view.half_extent = glm::vec2(0.5f);
	CHECK(view.may_see(instance.bounds_world));
	CHECK_FALSE(view.may_see(instance));
	view.caster_margin_m = 1.0f; // the margin reaches the rod
	CHECK(view.may_see(instance));
	view.caster_margin_m = 0.0f;
	rod.parent_from_node[3] = glm::dvec4(0, 0, 2, 1);
	CHECK(view.may_see(scene.snap()->instances.back()));
	// At 45 degrees to the view, 3 m away. Half lengths: 2 m and 0.01 m.
	rod.parent_from_node = glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, 3)),
			glm::radians(45.0), glm::dvec3(0, 1, 0));
	const auto rotated = scene.snap();
	const glm::dvec2 range_m = view.compute_distance_range_m(rotated->instances.back());
	CHECK(range_m.x == doctest::Approx(3 - (2.0 + 0.01) * std::sqrt(0.5)));
	CHECK(range_m.y == doctest::Approx(3 + (2.0 + 0.01) * std::sqrt(0.5)));
}

TEST_CASE("[LightView] a margin lists casters outside a view, and widens a directional view") {
	SmallScene scene;
	const std::shared_ptr<const SceneSnapshot> snapshot = scene.snap();
	LightView view = build_light_views(
			snapshot->lights[0], *snapshot, MAP_SIZE_PX, BORDER_PX, CASTER_MARGIN_M)
							 .at(0);
	CHECK(view.caster_margin_m == CASTER_MARGIN_M);
	// A point just beyond the right side, at a depth of 2 m.
	const glm::dmat4 world_from_view = glm::inverse(view.view_from_world);
	const double side_m = 2 * double(view.half_extent.x);
	Bounds box;
	box.add(glm::dvec3(world_from_view * glm::dvec4(side_m + 0.2, 0, 2, 1)));
	CHECK(view.may_see(box));
	view.caster_margin_m = 0.05f;
	CHECK_FALSE(view.may_see(box));

	SmallScene directional(LightType::DIRECTIONAL);
	const std::shared_ptr<const SceneSnapshot> other = directional.snap();
	const LightView narrow =
			build_light_views(other->lights[0], *other, MAP_SIZE_PX, BORDER_PX).at(0);
	const LightView wide =
			build_light_views(other->lights[0], *other, MAP_SIZE_PX, BORDER_PX, CASTER_MARGIN_M)
					.at(0);
	CHECK(wide.half_extent.x >= narrow.half_extent.x + CASTER_MARGIN_M);
	CHECK(wide.far_m - wide.near_m ==
			doctest::Approx(narrow.far_m - narrow.near_m + 2 * CASTER_MARGIN_M));
}

TEST_CASE(
		"[LightView] pixel to position and back gives the same pixel with a camera shift, which is "
		"hashed") {
	SmallScene scene;
	SceneSnapshot snapshot = *scene.snap();
	const glm::uvec2 size_px(80, 60);
	for (const glm::vec2 shift : { glm::vec2(0), glm::vec2(0.01f, 0), glm::vec2(-0.02f, 0.013f) }) {
		snapshot.camera.shift = shift;
		const shader::FrameConstants frame = compute_frame_constants(snapshot, size_px);
		for (const glm::uvec2 pixel : { glm::uvec2(0), glm::uvec2(79, 59), glm::uvec2(31, 7) }) {
			const float depth = 0.01f; // reversed: near_m / z
			const glm::vec3 position = compute_position(frame, size_px, pixel, depth);
			const glm::vec4 clip = frame.clip_from_camera_relative * glm::vec4(position, 1.0f);
			const glm::vec2 centre_uv = (glm::vec2(pixel) + 0.5f) / glm::vec2(size_px);
			CHECK(clip.x / clip.w == doctest::Approx(2.0f * centre_uv.x - 1.0f).epsilon(1e-4));
			CHECK(clip.y / clip.w == doctest::Approx(2.0f * centre_uv.y - 1.0f).epsilon(1e-4));
			CHECK(clip.z / clip.w == doctest::Approx(depth).epsilon(1e-4));
		}
	}
	snapshot.camera.shift = glm::vec2(0);
	const uint64_t hash = snapshot.camera.compute_hash(/*p_seed=*/1);
	snapshot.camera.shift = glm::vec2(0.001f);
	CHECK(snapshot.camera.compute_hash(/*p_seed=*/1) != hash);
}
