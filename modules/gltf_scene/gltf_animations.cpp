#include "modules/gltf_scene/gltf_animations.h"

#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_tree.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace gnomon {

namespace {

const uint64_t MAX_KEY_VALUE_COUNT = uint64_t(1) << 26; // floats in all channels together; 0.3 GB

/// Reads the animations of a model, see read_animations.
class AnimationReader {
public:
	AnimationReader(
			const tinygltf::Model &p_model, GltfAccessors &p_accessors, GltfMessages &r_messages) :
			model(p_model),
			accessors(p_accessors), messages(r_messages) {}

	std::shared_ptr<const Animation> read(size_t p_index, const std::string &p_name);

private:
	const tinygltf::Model &model;
	GltfAccessors &accessors;
	GltfMessages &messages;
	uint64_t value_count = 0; // of all channels so far

	bool read_channel(const tinygltf::Animation &p_animation, size_t p_channel,
			const std::string &p_path, AnimationChannel &r_channel);
	uint32_t count_components(AnimatedPath p_path, const tinygltf::Node &p_node) const;
	bool reject_channel(const std::string &p_path, const std::string &p_problem);
};

/// Logs the problem of a channel as an error and returns false.
bool AnimationReader::reject_channel(const std::string &p_path, const std::string &p_problem) {
	messages.report(messages.describe(
			p_path, p_problem + "; this channel is skipped. Correct it or export the file again."));
	return false;
}

/// Returns the number of floats per key. For weights this is the number of morph targets of the
/// node's mesh, which may be 0.
uint32_t AnimationReader::count_components(
		AnimatedPath p_path, const tinygltf::Node &p_node) const {
	if (p_path != AnimatedPath::WEIGHTS) {
		return p_path == AnimatedPath::ROTATION ? 4 : 3;
	}
	size_t count = 0;
	if (p_node.mesh >= 0) {
		for (const tinygltf::Primitive &primitive :
				model.meshes[static_cast<size_t>(p_node.mesh)].primitives) {
			count = std::max(count, primitive.targets.size());
		}
	}
	return static_cast<uint32_t>(count);
}

bool AnimationReader::read_channel(const tinygltf::Animation &p_animation, size_t p_channel,
		const std::string &p_path, AnimationChannel &r_channel) {
	const tinygltf::AnimationChannel &channel = p_animation.channels[p_channel];
	r_channel.node = channel.target_node;
	r_channel.path = channel.target_path == "translation" ? AnimatedPath::TRANSLATION
			: channel.target_path == "rotation"			  ? AnimatedPath::ROTATION
			: channel.target_path == "scale"			  ? AnimatedPath::SCALE
														  : AnimatedPath::WEIGHTS;
	const tinygltf::AnimationSampler &source =
			p_animation.samplers[static_cast<size_t>(channel.sampler)];
	const std::string sampler_path = text(p_path, ".samplers[", channel.sampler, "]");
	AnimationSampler &sampler = r_channel.sampler;
	sampler.interpolation = source.interpolation == "STEP" ? Interpolation::STEP
			: source.interpolation == "CUBICSPLINE"		   ? Interpolation::CUBIC_SPLINE
														   : Interpolation::LINEAR;
	sampler.component_count =
			count_components(r_channel.path, model.nodes[static_cast<size_t>(channel.target_node)]);
	if (sampler.component_count == 0) {
		return reject_channel(text(p_path, ".channels[", p_channel, "].target.path"),
				text("is \"weights\", but nodes[", channel.target_node,
						"] has no mesh with morph targets"));
	}
	sampler.times_s = accessors.read_floats(static_cast<size_t>(source.input), 1);
	// Weights are single numbers in the accessor, component_count of them per key.
	const int accessor_components =
			r_channel.path == AnimatedPath::WEIGHTS ? 1 : int(sampler.component_count);
	sampler.values = accessors.read_floats(static_cast<size_t>(source.output), accessor_components);
	value_count += sampler.times_s.size() + sampler.values.size();
	if (value_count > MAX_KEY_VALUE_COUNT) {
		messages.fail(sampler_path + ".output",
				text("makes more than ", MAX_KEY_VALUE_COUNT,
						" values in all animations. Split the scene."));
	}
	for (size_t key = 0; key < sampler.times_s.size(); ++key) {
		const float time_s = sampler.times_s[key];
		if (!std::isfinite(time_s) || (key > 0 && time_s <= sampler.times_s[key - 1])) {
			return reject_channel(sampler_path + ".input",
					text("has ", time_s, " at ", key, ", must be finite times in s that ascend"));
		}
	}
	// In-tangent, value and out-tangent, or only the value.
	const size_t values_per_key = sampler.interpolation == Interpolation::CUBIC_SPLINE ? 3 : 1;
	const size_t expected = sampler.times_s.size() * sampler.component_count * values_per_key;
	if (sampler.values.size() != expected) {
		return reject_channel(sampler_path + ".output",
				text("has ", sampler.values.size(), " numbers, must be ", expected, ", for ",
						sampler.times_s.size(), " times"));
	}
	const auto bad = std::find_if_not(sampler.values.begin(), sampler.values.end(),
			[](float p_value) { return std::isfinite(p_value); });
	if (bad != sampler.values.end()) {
		return reject_channel(sampler_path + ".output",
				text("has a number that is not finite at ", bad - sampler.values.begin()));
	}
	return true;
}

std::shared_ptr<const Animation> AnimationReader::read(size_t p_index, const std::string &p_name) {
	const tinygltf::Animation &source = model.animations[p_index];
	auto animation = std::make_shared<Animation>();
	animation->name = p_name;
	std::set<int> animated_nodes;
	for (size_t index = 0; index < source.channels.size(); ++index) {
		AnimationChannel channel;
		// check_animations gives a disabled channel the path "".
		if (source.channels[index].target_path.empty() ||
				!read_channel(source, index, text("animations[", p_index, "]"), channel)) {
			continue;
		}
		animation->duration_s =
				std::max(animation->duration_s, double(channel.sampler.times_s.back()));
		if (animated_nodes.insert(channel.node).second) {
			// glTF does not allow a matrix here. If there is one, pose_scene decomposes it.
			animation->nodes.push_back({ channel.node,
					read_node_transform(model.nodes[static_cast<size_t>(channel.node)]) });
		}
		animation->channels.push_back(std::move(channel));
	}
	return animation;
}

} // namespace

std::vector<std::shared_ptr<const Animation>> read_animations(
		const tinygltf::Model &p_model, GltfAccessors &p_accessors, GltfMessages &r_messages) {
	AnimationReader reader(p_model, p_accessors, r_messages);
	std::vector<std::shared_ptr<const Animation>> animations;
	std::set<std::string> names;
	for (size_t index = 0; index < p_model.animations.size(); ++index) {
		const std::string base_name =
				make_name(p_model.animations[index].name, text("Animation ", index));
		std::string name = base_name;
		for (int number = 2; !names.insert(name).second; ++number) {
			name = text(base_name, "_", number);
		}
		animations.push_back(reader.read(index, name));
	}
	return animations;
}

} // namespace gnomon
