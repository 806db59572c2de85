#include "modules/shadows/camera_view.h"
#include "modules/shadows/scene_summary.h"
#include "modules/shadows/tests/mask_fixture.h"
#include "modules/shadows/view_culling.h"
#include "modules/shadows/visible_receivers.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;

namespace {

/// Boxes around the middle, some of which do not cast.
SharedVector<InstanceSnapshot> make_instances(int p_count) {
	const auto mesh = make_box_mesh("box", glm::vec3(0.2f));
	SharedVector<InstanceSnapshot> instances;
	for (int index = 0; index < p_count; ++index) {
		const glm::dvec3 position(
				0.5 * (index % 8) - 2.0, 0.1 * (index % 5), 0.4 * (index / 8) - 2.0);
		instances.push_back(
				make_instance(mesh, nullptr, glm::translate(glm::dmat4(1.0), position), "Box"));
		instances.edit_back().casts_shadow = index % 3 != 0;
	}
	return instances;
}

void move(InstanceSnapshot &r_instance, const glm::dvec3 &p_by) {
	r_instance.set_transform(glm::translate(r_instance.world_from_node, p_by));
}

void check_equal(const Bounds &p_bounds, const Bounds &p_expected) {
	CHECK(p_bounds.minimum == p_expected.minimum);
	CHECK(p_bounds.maximum == p_expected.maximum);
}

void check_equal(const SceneSummary &p_summary, const SceneSummary &p_expected) {
	check_equal(p_summary.get_bounds(), p_expected.get_bounds());
	check_equal(p_summary.get_caster_bounds(), p_expected.get_caster_bounds());
	check_equal(p_summary.get_whole().other_caster_bounds_world,
			p_expected.get_whole().other_caster_bounds_world);
	CHECK(p_summary.get_whole().largest_diagonal_m == p_expected.get_whole().largest_diagonal_m);
	CHECK(p_summary.get_whole().caster_triangle_count ==
			p_expected.get_whole().caster_triangle_count);
	CHECK(p_summary.get_casters() == p_expected.get_casters());
	CHECK(std::ranges::equal(p_summary.get_caster_hashes(), p_expected.get_caster_hashes()));
}

} // namespace

TEST_CASE("[Shadows] what a frame derives from changed pages equals what it derives from all") {
	SmallScene small(LightType::SPOT);
	SceneSnapshot scene = *small.snap();
	scene.instances = make_instances(50);
	const LightView light_view =
			build_light_views(scene.lights[0], scene, /*p_map_size_px=*/64, /*p_border_px=*/1)[0];
	const LightView camera_view = make_camera_view(scene.camera, glm::uvec2(64));
	SceneSummary summary(scene.instances);
	ViewCulling culling;
	CasterList casters =
			culling.update(scene, summary, summary.get_casters(), light_view, /*p_may_cull=*/true);
	VisibleReceivers receivers = find_visible_receivers(scene, camera_view);
	CHECK(casters.instances.size() > 10);
	CHECK(receivers.list.size() > 10);
	for (int frame = 0; frame < 6; ++frame) {
		CAPTURE(frame);
		const SharedVector<InstanceSnapshot> before = scene.instances;
		switch (frame) {
			case 0: // one at the border, one that becomes the largest
				move(scene.instances.edit(3), { 0, -7, 0 });
				scene.instances.edit(17).set_transform(
						glm::scale(scene.instances[17].world_from_node, glm::dvec3(4.0)));
				break;
			case 1:
				scene.instances.edit(17).casts_shadow = false;
				break;
			case 2: // out of sight and back
				move(scene.instances.edit(49), { 0, 50, 0 });
				move(scene.instances.edit(20), { 50, 0, 0 });
				break;
			case 3:
				move(scene.instances.edit(49), { 0, -50, 0 });
				break;
			case 4:
				scene.instances.push_back(scene.instances[2]);
				break;
			default:
				break; // nothing
		}
		summary.update(scene.instances);
		check_equal(summary, SceneSummary(scene.instances));
		const uint64_t hash_before = casters.content_hash;
		casters = culling.update(
				scene, summary, summary.get_casters(), light_view, /*p_may_cull=*/true);
		const CasterList expected = ViewCulling().update(
				scene, summary, summary.get_casters(), light_view, /*p_may_cull=*/true);
		CHECK(casters.instances == expected.instances);
		CHECK(casters.content_hash == expected.content_hash);
		CHECK((casters.content_hash != hash_before) == (frame < 5));
		for (uint32_t index = 0; index < scene.instances.size(); ++index) {
			const bool casts = scene.instances[index].casts_shadow &&
					light_view.may_see(scene.instances[index]);
			CHECK(std::ranges::binary_search(casters.instances, index) == casts);
		}
		receivers = find_visible_receivers(
				scene, camera_view, receivers, scene.instances.find_changed_pages(before));
		const VisibleReceivers fresh = find_visible_receivers(scene, camera_view);
		REQUIRE(receivers.list.size() == fresh.list.size());
		for (size_t index = 0; index < fresh.list.size(); ++index) {
			CHECK(receivers.list[index].instance_index == fresh.list[index].instance_index);
			check_equal(receivers.list[index].bounds_world, fresh.list[index].bounds_world);
		}
		check_equal(receivers.bounds_world, fresh.bounds_world);
	}
	LightView other_view = light_view;
	other_view.half_extent *= 0.25f;
	const CasterList narrow =
			culling.update(scene, summary, summary.get_casters(), other_view, /*p_may_cull=*/true);
	CHECK(narrow.instances.size() < casters.instances.size());
	CHECK(culling.update(scene, summary, summary.get_casters(), other_view, /*p_may_cull=*/false)
					.instances.size() > casters.instances.size());
}
