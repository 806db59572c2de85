// Tests which casters occlusion culling culls, and that the image never changes.

#include "modules/shadow_volume/culling_boxes.h"
#include "modules/shadow_volume/tests/volume_fixture.h"

#include <random>
#include <set>

using namespace gnomon;

namespace {

const std::string HIDDEN = "others hide them from the light";

double draw_uniform(std::mt19937 &r_random, double p_min, double p_max) {
	return std::uniform_real_distribution<double>(p_min, p_max)(r_random);
}

/// Returns the number of culled casters that the frame plan reports; 0 if it reports none.
size_t read_hidden_count(const MaskResult &p_frame) {
	const std::string plan = p_frame.plan.to_text();
	const size_t reason = plan.find(HIDDEN);
	if (reason == std::string::npos) {
		return 0;
	}
	const std::string start = "volumes of ";
	return std::stoul(plan.substr(plan.rfind(start, reason) + start.size()));
}

MaskResult render_culled(MaskFixture &r_fixture, SmallScene &r_scene, const char *p_mode,
		const char *p_extrusion = "auto") {
	return render_volumes(r_fixture, r_scene,
			{ { "culling", std::string(p_mode) }, { "extrusion", std::string(p_extrusion) } });
}

/// An upright wall between the light and rows of small boxes on the ground. One more row of boxes
/// is on the wall's lit side.
struct WallScene : SmallScene {
	MeshInstance3D *wall = nullptr;
	MeshInstance3D *last = nullptr;
	static constexpr size_t COUNT_BEHIND = 60;
	static constexpr size_t COUNT_BEFORE = 12;

	explicit WallScene(LightType p_type = LightType::SPOT) : SmallScene(p_type) {
		box->parent_from_node = glm::translate(glm::dmat4(1.0), { -2.4, 0.31, 0 });
		light->parent_from_node = look_at({ 3.2, 2.2, 0.1 }, { 0, 0.4, 0 });
		wall = &add_mesh(scene, "Wall", make_box_mesh("wall", glm::vec3(0.05f, 0.9f, 1.6f)),
				{ 0.8, 0.9, 0 });
		const auto small = make_box_mesh("small", glm::vec3(0.05f, 0.08f, 0.05f));
		for (size_t i = 0; i < COUNT_BEHIND; ++i) {
			last = &add_mesh(scene, text("Behind ", i), small,
					{ 0.5 - 0.2 * double(i / 12), 0.1, -0.8 + 1.6 * double(i % 12) / 11 });
		}
		for (size_t i = 0; i < COUNT_BEFORE; ++i) {
			add_mesh(scene, text("Before ", i), small,
					{ 1.3, 0.1, -0.8 + 1.6 * double(i) / (COUNT_BEFORE - 1) });
		}
	}
};

void check_equal_masks(const MaskResult &p_one, const MaskResult &p_other) {
	CHECK(p_one.visibility == p_other.visibility);
}

/// Adds random casters of every mesh class and size, some as large as walls, some touching, some
/// inside others.
void add_random_casters(SmallScene &r_scene, std::mt19937 &r_random) {
	const std::vector<std::shared_ptr<const Mesh>> meshes = { make_box_mesh("box", glm::vec3(0.5f)),
		make_box_mesh("plate", glm::vec3(1, 0.6f, 0.01f)),
		share_mesh("sphere", test_meshes::make_sphere(2)),
		share_mesh("quad", test_meshes::make_quad()),
		share_mesh("moebius", test_meshes::make_moebius(12)),
		share_mesh("soup", test_meshes::make_soup(5, 20, 24)) };
	for (int i = 0; i < 120; ++i) {
		const size_t kind = r_random() % meshes.size();
		const double size =
				i < 12 ? draw_uniform(r_random, 0.5, 1.2) : draw_uniform(r_random, 0.02, 0.2);
		MeshInstance3D &node = add_mesh(r_scene.scene, text("Caster ", i), meshes[kind],
				{ draw_uniform(r_random, -2, 1), draw_uniform(r_random, 0, 2),
						draw_uniform(r_random, -2, 2) });
		node.parent_from_node =
				glm::rotate(glm::scale(node.parent_from_node,
									glm::dvec3(r_random() % 2 == 0 ? size : -size, size, size)),
						draw_uniform(r_random, 0, 3),
						{ 0.3, draw_uniform(r_random, -1, 1), draw_uniform(r_random, -1, 1) });
	}
}

} // namespace

TEST_CASE("[ShadowVolume] every box is in one subtree, and inside the subtree's box") {
	std::mt19937 random(3);
	std::vector<Bounds> boxes(1000);
	for (Bounds &box : boxes) {
		box.add(glm::dvec3(draw_uniform(random, -9, 9), draw_uniform(random, -9, 9),
				draw_uniform(random, -9, 9)));
		box.add(box.minimum +
				glm::dvec3(draw_uniform(random, 0, 1), draw_uniform(random, 0, 1), 0.2));
	}
	boxes[17] = Bounds(); // empty: in no subtree
	const glm::dvec3 origin(100, 200, -300);
	const CullingBoxes found = build_culling_boxes(boxes, origin);
	CHECK(found.subtree_count >= 1000 / CULLING_CASTERS_PER_SUBTREE);
	CHECK(found.subtree_count < 200); // on average at least 5 boxes
	std::set<uint32_t> seen;
	bool are_all_inside = true;
	for (uint32_t i = 0; i < found.subtree_count; ++i) {
		const shader::CullingBox &subtree = found.boxes[i];
		CHECK(subtree.count <= CULLING_CASTERS_PER_SUBTREE);
		for (uint32_t j = 0; j < subtree.count; ++j) {
			const shader::CullingBox &box = found.boxes[subtree.first + j];
			CHECK(seen.insert(box.first).second);
			const glm::dvec3 centre = 0.5 * (boxes[box.first].minimum + boxes[box.first].maximum);
			are_all_inside = are_all_inside &&
					glm::distance(glm::dvec3(box.center_m), centre - origin) < 1e-4;
			for (int axis = 0; axis < 3; ++axis) {
				const float distance = std::abs(box.center_m[axis] - subtree.center_m[axis]);
				are_all_inside = are_all_inside &&
						distance + box.half_extent_m[axis] <= subtree.half_extent_m[axis] + 1e-4f;
			}
		}
	}
	CHECK(are_all_inside);
	CHECK(seen.size() == boxes.size() - 1);
	CHECK(seen.count(17) == 0);
	CHECK(build_culling_boxes({}, origin).subtree_count == 0);
}

TEST_CASE("[GPU][ShadowVolume] casters behind a wall are culled, without a change of the image") {
	for (const LightType type : ALL_TYPES) {
		CAPTURE(std::string(get_light_type_name(type)));
		MaskFixture fixture;
		WallScene scene(type);
		const MaskResult all = render_culled(fixture, scene, "off");
		CHECK(read_hidden_count(all) == 0);
		// The GPU's predicates decide which casters are drawn. 75: the small boxes, the wall, and
		// the scene's box and ground.
		const MaskResult first = render_culled(fixture, scene, "auto");
		CHECK(first.plan.to_text().find("occlusion culling, casters: 75") != std::string::npos);
		check_equal_masks(first, all);
		// Hidden casters are culled by the first frame's result.
		const MaskResult second = render_culled(fixture, scene, "auto");
		CHECK(second.plan.to_text().find("occlusion culling, casters") == std::string::npos);
		// The wall hides all boxes behind it, but the conservative test may miss a few.
		CHECK(read_hidden_count(second) >= WallScene::COUNT_BEHIND - 6);
		CHECK(read_hidden_count(second) <= WallScene::COUNT_BEHIND + 1); // and the scene's box
		check_equal_masks(second, all);
		scene.camera->parent_from_node = look_at({ 2.8, 1.2, 2.0 }, { 0.2, 0.3, 0 });
		// The result stays valid when the camera moves.
		const MaskResult elsewhere = render_culled(fixture, scene, "auto");
		CHECK(read_hidden_count(elsewhere) == read_hidden_count(second));
		check_equal_masks(elsewhere, render_culled(fixture, scene, "off"));
	}
}

TEST_CASE(
		"[GPU][ShadowVolume] a caster that comes out from behind its wall has its shadow at once") {
	MaskFixture fixture;
	WallScene scene;
	render_culled(fixture, scene, "auto");
	CHECK(read_hidden_count(render_culled(fixture, scene, "auto")) > 0);
	for (int step = 0; step < 6; ++step) {
		CAPTURE(step);
		scene.last->parent_from_node =
				glm::translate(glm::dmat4(1.0), { 0.2 - 0.1 * step, 0.1 + 0.3 * step, 1.3 });
		for (const char *extrusion : { "compute", "geometry_shader" }) {
			const MaskResult culled = render_culled(fixture, scene, "auto", extrusion);
			check_equal_masks(culled, render_culled(fixture, scene, "off", extrusion));
		}
	}
	scene.wall->parent_from_node = glm::translate(glm::dmat4(1.0), { 0.8, 0.9, 2.9 });
	check_equal_masks(render_culled(fixture, scene, "auto"), render_culled(fixture, scene, "off"));
}

TEST_CASE("[GPU][ShadowVolume] random casters: culling never changes the image") {
	MaskFixture fixture;
	std::mt19937 random(11);
	size_t hidden_count = 0;
	for (int round = 0; round < 12; ++round) {
		CAPTURE(round);
		SmallScene scene(ALL_TYPES[round % 3]);
		add_random_casters(scene, random);
		const glm::dvec3 from(draw_uniform(random, -3, 3), draw_uniform(random, 0.3, 4),
				draw_uniform(random, -3, 3));
		scene.light->parent_from_node = look_at(from, { draw_uniform(random, -1, 1), 0.5, 0 });
		const MaskResult all = render_culled(fixture, scene, "off");
		check_equal_masks(render_culled(fixture, scene, "on"), all);
		const MaskResult known = render_culled(fixture, scene, "on"); // with the result above
		check_equal_masks(known, all);
		hidden_count += read_hidden_count(known);
	}
	MESSAGE("hidden of 1464: ", hidden_count); // 12 rounds with 122 casters
	CHECK(hidden_count > 100);
}

TEST_CASE("[GPU][ShadowVolume] culling pauses where hardly a caster is hidden, and can be "
		  "turned off") {
	MaskFixture fixture;
	WallScene scene;
	scene.wall->parent_from_node = glm::translate(glm::dmat4(1.0), { -2.8, 0.9, 0 });
	const auto move_light = [&](double p_offset_m) {
		scene.light->parent_from_node = look_at({ 3.2, 2.2, 0.1 + p_offset_m }, { 0, 0.4, 0 });
	};
	const auto render_plan = [&](const char *p_mode) {
		return render_culled(fixture, scene, p_mode).plan.to_text();
	};
	const auto has = [](const std::string &p_plan, const char *p_text) {
		return p_plan.find(p_text) != std::string::npos;
	};
	CHECK(has(render_plan("auto"), "occlusion culling, casters: 75"));
	move_light(0.01);
	CHECK(has(render_plan("auto"), "few casters were hidden in recent frames"));
	CHECK(has(render_plan("on"), "occlusion culling, casters: 75"));
	for (int frame = 0; frame < 60; ++frame) { // the length of the pause
		move_light(0.01 + 0.001 * frame);
		render_plan("auto");
	}
	move_light(0.2);
	CHECK(has(render_plan("auto"), "occlusion culling, casters: 75"));
	CHECK_FALSE(has(render_plan("off"), "occlusion culling"));

	SmallScene few;
	CHECK(has(render_culled(fixture, few, "auto").plan.to_text(), "few casters"));
}

TEST_CASE("[GPU][ShadowVolume] hidden casters are culled later without conditional rendering") {
	MaskFixture fixture("", { &DeviceFeatures::conditional_rendering });
	WallScene scene;
	const MaskResult all = render_culled(fixture, scene, "off");
	const MaskResult first = render_culled(fixture, scene, "auto");
	CHECK(first.plan.to_text().find("needs conditional rendering") != std::string::npos);
	check_equal_masks(first, all);
	check_equal_masks(
			render_culled(fixture, scene, "auto"), all); // nothing moved: casters are tested
	const MaskResult known = render_culled(fixture, scene, "auto");
	CHECK(read_hidden_count(known) > 0);
	check_equal_masks(known, all);
}

TEST_CASE("[GPU][ShadowVolume] the image stays the same when the order of culled casters changes") {
	MaskFixture fixture;
	WallScene scene(LightType::OMNI);
	render_culled(fixture, scene, "on");
	CHECK(read_hidden_count(render_culled(fixture, scene, "on")) > 0);
	auto &children = scene.scene.root->children;
	std::reverse(children.begin(), children.end());
	check_equal_masks(render_culled(fixture, scene, "on"), render_culled(fixture, scene, "off"));
}

TEST_CASE(
		"[GPU][ShadowVolume] occluders that the light's near plane cuts do not change the image") {
	MaskFixture fixture;
	std::mt19937 random(5);
	size_t hidden_count = 0;
	for (int round = 0; round < 9; ++round) {
		CAPTURE(round);
		WallScene scene(ALL_TYPES[round % 3]);
		// A large scene size: near plane 3e-5 m, receiver offset 0.15 m.
		scene.scene.scene_size_m = 3000.0;
		const double gap = draw_uniform(random, 0.05, 0.5);
		scene.light->parent_from_node =
				look_at({ 0.9 + gap, draw_uniform(random, 0.6, 1.6), 0.1 }, { -0.5, 0.1, 0 });
		scene.wall->parent_from_node = glm::rotate(glm::translate(glm::dmat4(1.0), { 0.8, 0.9, 0 }),
				draw_uniform(random, -0.4, 0.4),
				{ draw_uniform(random, -1, 1), draw_uniform(random, -1, 1), 1 });
		const MaskResult all = render_culled(fixture, scene, "off");
		check_equal_masks(render_culled(fixture, scene, "on"), all);
		const MaskResult known = render_culled(fixture, scene, "on");
		check_equal_masks(known, all);
		hidden_count += read_hidden_count(known);
	}
	CHECK(hidden_count > 50);
}

TEST_CASE("[GPU][ShadowVolume] meshes whose vertices are far from their node's origin "
		  "hide no visible caster") {
	MaskFixture fixture;
	for (const double offset_m : { 1e2, 1e4, 1e5 }) {
		CAPTURE(offset_m);
		WallScene scene;
		const glm::vec3 offset(static_cast<float>(offset_m));
		const Mesh &wall = *scene.wall->surfaces[0].mesh;
		std::vector<glm::vec3> positions = wall.positions_node;
		for (glm::vec3 &position : positions) {
			position += offset;
		}
		scene.wall->surfaces[0].mesh = make_mesh("far wall", positions, {}, wall.indices);
		scene.wall->parent_from_node =
				glm::translate(scene.wall->parent_from_node, -glm::dvec3(offset));
		const MaskResult all = render_culled(fixture, scene, "off");
		check_equal_masks(render_culled(fixture, scene, "on"), all);
		const MaskResult known = render_culled(fixture, scene, "on");
		check_equal_masks(known, all);
		// With vertices that far away, the wall is not precise enough to be an occluder.
		CHECK((read_hidden_count(known) > 0) == (offset_m < 1e4));
	}
}
