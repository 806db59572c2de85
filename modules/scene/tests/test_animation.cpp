#include "modules/core/error.h"
#include "modules/scene/animation_playback.h"
#include "modules/scene/box_mesh.h"
#include "modules/scene/scene_snapshot.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

using namespace gnomon;

namespace {

const double ROUNDING = 1e-12; // relative, of doubles
// Values of p_is_rotation of AnimationSampler::sample.
const bool NUMBERS = false;
const bool ROTATION = true;

AnimationSampler make_sampler(Interpolation p_interpolation, std::vector<float> p_times,
		uint32_t p_components, std::vector<float> p_values) {
	return { p_interpolation, std::move(p_times), p_components, std::move(p_values) };
}

/// Adds a node with a file index below the root.
Node3D &add_node(Scene &r_scene, std::unique_ptr<Node3D> p_node, int p_index) {
	p_node->name = "Node " + std::to_string(p_index);
	p_node->file_index = p_index;
	return *r_scene.root->add_child(std::move(p_node));
}

std::shared_ptr<Animation> make_animation(std::vector<AnimationChannel> p_channels) {
	auto animation = std::make_shared<Animation>();
	animation->name = "Move";
	animation->channels = std::move(p_channels);
	for (const AnimationChannel &channel : animation->channels) {
		AnimatedNode node;
		node.node = channel.node;
		animation->nodes.push_back(node);
		animation->duration_s =
				std::max(animation->duration_s, double(channel.sampler.times_s.back()));
	}
	return animation;
}

} // namespace

TEST_CASE("animation: STEP keeps each value until the next time") {
	const AnimationSampler sampler =
			make_sampler(Interpolation::STEP, { 0.5f, 1, 2 }, 1, { 3, 5, 9 });
	CHECK(sampler.sample(-1, NUMBERS)[0] == 3);
	CHECK(sampler.sample(0.5, NUMBERS)[0] == 3);
	CHECK(sampler.sample(0.999, NUMBERS)[0] == 3);
	CHECK(sampler.sample(1, NUMBERS)[0] == 5);
	CHECK(sampler.sample(1.9, NUMBERS)[0] == 5);
	CHECK(sampler.sample(2, NUMBERS)[0] == 9);
	CHECK(sampler.sample(7, NUMBERS)[0] == 9);
}

TEST_CASE("animation: LINEAR interpolates vectors, and is clamped at both ends") {
	const AnimationSampler sampler =
			make_sampler(Interpolation::LINEAR, { 1, 3 }, 3, { 0, 2, 4, 8, -2, 4 });
	CHECK(sampler.sample(0, NUMBERS) == std::vector<double>{ 0, 2, 4 });
	CHECK(sampler.sample(1.5, NUMBERS) == std::vector<double>{ 2, 1, 4 });
	CHECK(sampler.sample(2, NUMBERS) == std::vector<double>{ 4, 0, 4 });
	CHECK(sampler.sample(9, NUMBERS) == std::vector<double>{ 8, -2, 4 });
}

TEST_CASE("animation: LINEAR rotations have constant speed on the shorter arc, for any sign") {
	const double angle = 2.0;
	for (const double sign : { 1.0, -1.0 }) {
		CAPTURE(sign);
		const AnimationSampler sampler = make_sampler(Interpolation::LINEAR, { 0, 1 }, 4,
				{ 0, 0, 0, 1, 0, float(sign * std::sin(angle / 2)), 0,
						float(sign * std::cos(angle / 2)) });
		for (const double t : { 0.1, 0.25, 0.5, 0.9 }) {
			const std::vector<double> rotation = sampler.sample(t, ROTATION);
			// A quaternion has the half angle, t * angle / 2. Keys are floats.
			CHECK(std::abs(rotation[1]) == doctest::Approx(std::sin(t * angle / 2)).epsilon(1e-6));
			CHECK(std::abs(rotation[3]) == doctest::Approx(std::cos(t * angle / 2)).epsilon(1e-6));
			CHECK(rotation[1] * rotation[3] > 0);
			CHECK(rotation[0] * rotation[0] + rotation[1] * rotation[1] +
							rotation[2] * rotation[2] + rotation[3] * rotation[3] ==
					doctest::Approx(1).epsilon(ROUNDING));
		}
	}
}

TEST_CASE("animation: CUBICSPLINE is a Hermite spline with tangents per second") {
	// The cubic t^3 - 2 t + 1 from 1 s to 3 s, which Hermite's form reproduces. 77 and 99 are the
	// tangents before the first and after the last key, which have no effect.
	const auto value = [](double p_t) { return p_t * p_t * p_t - 2 * p_t + 1; };
	const auto slope = [](double p_t) { return 3 * p_t * p_t - 2; };
	const AnimationSampler sampler = make_sampler(Interpolation::CUBIC_SPLINE, { 1, 3 }, 1,
			{ 77, float(value(1)), float(slope(1)), float(slope(3)), float(value(3)), 99 });
	for (const double t : { 1.0, 1.3, 2.0, 2.7, 3.0 }) {
		CHECK(sampler.sample(t, NUMBERS)[0] == doctest::Approx(value(t)).epsilon(ROUNDING));
	}
	CHECK(sampler.sample(0, NUMBERS)[0] == value(1));
	CHECK(sampler.sample(4, NUMBERS)[0] == value(3));
	// An interpolated rotation is normalized.
	const AnimationSampler rotation = make_sampler(Interpolation::CUBIC_SPLINE, { 0, 1 }, 4,
			{ 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0 });
	const std::vector<double> half = rotation.sample(0.5, ROTATION);
	CHECK(half[1] == doctest::Approx(std::sqrt(0.5)).epsilon(ROUNDING));
	CHECK(half[3] == doctest::Approx(std::sqrt(0.5)).epsilon(ROUNDING));
}

TEST_CASE("animation: channels pose nodes and weights, and do not change what is saved") {
	Scene scene;
	Node3D &node = add_node(scene, std::make_unique<Node3D>(), 3);
	auto mesh_node = std::make_unique<MeshInstance3D>();
	mesh_node->surfaces.push_back({ make_box_mesh("box", glm::vec3(1)), nullptr });
	mesh_node->morph_weights = { 0.25f, 0.5f };
	auto &instance = static_cast<MeshInstance3D &>(add_node(scene, std::move(mesh_node), 5));
	const auto animation = make_animation({
			{ 3, AnimatedPath::TRANSLATION,
					make_sampler(Interpolation::LINEAR, { 0, 2 }, 3, { 0, 0, 0, 4, 6, 8 }) },
			{ 3, AnimatedPath::SCALE,
					make_sampler(Interpolation::STEP, { 0, 1 }, 3, { 1, 1, 1, 2, 3, 4 }) },
			{ 5, AnimatedPath::WEIGHTS,
					make_sampler(Interpolation::LINEAR, { 0, 2 }, 2, { 0, 1, 1, 0 }) },
	});
	pose_scene(scene, animation.get(), 1);
	const glm::dmat4 posed =
			glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(2, 3, 4)), glm::dvec3(2, 3, 4));
	CHECK(node.get_parent_from_node() == posed);
	CHECK(node.compute_world_from_node() == posed);
	CHECK(node.parent_from_node == glm::dmat4(1.0));
	CHECK(instance.get_morph_weights() == std::vector<float>{ 0.5f, 0.5f });
	CHECK(instance.morph_weights == std::vector<float>{ 0.25f, 0.5f });
	CHECK_FALSE(instance.posed_parent_from_node);
	SUBCASE("a copy of a node is at rest") {
		CHECK_FALSE(node.copy()->posed_parent_from_node);
	}
	SUBCASE("a component without a channel is the one that the user set") {
		node.parent_from_node = glm::scale(
				glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(0, 1, 0)), glm::dvec3(-2, 1, 1));
		pose_scene(scene, animation.get(), 0);
		const glm::dmat3 axes(node.get_parent_from_node());
		CHECK(glm::length(axes[0]) == doctest::Approx(1)); // animated
		CHECK(std::abs(axes[0].x) == doctest::Approx(std::cos(0.5)));
	}
	SUBCASE("without an animation, nodes have their own transforms and weights") {
		pose_scene(scene, nullptr, 1);
		CHECK(node.get_parent_from_node() == glm::dmat4(1.0));
		CHECK(instance.get_morph_weights() == instance.morph_weights);
	}
}

TEST_CASE("animation: playback loops forwards and backwards") {
	Scene scene;
	Node3D &node = add_node(scene, std::make_unique<Node3D>(), 0);
	AnimationPlayback playback;
	playback.animation = make_animation({ { 0, AnimatedPath::TRANSLATION,
			make_sampler(Interpolation::LINEAR, { 0, 2 }, 3, { 0, 0, 0, 2, 0, 0 }) } });
	const auto get_x = [&] { return node.get_parent_from_node()[3].x; };
	playback.advance(scene, 0.5);
	CHECK(get_x() == doctest::Approx(0.5));
	playback.advance(scene, 1.75);
	CHECK(get_x() == doctest::Approx(0.25));
	playback.speed = -2;
	playback.advance(scene, 0.25);
	CHECK(get_x() == doctest::Approx(1.75));
	playback.is_playing = false;
	playback.advance(scene, 10);
	CHECK(get_x() == doctest::Approx(1.75));
	playback.animation = nullptr;
	playback.advance(scene, 1);
	CHECK(get_x() == 0);
}

TEST_CASE("animation: an unknown name is an error that lists the existing ones") {
	Scene scene;
	CHECK(find_animation(scene, "") == nullptr);
	scene.animations = { make_animation({}), make_animation({}) };
	CHECK(find_animation(scene, "") == scene.animations[0]);
	CHECK(find_animation(scene, "Move") == scene.animations[0]);
	std::string message;
	try {
		find_animation(scene, "Run");
	} catch (const Error &error) {
		message = error.what();
	}
	CHECK(message.find("has no animation \"Run\". Name one of these: \"Move\", \"Move\".") !=
			std::string::npos);
}

TEST_CASE("animation: the size of the scene does not change with the pose") {
	Scene scene;
	auto mesh_node = std::make_unique<MeshInstance3D>();
	mesh_node->surfaces.push_back({ make_box_mesh("box", glm::vec3(1)), nullptr });
	add_node(scene, std::move(mesh_node), 0);
	Camera3D camera;
	const double size_m = build_snapshot(scene, camera)->scene_size_m;
	const auto animation = make_animation({ { 0, AnimatedPath::SCALE,
			make_sampler(Interpolation::LINEAR, { 0, 1 }, 3, { 1, 1, 1, 9, 9, 9 }) } });
	pose_scene(scene, animation.get(), 1);
	const auto posed = build_snapshot(scene, camera);
	CHECK(posed->scene_size_m == size_m);
	CHECK(posed->compute_bounds().get_diagonal() == doctest::Approx(9 * size_m));
}
