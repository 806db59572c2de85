// Deformed casters with every technique: they cast the same shadow as a rigid mesh of that shape.

#include "modules/core/embedded_shaders.h"
#include "modules/core/files.h"
#include "modules/mesh_tools/topology.h"
#include "modules/scene/mesh_pose.h"
#include "modules/shadows/tests/each_technique.h"

#include <cmath>

using namespace gnomon;

namespace {

const int RINGS = 13;
const int SIDES = 10;
// Maximum fraction of wrong pixels, relative to the fraction that changes between two poses.
const double MAX_ERROR_PER_CHANGE = 0.5;
// Maximum fraction of pixels that rounding moves across hard shadow edges.
const double MAX_ROUNDED_FRACTION = 0.004;

/// A tube along y from 0 to 1.2 that follows two joints, with a morph target that makes it thicker
/// at the top. It has caps unless p_is_open.
std::shared_ptr<const Mesh> make_tube(bool p_is_open = false) {
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	MeshRig rig;
	rig.influence_count = 4;
	MorphTarget &target = rig.targets.emplace_back();
	const auto add = [&](const glm::vec3 &p_position) {
		const float fraction = p_position.y / 1.2f;
		positions.push_back(p_position);
		rig.joints.insert(rig.joints.end(), { 0, 1, 0, 0 });
		rig.weights.insert(rig.weights.end(), { 1 - fraction, fraction, 0, 0 });
		target.positions.emplace_back(p_position.x * fraction, 0, p_position.z * fraction);
	};
	for (int ring = 0; ring < RINGS; ++ring) {
		for (int side = 0; side < SIDES; ++side) {
			const double angle_rad = 2 * 3.141592653589793 * side / SIDES;
			add(glm::vec3(0.2 * std::cos(angle_rad), 1.2 * ring / (RINGS - 1),
					0.2 * std::sin(angle_rad)));
		}
	}
	for (uint32_t ring = 0; ring + 1 < uint32_t(RINGS); ++ring) {
		for (uint32_t side = 0; side < uint32_t(SIDES); ++side) {
			const uint32_t a = ring * SIDES + side;
			const uint32_t b = ring * SIDES + (side + 1) % SIDES;
			indices.insert(indices.end(), { a, a + SIDES, b, b, a + SIDES, b + SIDES });
		}
	}
	for (uint32_t side = 1; !p_is_open && side + 1 < uint32_t(SIDES); ++side) {
		const uint32_t top = (RINGS - 1) * SIDES;
		indices.insert(indices.end(), { 0, side, side + 1 });
		indices.insert(indices.end(), { top, top + side + 1, top + side });
	}
	MeshAttributes attributes;
	for (const glm::vec3 &position : positions) {
		attributes.uvs[0].emplace_back(2 * position.y, std::atan2(position.z, position.x));
	}
	attributes.rig = make_mesh_rig(std::move(rig), positions, "tube");
	return make_mesh("tube", positions, {}, indices, attributes);
}

/// The small scene with a tube instead of its box. pose() rotates and moves the tube's upper joint,
/// and sets the weight of its morph target.
struct TubeScene : SmallScene {
	Node3D *joint = nullptr;
	MeshInstance3D *tube = nullptr;

	explicit TubeScene(LightType p_type, const std::shared_ptr<const Mesh> &p_mesh = make_tube()) :
			SmallScene(p_type) {
		scene.root->remove_child(*box);
		tube = &add_mesh(scene, "Tube", p_mesh, { 9, 9, 9 }); // a skinned mesh ignores it
		auto base = std::make_unique<Node3D>();
		base->file_index = 0;
		base->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0.5, 0));
		Node3D *root = scene.root->add_child(std::move(base));
		auto upper = std::make_unique<Node3D>();
		upper->file_index = 1;
		joint = root->add_child(std::move(upper));
		auto skin = std::make_shared<Skin>();
		skin->joints = { 0, 1 };
		skin->joint_from_mesh = { glm::dmat4(1.0), glm::dmat4(1.0) };
		tube->skin = skin;
		tube->morph_weights = { 0 };
	}

	void pose(double p_angle, float p_weight = 0) {
		joint->posed_parent_from_node =
				glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 0.2 * p_angle, 0)),
						p_angle, glm::dvec3(0.3, 0, 1));
		tube->posed_morph_weights = std::vector<float>{ p_weight };
	}

	/// The scene with the posed tube replaced by a rigid mesh of the same shape.
	std::shared_ptr<const SceneSnapshot> bake() const {
		auto baked = std::make_shared<SceneSnapshot>(*snap());
		baked->instances.edit_all([](InstanceSnapshot &r_instance) {
			if (!r_instance.pose) {
				return;
			}
			const auto whole = r_instance.get_posed_mesh();
			MeshAttributes attributes = whole->attributes;
			attributes.rig = nullptr;
			r_instance = make_instance(make_mesh("baked", whole->positions_node,
											   whole->normals_node, whole->indices, attributes),
					r_instance.material, r_instance.world_from_node, r_instance.node_name);
		});
		return baked;
	}
};

/// Returns the maximum difference. r_fraction: fraction of receivers that differ by more than 0.02.
double compute_difference(const MaskResult &p_one, const MaskResult &p_other, double &r_fraction) {
	double max_difference = 0;
	double different = 0;
	double count = 0;
	for (size_t i = 0; i < p_one.visibility.size(); ++i) {
		if (p_one.receiver[i] > 0.5f && p_other.receiver[i] > 0.5f) {
			const double difference = std::abs(double(p_one.visibility[i]) - p_other.visibility[i]);
			max_difference = std::max(max_difference, difference);
			different += difference > 0.02 ? 1 : 0;
			count += 1;
		}
	}
	CHECK(count > 500);
	r_fraction = different / std::max(count, 1.0);
	return max_difference;
}

MaskRequest make_pose_request(
		const std::shared_ptr<const SceneSnapshot> &p_scene, const std::string &p_technique) {
	MaskRequest request;
	request.scene = p_scene;
	request.size_px = glm::uvec2(96);
	request.technique_override = p_technique;
	request.light = "Light";
	return request;
}

} // namespace

TEST_CASE("deformed casters: every technique draws the shadow of the current pose") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		TubeScene scene(p_type);
		use_cheap_settings(*scene.light);
		MaskResult before;
		for (const double angle : { 0.0, 0.9, -1.4 }) {
			CAPTURE(angle);
			scene.pose(angle, angle > 0 ? 0.8f : 0.0f);
			const MaskResult deformed = fixture.render(make_pose_request(scene.snap(), p_info.id));
			MaskFixture other;
			const MaskResult baked = other.render(make_pose_request(scene.bake(), p_info.id));
			double fraction = 0;
			compute_difference(deformed, baked, fraction);
			if (angle == 0) {
				CHECK(fraction < MAX_ROUNDED_FRACTION);
			} else {
				// The bounds of joints are wider than those of vertices, so the maps have different
				// texels.
				double changed = 0;
				compute_difference(deformed, before, changed);
				CHECK(changed > 0.005);
				CHECK(fraction < std::max(MAX_ROUNDED_FRACTION, MAX_ERROR_PER_CHANGE * changed));
			}
			before = deformed;
		}
	});
}

TEST_CASE("deformed casters: cut-outs follow, and several instances keep their own poses") {
	Material material;
	material.alpha_mode = AlphaMode::MASK;
	material.is_double_sided = true;
	std::vector<uint8_t> texels;
	for (int y = 0; y < 32; ++y) {
		for (int x = 0; x < 32; ++x) {
			// Signed distance from the rim of the tile's hole, positive outside.
			const double distance_px =
					glm::distance(glm::dvec2(x % 16, y % 16), glm::dvec2(7.5)) - 4.5;
			texels.insert(texels.end(),
					{ 255, 255, 255,
							uint8_t(std::lround(255 * std::clamp(0.5 + distance_px, 0.0, 1.0))) });
		}
	}
	material.base_color_texture.image = make_image("holes", { 32, 32 }, texels);
	const auto shared_material = std::make_shared<const Material>(material);
	MaskFixture fixture;
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		TubeScene scene(LightType::SPOT, make_tube(/*p_is_open=*/true));
		use_cheap_settings(*scene.light);
		scene.tube->surfaces[0].material = shared_material;
		scene.pose(1.1);
		double fraction = 0;
		double changed = 0;
		const MaskResult posed = fixture.render(make_pose_request(scene.snap(), p_info.id));
		compute_difference(
				posed, fixture.render(make_pose_request(scene.bake(), p_info.id)), fraction);
		scene.pose(0);
		compute_difference(
				posed, fixture.render(make_pose_request(scene.snap(), p_info.id)), changed);
		CHECK(fraction < std::max(MAX_ROUNDED_FRACTION, MAX_ERROR_PER_CHANGE * changed));
		scene.pose(1.1);
		// Another instance of the same mesh, at rest next to it.
		MeshInstance3D &second =
				add_mesh(scene.scene, "Second", scene.tube->surfaces[0].mesh, { -0.9, 0.2, 0.3 });
		second.surfaces[0].material = shared_material;
		compute_difference(fixture.render(make_pose_request(scene.snap(), p_info.id)),
				fixture.render(make_pose_request(scene.bake(), p_info.id)), fraction);
		CHECK(fraction < std::max(MAX_ROUNDED_FRACTION, MAX_ERROR_PER_CHANGE * changed));
	});
}

TEST_CASE("deformed casters: an unchanged pose is cached, and the mask stays the same") {
	MaskFixture fixture;
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		TubeScene scene(LightType::SPOT);
		use_cheap_settings(*scene.light);
		scene.pose(0.6);
		const MaskResult first = fixture.render(make_pose_request(scene.snap(), p_info.id));
		CHECK(first.plan.to_text().find("deform, meshes: 1") != std::string::npos);
		const MaskResult second = fixture.render(make_pose_request(scene.snap(), p_info.id));
		CHECK(second.plan.to_text().find("their pose is the same") != std::string::npos);
		CHECK(second.commands.dispatches <= first.commands.dispatches);
		if (!p_info.is_reference) {
			CHECK(first.visibility == second.visibility);
		}
		MaskRequest request = make_pose_request(scene.snap(), p_info.id);
		request.may_reuse = false;
		const MaskResult all = fixture.render(request);
		CHECK(all.plan.to_text().find("deform, meshes: 1") != std::string::npos);
		if (!p_info.is_reference) {
			CHECK(all.visibility == first.visibility);
		}
	});
}

TEST_CASE("deformed casters: after a frame that was not executed the shadow is that of the pose") {
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		TubeScene scene(LightType::SPOT);
		use_cheap_settings(*scene.light);
		scene.pose(0.9, 0.8f);
		MaskRequest request = make_pose_request(scene.snap(), p_info.id);
		MaskFixture expected;
		MaskFixture fixture;
		request.fails = true;
		CHECK_THROWS_AS(fixture.render(request), Error);
		request.fails = false;
		CHECK(fixture.render(request).visibility == expected.render(request).visibility);
	});
}

TEST_CASE("deformed casters: a pose casts into views that the mesh at rest is outside of") {
	MaskFixture fixture;
	for_each_technique_and_type([&](const ShadowTechniqueInfo &p_info, LightType p_type) {
		TubeScene scene(p_type);
		use_cheap_settings(*scene.light);
		// At rest far below the ground; both joints lift it above.
		scene.joint->parent->parent_from_node[3].y = -50;
		const MaskResult without = fixture.render(make_pose_request(scene.snap(), p_info.id));
		const glm::dmat4 lifted = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0.5, 0));
		scene.joint->parent->posed_parent_from_node = lifted;
		const MaskResult posed = fixture.render(make_pose_request(scene.snap(), p_info.id));
		double fraction = 0;
		compute_difference(without, posed, fraction);
		CHECK(fraction > 0.005);
		for (const bool may_skip : { true, false }) {
			MaskRequest request = make_pose_request(scene.snap(), p_info.id);
			request.may_skip = may_skip;
			const MaskResult all = fixture.render(request);
			compute_difference(all, posed, fraction);
			CHECK(fraction < 0.001);
		}
	});
}

TEST_CASE("deformed casters: joints that flatten a mesh or shrink it to a point give valid masks") {
	MaskFixture fixture;
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		TubeScene scene(LightType::OMNI);
		use_cheap_settings(*scene.light);
		for (const glm::dvec3 &scale :
				{ glm::dvec3(0), glm::dvec3(1, 0, 1), glm::dvec3(-1, 1, 1), glm::dvec3(1e-9) }) {
			scene.joint->posed_parent_from_node = glm::scale(glm::dmat4(1.0), scale);
			const MaskResult mask = fixture.render(make_pose_request(scene.snap(), p_info.id));
			for (const float visibility : mask.visibility) {
				CHECK_UNARY(visibility >= 0.0f && visibility <= 1.0f);
			}
		}
	});
}

TEST_CASE("[GPU][DeformedCasters] a mesh that a vertex program bends casts as it is bent") {
	const std::shared_ptr<const Mesh> tube = make_tube();
	MeshAttributes attributes = tube->attributes;
	MeshRig rig;
	for (const glm::vec2 &uv : attributes.uvs[0]) {
		rig.program_inputs.push_back(compute_value_hash(uv, 1));
	}
	attributes.rig = make_mesh_rig(std::move(rig), tube->positions_node, "tube");
	const auto movable = make_mesh("tube", tube->positions_node, {}, tube->indices, attributes);
	VertexMove move;
	const std::span<const uint32_t> spirv = find_embedded_shader("tests/bend.comp");
	move.program = std::make_shared<const VertexProgram>(
			VertexProgram{ "tests/bend_program", { spirv.begin(), spirv.end() } });
	move.bounds = movable->bounds_node;
	move.bounds.maximum.x += 2;
	const auto slot = std::make_shared<PoseSlot>(movable);
	MaskFixture fixture;
	for_each_technique([&](const ShadowTechniqueInfo &p_info) {
		if (p_info.is_reference || p_info.id.ends_with("_cpu")) {
			return; // no program runs on the CPU
		}
		MaskResult straight;
		for (const float strength : { 0.0f, 0.15f, 0.4f }) {
			CAPTURE(strength);
			move.values = { glm::floatBitsToUint(strength) };
			SmallScene scene(LightType::SPOT);
			use_cheap_settings(*scene.light);
			const glm::dmat4 world_from_node = glm::translate(glm::dmat4(1.0), { 0, 0.3, 0 });
			auto moved = std::make_shared<SceneSnapshot>(*scene.snap());
			auto baked = std::make_shared<SceneSnapshot>(*moved);
			moved->instances.push_back(make_instance(movable, nullptr, world_from_node, "Tube"));
			moved->instances.edit_back().set_pose(slot, slot->make_pose({}, {}, "Tube", move));
			std::vector<glm::vec3> positions = tube->positions_node;
			for (size_t vertex = 0; vertex < positions.size(); ++vertex) {
				const float along = attributes.uvs[0][vertex].x;
				positions[vertex].x += strength * along * along;
			}
			baked->instances.push_back(
					make_instance(make_mesh("bent", positions, {}, tube->indices), nullptr,
							world_from_node, "Bent"));
			// With the same bounds, maps have the same texels.
			baked->instances.edit_back().bounds_world = moved->instances.back().bounds_world;
			baked->instances.edit_back().caster_bounds_node =
					moved->instances.back().caster_bounds_node;
			const MaskResult mask = fixture.render(make_pose_request(moved, p_info.id));
			double fraction = 0;
			compute_difference(mask, fixture.render(make_pose_request(baked, p_info.id)), fraction);
			if (strength == 0) {
				CHECK(fraction < MAX_ROUNDED_FRACTION);
				straight = mask;
				continue;
			}
			double changed = 0;
			compute_difference(mask, straight, changed);
			CHECK(changed > 0.002);
			CHECK(fraction < std::max(MAX_ROUNDED_FRACTION, MAX_ERROR_PER_CHANGE * changed));
		}
	});
}

TEST_CASE("topology: vertices of different joints or targets are not welded, and edges that may "
		  "bend are not coplanar") {
	MeshRig rig;
	rig.influence_count = 4;
	std::vector<glm::vec3> positions;
	for (int i = 0; i < 6; ++i) {
		positions.emplace_back(i % 3 == 1, i % 3 == 2, 0);
		rig.joints.insert(rig.joints.end(), { uint32_t(i == 4), 0, 0, 0 });
		rig.weights.insert(rig.weights.end(), { 1, 0, 0, 0 });
	}
	rig.targets.resize(1);
	rig.targets[0].positions.assign(6, glm::vec3(0));
	rig.targets[0].positions[5].z = 1;
	MeshAttributes attributes;
	attributes.rig = make_mesh_rig(std::move(rig), positions, "mesh");
	const auto mesh = make_mesh("mesh", positions, {}, { 0, 1, 2, 3, 5, 4 }, attributes);
	const auto topology = get_topology(mesh);
	CHECK(topology->welded_positions_node.size() == 5); // only 0 and 3 are welded
	CHECK(topology->is_deformable);
	// Unused joints, their order and repeated joints make no difference.
	MeshRig alike;
	alike.influence_count = 4;
	alike.joints = { 2, 3, 0, 0, 3, 2, 7, 1, 2, 2, 3, 5 };
	alike.weights = { 0.5f, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 0.25f, 0.25f, 0.5f, 0 };
	const auto made = make_mesh_rig(alike, std::vector<glm::vec3>(3), "mesh");
	CHECK(made->compute_vertex_hash(0) == made->compute_vertex_hash(1));
	CHECK(made->compute_vertex_hash(0) == made->compute_vertex_hash(2));
	// A flat quad may bend when it deforms, so its diagonal must not count as coplanar.
	const auto quad = make_mesh("quad", { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } }, {},
			{ 0, 1, 2, 0, 2, 3 });
	const auto count_flat = [](const Mesh &p_mesh) {
		size_t count = 0;
		for (const MeshEdge &edge : build_topology(p_mesh).edges) {
			count += edge.is_coplanar ? 1 : 0;
		}
		return count;
	};
	CHECK(count_flat(*quad) == 1);
	MeshRig bent;
	bent.targets.resize(1);
	attributes.rig = make_mesh_rig(std::move(bent), quad->positions_node, "quad");
	CHECK(count_flat(*make_mesh("quad", quad->positions_node, {}, quad->indices, attributes)) == 0);
}
