#include "modules/gltf_scene/gltf_check_motion.h"

#include "modules/core/error.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace gnomon {

namespace {

bool is_path(const std::string &p_path) {
	return p_path == "translation" || p_path == "rotation" || p_path == "scale" ||
			p_path == "weights";
}

/// Replaces a channel by one that tinygltf accepts and the reader skips.
void disable_channel(const GltfObject &p_channel) {
	p_channel.set("sampler", 0);
	p_channel.set("target", { { "node", 0 }, { "path", "" } });
}

void check_channel(
		const GltfObject &p_channel, const GltfObject &p_animation, size_t p_node_count) {
	const auto target = p_channel.find_object("target");
	if (!target || !target->find("node")) { // no node is valid: an extension may define the target
		if (target && target->get_text("path") == "pointer") {
			p_channel.get_messages().warn("pointer", p_channel.get_member_path("target.path"),
					"is \"pointer\": KHR_animation_pointer is not read, and its channels are "
					"skipped. Animate nodes or morph targets instead.");
		}
		return disable_channel(p_channel);
	}
	const std::string path = target->get_text("path");
	const size_t sampler_count = p_animation.get_count("samplers");
	const auto sampler = p_channel.find_whole_number("sampler");
	const auto node = target->find_whole_number("node");
	if (!is_path(path)) {
		target->report_value(
				"path", "\"translation\", \"rotation\", \"scale\" or \"weights\"", "no motion");
	} else if (!sampler || *sampler >= sampler_count) {
		p_channel.report_value("sampler",
				sampler_count == 0 ? std::string("absent, as there are no samplers")
								   : text("0..", sampler_count - 1),
				"no motion");
	} else if (!node || *node >= p_node_count) {
		target->report_value("node",
				p_node_count == 0 ? std::string("absent, as there are no nodes")
								  : text("0..", p_node_count - 1),
				"no motion");
	} else {
		return;
	}
	disable_channel(p_channel);
}

} // namespace

void check_morph_weights(const GltfObject &p_object) {
	const Json *weights = p_object.find("weights");
	if (!weights) {
		return;
	}
	const bool is_good = weights->is_array() &&
			std::all_of(weights->begin(), weights->end(), [](const Json &p_weight) {
				return p_weight.is_number() && std::abs(p_weight.get<double>()) <= FLT_MAX;
			});
	if (!is_good) {
		p_object.report_value("weights", "a list of finite numbers", "the default");
		p_object.erase("weights");
	}
}

void check_skins(const GltfObject &p_root) {
	p_root.for_each("skins", [&](const GltfObject &p_skin) {
		const size_t count = p_skin.get_count("joints");
		if (count == 0 || count > GLTF_MAX_JOINT_COUNT) {
			p_skin.fail_at("joints",
					text("has ", count, " elements, must be 1..", GLTF_MAX_JOINT_COUNT,
							". Export the mesh with a number of joints in this range."));
		}
		p_skin.check_indices("joints", p_root.get_count("nodes"));
		p_skin.find_index("skeleton", p_root.get_count("nodes"));
		p_skin.find_index("inverseBindMatrices", p_root.get_count("accessors"));
	});
}

void check_animations(const GltfObject &p_root) {
	uint64_t channel_count = 0;
	p_root.for_each("animations", [&](const GltfObject &p_animation) {
		channel_count += p_animation.get_count("channels");
		if (channel_count > GLTF_MAX_CHANNEL_COUNT) {
			p_animation.fail_at("channels",
					text("make ", channel_count, " in all animations, must be at most ",
							GLTF_MAX_CHANNEL_COUNT, ". Split the scene."));
		}
		p_animation.for_each("samplers", [&](const GltfObject &p_sampler) {
			p_sampler.require_index("input", p_root.get_count("accessors"));
			p_sampler.require_index("output", p_root.get_count("accessors"));
			const std::string kind = p_sampler.get_text("interpolation");
			if (p_sampler.find("interpolation") && kind != "LINEAR" && kind != "STEP" &&
					kind != "CUBICSPLINE") {
				p_sampler.report_value(
						"interpolation", "\"LINEAR\", \"STEP\" or \"CUBICSPLINE\"", "\"LINEAR\"");
				p_sampler.set("interpolation", "LINEAR");
			}
		});
		p_animation.for_each("channels", [&](const GltfObject &p_channel) {
			check_channel(p_channel, p_animation, p_root.get_count("nodes"));
		});
	});
}

} // namespace gnomon
