#include "modules/scene/animation.h"

#include "modules/core/error.h"

#include <algorithm>
#include <cmath>
#include <map>

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

/// The values that channels set on one node.
struct NodePose {
	std::optional<glm::dvec3> translation;
	std::optional<glm::dquat> rotation;
	std::optional<glm::dvec3> scale;
	std::optional<std::vector<float>> weights;
};

std::map<int, NodePose> sample_channels(const Animation &p_animation, double p_time_s) {
	std::map<int, NodePose> poses;
	for (const AnimationChannel &channel : p_animation.channels) {
		const std::vector<double> values =
				channel.sampler.sample(p_time_s, channel.path == AnimatedPath::ROTATION);
		NodePose &pose = poses[channel.node];
		switch (channel.path) {
			case AnimatedPath::TRANSLATION:
				pose.translation = to_vector(values);
				break;
			case AnimatedPath::ROTATION:
				pose.rotation = to_quaternion(values);
				break;
			case AnimatedPath::SCALE:
				pose.scale = to_vector(values);
				break;
			case AnimatedPath::WEIGHTS:
				pose.weights.emplace(values.begin(), values.end());
				break;
		}
	}
	return poses;
}

/// Implements pose_scene. Changes the nodes, which are not const even in a const scene.
void pose_nodes(const Scene &p_scene, const Animation *p_animation, double p_time_s) {
	std::map<int, NodePose> poses;
	std::map<int, NodeTransform> file_transforms;
	if (p_animation) {
		poses = sample_channels(*p_animation, p_time_s);
		for (const AnimatedNode &node : p_animation->nodes) {
			file_transforms[node.node] = node.transform;
		}
	}
	for (Node3D *node : p_scene.find_nodes<Node3D>()) {
		node->posed_parent_from_node.reset();
		auto *instance = dynamic_cast<MeshInstance3D *>(node);
		if (instance) {
			instance->posed_morph_weights.reset();
		}
		// Several nodes share a file index if one file node became several, such as a mesh with a
		// light below it. The animation poses only the first, and the others move with it.
		const auto pose = poses.find(node->file_index);
		if (node->file_index < 0 || pose == poses.end()) {
			continue;
		}
		const NodePose channels = std::move(pose->second);
		poses.erase(pose);
		if (channels.weights && instance) {
			instance->posed_morph_weights = channels.weights;
		}
		if (channels.translation || channels.rotation || channels.scale) {
			NodeTransform moved = choose_components(file_transforms.at(node->file_index), *node);
			moved.translation = channels.translation.value_or(moved.translation);
			moved.rotation = channels.rotation.value_or(moved.rotation);
			moved.scale = channels.scale.value_or(moved.scale);
			node->posed_parent_from_node = moved.compose();
		}
	}
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
