#include "modules/scene/animation.h"

#include "modules/core/error.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace gnomon {

namespace {

glm::dquat to_quaternion(const std::vector<double> &p_values) {
	return glm::dquat(p_values[3], p_values[0], p_values[1], p_values[2]);
}

std::vector<double> to_values(const glm::dquat &p_quaternion) {
	return { p_quaternion.x, p_quaternion.y, p_quaternion.z, p_quaternion.w };
}

std::vector<double> normalize(std::vector<double> p_rotation) {
	double square = 0;
	for (const double component : p_rotation) {
		square += component * component;
	}
	if (!(square > 0)) {
		return { 0, 0, 0, 1 };
	}
	for (double &component : p_rotation) {
		component /= std::sqrt(square);
	}
	return p_rotation;
}

glm::dvec3 to_vector(const std::vector<double> &p_values) {
	return glm::dvec3(p_values[0], p_values[1], p_values[2]);
}

/// Returns the file's translation, rotation and scale if the node's matrix still equals them;
/// otherwise it decomposes the matrix that the user has set. The file's components are preferred
/// because a matrix does not store which axis is mirrored; decomposition assumes x.
NodeTransform choose_components(const NodeTransform &p_file_transform, const Node3D &p_node) {
	return p_file_transform.compose() == p_node.parent_from_node
			? p_file_transform
			: decompose_transform(p_node.parent_from_node);
}

void pose_node(const AnimatedNodePose &p_pose, double p_time_s) {
	const AnimationChannel *weights = nullptr;
	bool is_moved = false;
	Node3D &node = *p_pose.node;
	for (const AnimationChannel *channel : p_pose.channels) {
		weights = channel->path == AnimatedPath::WEIGHTS ? channel : weights;
		is_moved = is_moved || channel->path != AnimatedPath::WEIGHTS;
	}
	const auto sample = [&](const AnimationChannel &p_channel) {
		return p_channel.sampler.sample(p_time_s, p_channel.path == AnimatedPath::ROTATION);
	};
	if (auto *instance = dynamic_cast<MeshInstance3D *>(&node); instance && weights) {
		const std::vector<double> values = sample(*weights);
		instance->posed_morph_weights.emplace(values.begin(), values.end());
	}
	if (!is_moved) {
		return;
	}
	NodeTransform moved = choose_components(p_pose.file_transform, node);
	for (const AnimationChannel *channel : p_pose.channels) {
		switch (channel->path) {
			case AnimatedPath::TRANSLATION:
				moved.translation = to_vector(sample(*channel));
				break;
			case AnimatedPath::ROTATION:
				moved.rotation = to_quaternion(sample(*channel));
				break;
			case AnimatedPath::SCALE:
				moved.scale = to_vector(sample(*channel));
				break;
			case AnimatedPath::WEIGHTS:
				break;
		}
	}
	node.posed_parent_from_node = moved.compose();
}

/// Finds the nodes that the animation poses; null: none. Several nodes share a file index if one
/// file node became several, such as a mesh with a light below it. The animation poses only the
/// first, and the others move with it.
std::vector<AnimatedNodePose> find_posed_nodes(const Scene &p_scene, const Animation *p_animation) {
	std::vector<AnimatedNodePose> poses;
	if (!p_animation) {
		return poses;
	}
	std::unordered_map<int, AnimatedNodePose> by_file_index;
	for (const AnimationChannel &channel : p_animation->channels) {
		by_file_index[channel.node].channels.push_back(&channel);
	}
	for (const AnimatedNode &node : p_animation->nodes) {
		by_file_index[node.node].file_transform = node.transform;
	}
	for (Node3D *node : p_scene.find_nodes<Node3D>()) {
		const auto found = by_file_index.find(node->file_index);
		if (node->file_index >= 0 && found != by_file_index.end()) {
			poses.push_back(std::move(found->second));
			poses.back().node = node;
			by_file_index.erase(found);
		}
	}
	return poses;
}

/// Implements pose_scene. Changes the nodes, which are not const even in a const scene. Returns
/// those that the animation poses.
std::vector<AnimatedNodePose> pose_nodes(
		const Scene &p_scene, const Animation *p_animation, double p_time_s) {
	for (Node3D *node : p_scene.find_nodes<Node3D>()) {
		node->posed_parent_from_node.reset();
		if (auto *instance = dynamic_cast<MeshInstance3D *>(node)) {
			instance->posed_morph_weights.reset();
		}
	}
	std::vector<AnimatedNodePose> poses = find_posed_nodes(p_scene, p_animation);
	for (const AnimatedNodePose &pose : poses) {
		pose_node(pose, p_time_s);
	}
	return poses;
}

} // namespace

std::vector<double> AnimationSampler::sample(double p_time_s, bool p_is_rotation) const {
	const size_t count = component_count;
	const bool is_cubic = interpolation == Interpolation::CUBIC_SPLINE;
	// p_element selects an element of a cubic-spline key: 0 in-tangent, 1 value, 2 out-tangent.
	const auto get = [&](size_t p_key, size_t p_element) {
		const size_t first = is_cubic ? (3 * p_key + p_element) * count : p_key * count;
		return std::vector<double>(
				values.begin() + ptrdiff_t(first), values.begin() + ptrdiff_t(first + count));
	};
	const auto after = std::upper_bound(times_s.begin(), times_s.end(), p_time_s,
			[](double p_time, float p_key) { return p_time < double(p_key); });
	const size_t next = static_cast<size_t>(after - times_s.begin());
	if (next == 0 || next == times_s.size() || interpolation == Interpolation::STEP) {
		const std::vector<double> value = get(next == 0 ? 0 : next - 1, 1);
		return p_is_rotation ? normalize(value) : value;
	}
	const size_t key = next - 1;
	const double length_s = double(times_s[next]) - double(times_s[key]);
	const double t = (p_time_s - double(times_s[key])) / length_s;
	const std::vector<double> from = get(key, 1);
	const std::vector<double> to = get(next, 1);
	if (!is_cubic && p_is_rotation) {
		return to_values(glm::normalize(
				glm::slerp(to_quaternion(normalize(from)), to_quaternion(normalize(to)), t)));
	}
	std::vector<double> result(count);
	const std::vector<double> out_tangent = is_cubic ? get(key, 2) : from;
	const std::vector<double> in_tangent = is_cubic ? get(next, 0) : to;
	for (size_t i = 0; i < count; ++i) {
		const double square = t * t;
		const double cube = square * t;
		result[i] = is_cubic ? (2 * cube - 3 * square + 1) * from[i] +
						length_s * (cube - 2 * square + t) * out_tangent[i] +
						(3 * square - 2 * cube) * to[i] + length_s * (cube - square) * in_tangent[i]
							 : from[i] + t * (to[i] - from[i]);
	}
	return p_is_rotation ? normalize(std::move(result)) : result;
}

double Animation::wrap_time(double p_time_s) const {
	if (!(duration_s > 0) || !std::isfinite(p_time_s)) {
		return 0;
	}
	if (p_time_s >= 0 && p_time_s <= duration_s) {
		return p_time_s;
	}
	const double wrapped_s = std::fmod(p_time_s, duration_s);
	return wrapped_s < 0 ? wrapped_s + duration_s : wrapped_s;
}

void pose_scene(Scene &r_scene, const Animation *p_animation, double p_time_s) {
	pose_nodes(r_scene, p_animation, p_time_s);
}

SceneChange ScenePoser::pose(
		Scene &r_scene, std::shared_ptr<const Animation> p_animation, double p_time_s) {
	const bool is_same = root == r_scene.root.get() && animation == p_animation &&
			tree_revision == Node3D::get_tree_revision();
	if (is_same && (time_s == p_time_s || poses.empty())) {
		return SceneChange::NONE;
	}
	time_s = p_time_s;
	if (is_same) {
		for (const AnimatedNodePose &pose : poses) {
			pose_node(pose, time_s);
		}
		return SceneChange::POSE;
	}
	root = r_scene.root.get();
	animation = std::move(p_animation);
	tree_revision = Node3D::get_tree_revision();
	poses = pose_nodes(r_scene, animation.get(), time_s);
	return SceneChange::ANY;
}

std::shared_ptr<const SceneSnapshot> build_posed_snapshot(const Scene &p_scene,
		const Camera3D &p_camera, const Animation *p_animation, double p_time_s) {
	std::vector<std::pair<Node3D *, std::optional<glm::dmat4>>> transforms;
	std::vector<std::pair<MeshInstance3D *, std::optional<std::vector<float>>>> weights;
	for (Node3D *node : p_scene.find_nodes<Node3D>()) {
		transforms.emplace_back(node, node->posed_parent_from_node);
	}
	for (MeshInstance3D *node : p_scene.find_nodes<MeshInstance3D>()) {
		weights.emplace_back(node, node->posed_morph_weights);
	}
	pose_nodes(p_scene, p_animation, p_time_s);
	const auto restore = [&] {
		for (const auto &[node, transform] : transforms) {
			node->posed_parent_from_node = transform;
		}
		for (const auto &[node, weight] : weights) {
			node->posed_morph_weights = weight;
		}
	};
	std::shared_ptr<const SceneSnapshot> snapshot;
	try {
		snapshot = build_snapshot(p_scene, p_camera);
	} catch (...) {
		restore();
		throw;
	}
	restore();
	return snapshot;
}

std::shared_ptr<const Animation> find_animation(const Scene &p_scene, const std::string &p_name) {
	const size_t SHOWN_COUNT = 20;
	if (p_name.empty()) {
		return p_scene.animations.empty() ? nullptr : p_scene.animations.front();
	}
	std::string names;
	for (size_t index = 0; index < p_scene.animations.size(); ++index) {
		const std::string &name = p_scene.animations[index]->name;
		if (name == p_name) {
			return p_scene.animations[index];
		}
		names += index >= SHOWN_COUNT ? "" : (index == 0 ? "\"" : ", \"") + name + "\"";
	}
	const std::string subject =
			p_scene.path.empty() ? "The scene" : "Scene \"" + p_scene.path + "\"";
	if (names.empty()) {
		fail(subject, " has no animation \"", p_name,
				"\", and no other animation. Leave the name out.");
	}
	fail(subject, " has no animation \"", p_name, "\". Name one of these: ", names,
			p_scene.animations.size() > SHOWN_COUNT
					? text(" and ", p_scene.animations.size() - SHOWN_COUNT, " more.")
					: ".");
}

} // namespace gnomon
