#include "modules/core/error.h"
#include "modules/scene/cut_mesh.h"
#include "modules/scene/mesh_pose.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/scene/skin_transforms.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <limits>
#include <random>

using namespace gnomon;

namespace {

const float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

/// A strip of quads along x, 2 m long. Weights blend from joint 0 at its start to joint 1 at its
/// end. Target i at weight 1 raises y by i + 1 times x.
std::shared_ptr<const Mesh> make_strip(uint32_t p_influences = 4, size_t p_targets = 0) {
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	MeshRig rig;
	rig.influence_count = p_influences;
	const int COLUMNS = 9;
	for (int column = 0; column < COLUMNS; ++column) {
		for (int row = 0; row < 2; ++row) {
			positions.emplace_back(0.25f * column, 0, 0.5f * row);
			for (uint32_t i = 0; i < p_influences; ++i) {
				rig.joints.push_back(i % 2);
				const float fraction = float(column) / (COLUMNS - 1);
				rig.weights.push_back(i == 0 ? 1 - fraction : i == 1 ? fraction : 0);
			}
		}
	}
	for (uint32_t column = 0; column + 1 < uint32_t(COLUMNS); ++column) {
		const uint32_t a = 2 * column;
		indices.insert(indices.end(), { a, a + 1, a + 2, a + 2, a + 1, a + 3 });
	}
	for (size_t target = 0; target < p_targets; ++target) {
		MorphTarget &morph = rig.targets.emplace_back();
		for (const glm::vec3 &position : positions) {
			morph.positions.emplace_back(0, position.x * float(target + 1), 0);
		}
	}
	MeshAttributes attributes;
	attributes.rig = make_mesh_rig(std::move(rig), positions, "strip");
	return make_mesh("strip", positions, {}, indices, attributes);
}

/// Returns skinning matrices: joint 0 stays, joint 1 rotates around z through x = 1.
std::vector<glm::dmat4> make_bend(double p_angle_rad) {
	return { glm::dmat4(1.0),
		glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(1, 0, 0)), p_angle_rad,
				glm::dvec3(0, 0, 1)) *
				glm::translate(glm::dmat4(1.0), glm::dvec3(-1, 0, 0)) };
}

/// Returns the error of make_mesh_rig; empty if there is none.
std::string get_rig_error(MeshRig p_rig, size_t p_vertices) {
	try {
		make_mesh_rig(std::move(p_rig), std::vector<glm::vec3>(p_vertices), "mesh \"Body\"");
	} catch (const Error &error) {
		return error.what();
	}
	return "";
}

} // namespace

TEST_CASE("mesh rig: weights are normalized, and an error names an invalid value") {
	MeshRig rig;
	rig.influence_count = 4;
	rig.joints = { 0, 1, 2, 3, 7, 0, 0, 0 };
	rig.weights = { 1, 1, 2, 0, 0, 0, 0, 0 };
	const auto made = make_mesh_rig(rig, std::vector<glm::vec3>(2), "mesh");
	CHECK(made->weights == std::vector<float>{ 0.25f, 0.25f, 0.5f, 0, 1, 0, 0, 0 });
	CHECK(made->joint_count == 8);
	MeshRig bad = rig;
	bad.weights[2] = NOT_A_NUMBER;
	CHECK(get_rig_error(bad, 2).find("mesh \"Body\": weight 2 of vertex 0 is nan, must be 0..1.") ==
			0);
	bad = rig;
	bad.weights[5] = -0.5f;
	CHECK(get_rig_error(bad, 2).find("weight 1 of vertex 1 is -0.5, must be 0..1") !=
			std::string::npos);
	CHECK(get_rig_error(rig, 3).find("has 8 joints and 8 weights, must be 12 each") !=
			std::string::npos);
	bad = rig;
	bad.targets.resize(1);
	bad.targets[0].positions = { glm::vec3(0), glm::vec3(0, NOT_A_NUMBER, 0) };
	CHECK(get_rig_error(bad, 2).find("morph target 0, vertex 1 is not finite") !=
			std::string::npos);
}

TEST_CASE("mesh pose: the weighted sum of the joints transforms vertices") {
	for (const uint32_t influences : { 4u, 8u }) {
		const auto mesh = make_strip(influences, 2);
		const std::vector<glm::dmat4> joints = make_bend(0.7);
		const std::vector<float> weights = { 0.5f, -0.25f };
		const DeformedVertices vertices = deform_vertices(*mesh, joints, weights);
		for (size_t vertex = 0; vertex < mesh->positions_node.size(); ++vertex) {
			const glm::dvec3 rest = mesh->positions_node[vertex];
			// Both targets raise y by x, the second twice as much.
			const glm::dvec4 morphed(rest.x, rest.x * (0.5 - 2 * 0.25), rest.z, 1);
			const double fraction = double(vertex / 2) / 8; // column, of 0..8
			const glm::dvec4 expected =
					(1 - fraction) * (joints[0] * morphed) + fraction * (joints[1] * morphed);
			CHECK(glm::distance(glm::dvec3(vertices.positions[vertex]), glm::dvec3(expected)) <
					1e-6);
			CHECK(glm::length(vertices.normals[vertex]) == doctest::Approx(1));
		}
	}
}

TEST_CASE("mesh pose: bounds enclose all vertices of random poses") {
	const auto mesh = make_strip(4, 3);
	std::mt19937 generator(7);
	std::uniform_real_distribution<double> number(-1, 1);
	for (int round = 0; round < 200; ++round) {
		std::vector<glm::dmat4> joints(2);
		for (glm::dmat4 &joint : joints) {
			for (int element = 0; element < 12; ++element) { // all but the last row
				joint[element / 3][element % 3] = 3 * number(generator);
			}
		}
		std::vector<float> weights;
		for (int i = 0; i < 3; ++i) {
			weights.push_back(float(2 * number(generator)));
		}
		const Bounds bounds = compute_deformed_bounds(*mesh, joints, weights);
		const double rounding = 1e-5;
		for (const glm::vec3 &position : deform_vertices(*mesh, joints, weights).positions) {
			CHECK(bounds.compute_distance(glm::dvec3(position)) <= rounding);
		}
	}
}

TEST_CASE("mesh pose: a slot reuses an unchanged pose, and its meshes") {
	const auto mesh = make_strip();
	PoseSlot slot(mesh);
	const auto one = slot.make_pose(make_bend(0.5), {}, "Node");
	CHECK(slot.make_pose(make_bend(0.5), {}, "Node") == one);
	const auto other = slot.make_pose(make_bend(0.6), {}, "Node");
	CHECK(other != one);
	CHECK(other->get_hash() != one->get_hash());
	const auto deformed = slot.get_deformed(mesh);
	CHECK(slot.get_deformed(mesh) == deformed);
	CHECK(deformed->rest == mesh);
	CHECK(deformed->id != mesh->id);
	CHECK(other->get_mesh(mesh) == other->get_mesh(mesh));
	CHECK(other->get_mesh(mesh)->positions_node != mesh->positions_node);
	for (int round = 0; round < 300; ++round) { // a mesh that nothing uses is dropped
		slot.make_pose(make_bend(round), {}, "Node");
		if (round == 50) {
			CHECK(slot.get_deformed(mesh) == deformed);
		}
	}
	CHECK(slot.get_deformed(mesh) != deformed);
}

TEST_CASE("mesh pose: a pose that is not finite or beyond 1e18 m is an error that names its node") {
	const auto mesh = make_strip();
	for (const double scale : { 1e300, double(NOT_A_NUMBER), -1e19 }) {
		std::string message;
		try {
			MeshPose(mesh, { glm::dmat4(1.0), glm::scale(glm::dmat4(1.0), glm::dvec3(scale)) }, {},
					"Node \"Body\"");
		} catch (const Error &error) {
			message = error.what();
		}
		CAPTURE(message);
		CHECK((message.find("Node \"Body\": its pose moves vertices to ") == 0 ||
				message.find("Node \"Body\": the transform of joint 1 of its skin is not finite") ==
						0));
	}
	// Joints that collapse a mesh to a point are allowed.
	const glm::dmat4 flat = glm::scale(glm::dmat4(1.0), glm::dvec3(0));
	const MeshPose pose(mesh, { flat, flat }, {}, "Node");
	for (const glm::vec3 &normal : pose.get_mesh(mesh)->normals_node) {
		CHECK(glm::length(normal) == doctest::Approx(1));
	}
}

TEST_CASE("mesh pose: a cut mesh follows the triangles of its source") {
	Material material;
	material.alpha_mode = AlphaMode::MASK;
	std::vector<uint8_t> texels;
	for (int y = 0; y < 16; ++y) {
		for (int x = 0; x < 16; ++x) {
			// A round hole of radius 5 texels: its edge is where alpha is 0.5.
			const double outside_px = glm::distance(glm::dvec2(x, y), glm::dvec2(7.5)) - 5;
			texels.insert(texels.end(),
					{ 255, 255, 255,
							uint8_t(std::lround(255 * std::clamp(0.5 + outside_px, 0.0, 1.0))) });
		}
	}
	material.base_color_texture.image = make_image("hole", { 16, 16 }, texels);
	const auto strip = make_strip();
	MeshAttributes attributes = strip->attributes;
	for (const glm::vec3 &position : strip->positions_node) {
		attributes.uvs[0].emplace_back(position.x / 2, position.z * 2);
	}
	const auto mesh = make_mesh("strip", strip->positions_node, {}, strip->indices, attributes);
	const auto cut = cut_mesh(mesh, material).mesh;
	REQUIRE(cut);
	REQUIRE(cut != mesh);
	REQUIRE(cut->source.points.size() == cut->positions_node.size());
	const MeshPose rest(mesh, { glm::dmat4(1.0), glm::dmat4(1.0) }, {}, "Node");
	const auto same = rest.get_mesh(cut);
	const MeshPose bent(mesh, make_bend(1.0), {}, "Node");
	const auto moved = bent.get_mesh(cut);
	const auto uncut = bent.get_mesh(mesh);
	for (size_t triangle = 0; triangle < cut->get_triangle_count(); ++triangle) {
		const uint32_t *source = &uncut->indices[3 * cut->source.triangles[triangle]];
		const glm::dvec3 a = uncut->positions_node[source[0]];
		const glm::dvec3 normal =
				glm::normalize(glm::cross(glm::dvec3(uncut->positions_node[source[1]]) - a,
						glm::dvec3(uncut->positions_node[source[2]]) - a));
		for (size_t corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
			const uint32_t vertex = cut->indices[corner];
			CHECK(glm::distance(same->positions_node[vertex], cut->positions_node[vertex]) < 1e-6f);
			// In the plane of the posed source triangle.
			CHECK(std::abs(glm::dot(glm::dvec3(moved->positions_node[vertex]) - a, normal)) < 1e-6);
		}
	}
}

TEST_CASE("skin: a mesh is where its joints are, wherever its node is") {
	Scene scene;
	const auto add = [&](Node3D &r_parent, std::unique_ptr<Node3D> p_node, int p_index) {
		p_node->file_index = p_index;
		p_node->name = "Node " + std::to_string(p_index);
		return r_parent.add_child(std::move(p_node));
	};
	Node3D *frame = add(*scene.root, std::make_unique<Node3D>(), 0);
	frame->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(1e6, 0, 0));
	Node3D *joint0 = add(*frame, std::make_unique<Node3D>(), 1);
	Node3D *joint1 = add(*joint0, std::make_unique<Node3D>(), 2);
	joint1->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(1, 0, 0));
	auto skin = std::make_shared<Skin>();
	skin->joints = { 1, 2 };
	skin->joint_from_mesh = { glm::dmat4(1.0),
		glm::translate(glm::dmat4(1.0), glm::dvec3(-1, 0, 0)) };
	skin->frame = 0;
	auto made = std::make_unique<MeshInstance3D>();
	made->surfaces.push_back({ make_strip(), nullptr });
	made->skin = skin;
	auto &node = static_cast<MeshInstance3D &>(*add(*scene.root, std::move(made), 3));
	Camera3D camera;
	const auto before = build_snapshot(scene, camera);
	REQUIRE(before->instances.size() == 1);
	CHECK(before->instances[0].bounds_world.minimum.x == doctest::Approx(1e6).epsilon(1e-10));
	CHECK(before->instances[0].bounds_world.maximum.x == doctest::Approx(1e6 + 2).epsilon(1e-10));
	node.parent_from_node = glm::scale(glm::dmat4(1.0), glm::dvec3(0)); // has no effect
	const auto same = build_snapshot(scene, camera);
	CHECK(same->instances[0].pose == before->instances[0].pose);
	CHECK(node.compute_bounds().minimum.x == doctest::Approx(1e6).epsilon(1e-10));
	SUBCASE("if the frame moves, the pose is reused") {
		frame->parent_from_node[3].y = 5;
		const auto moved = build_snapshot(scene, camera);
		CHECK(moved->instances[0].pose == before->instances[0].pose);
		CHECK(moved->instances[0].mesh == before->instances[0].mesh);
		CHECK(moved->instances[0].bounds_world.minimum.y == doctest::Approx(5));
		CHECK(moved->instances[0].compute_hash(1) != before->instances[0].compute_hash(1));
	}
	SUBCASE("if a joint rotates, the pose changes and the meshes are reused") {
		joint1->posed_parent_from_node =
				glm::rotate(joint1->parent_from_node, 0.5, glm::dvec3(0, 0, 1));
		const auto bent = build_snapshot(scene, camera);
		CHECK(bent->instances[0].pose != before->instances[0].pose);
		CHECK(bent->instances[0].mesh == before->instances[0].mesh);
		CHECK(bent->instances[0].compute_hash(1) != before->instances[0].compute_hash(1));
		CHECK(bent->instances[0].bounds_world.maximum.y > 0.3); // the end is at sin(0.5) = 0.48
	}
	SUBCASE("the vertices of a deleted joint stay at rest") {
		joint0->remove_child(*joint1);
		const auto left = build_snapshot(scene, camera);
		REQUIRE(left->instances.size() == 1);
		CHECK(left->instances[0].bounds_world.minimum.x == doctest::Approx(1e6).epsilon(1e-10));
		CHECK(left->instances[0].bounds_world.maximum.x == doctest::Approx(1e6 + 2).epsilon(1e-10));
	}
	SUBCASE("the world replaces a frame without an inverse") {
		frame->parent_from_node = glm::scale(glm::dmat4(1.0), glm::dvec3(0));
		CHECK(build_snapshot(scene, camera)->instances[0].world_from_node == glm::dmat4(1.0));
	}
}
