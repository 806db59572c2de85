#include "modules/gltf_scene/gltf_rigs.h"

#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_check_motion.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const int JOINTS_PER_SET = 4; // JOINTS_n and WEIGHTS_n are VEC4
const int MAX_JOINT_SETS = 2;

void check_count(const GltfMessages &p_messages, const std::string &p_path, size_t p_count,
		size_t p_vertex_count) {
	if (p_count != p_vertex_count) {
		p_messages.fail(p_path,
				text("has ", p_count, " elements, must be ", p_vertex_count, ", one per POSITION. ",
						EXPORT_AGAIN));
	}
}

uint32_t to_joint(float p_value, const GltfMessages &p_messages, const std::string &p_path) {
	if (!(p_value >= 0 && p_value < float(GLTF_MAX_JOINT_COUNT) &&
				p_value == std::floor(p_value))) {
		p_messages.fail_value(
				p_path, text(p_value), text("whole numbers in 0..", GLTF_MAX_JOINT_COUNT - 1));
	}
	return static_cast<uint32_t>(p_value);
}

void read_joints(const tinygltf::Primitive &p_primitive, const std::string &p_path,
		size_t p_vertex_count, GltfAccessors &p_accessors, GltfMessages &r_messages,
		MeshRig &r_rig) {
	std::vector<std::vector<glm::vec4>> joints;
	std::vector<std::vector<glm::vec4>> weights;
	const auto &attributes = p_primitive.attributes;
	for (int set = 0; set < MAX_JOINT_SETS; ++set) {
		const auto joint = attributes.find(text("JOINTS_", set));
		const auto weight = attributes.find(text("WEIGHTS_", set));
		if (joint == attributes.end() || weight == attributes.end()) {
			break;
		}
		joints.push_back(p_accessors.read_attribute(
				static_cast<size_t>(joint->second), JOINTS_PER_SET, JOINTS_PER_SET));
		weights.push_back(p_accessors.read_attribute(
				static_cast<size_t>(weight->second), JOINTS_PER_SET, JOINTS_PER_SET));
		check_count(r_messages, text(p_path, ".attributes.JOINTS_", set), joints.back().size(),
				p_vertex_count);
		check_count(r_messages, text(p_path, ".attributes.WEIGHTS_", set), weights.back().size(),
				p_vertex_count);
	}
	if (attributes.contains(text("JOINTS_", MAX_JOINT_SETS))) {
		r_messages.warn("joints", p_path,
				"has more than 8 joints a vertex; the first 8 are used. Limit them in the "
				"exporter.");
	}
	r_rig.influence_count = static_cast<uint32_t>(JOINTS_PER_SET * joints.size());
	for (size_t vertex = 0; !joints.empty() && vertex < p_vertex_count; ++vertex) {
		for (size_t set = 0; set < joints.size(); ++set) {
			for (int i = 0; i < JOINTS_PER_SET; ++i) {
				r_rig.joints.push_back(to_joint(joints[set][vertex][i], r_messages,
						text(p_path, ".attributes.JOINTS_", set)));
				r_rig.weights.push_back(weights[set][vertex][i]);
			}
		}
	}
}

size_t count_ancestors(const GltfTree &p_tree, size_t p_node) {
	size_t count = 0;
	for (size_t node = p_tree.parents[p_node]; node != GltfTree::NONE;
			node = p_tree.parents[node]) {
		++count;
	}
	return count;
}

/// Returns the closest common ancestor of two nodes, which may be one of them; NONE if there is
/// none.
size_t find_common_ancestor(const GltfTree &p_tree, size_t p_first, size_t p_second) {
	size_t first_depth = count_ancestors(p_tree, p_first);
	size_t second_depth = count_ancestors(p_tree, p_second);
	while (p_first != p_second) {
		if (p_first == GltfTree::NONE || p_second == GltfTree::NONE) {
			return GltfTree::NONE;
		}
		if (first_depth >= second_depth) {
			const bool is_same_depth = first_depth == second_depth;
			p_first = p_tree.parents[p_first];
			first_depth -= first_depth > 0 ? 1 : 0;
			if (is_same_depth) {
				p_second = p_tree.parents[p_second];
				second_depth -= second_depth > 0 ? 1 : 0;
			}
		} else {
			p_second = p_tree.parents[p_second];
			--second_depth;
		}
	}
	return p_first;
}

} // namespace

MeshRig read_rig(const tinygltf::Primitive &p_primitive, const std::string &p_path, bool p_has_skin,
		size_t p_vertex_count, GltfAccessors &p_accessors, GltfMessages &r_messages) {
	MeshRig rig;
	rig.vertex_count = p_vertex_count;
	if (p_has_skin) {
		read_joints(p_primitive, p_path, p_vertex_count, p_accessors, r_messages, rig);
	}
	for (size_t index = 0; index < p_primitive.targets.size(); ++index) {
		MorphTarget &target = rig.targets.emplace_back();
		const auto read = [&](const char *p_name, std::vector<glm::vec3> &r_deltas) {
			const auto found = p_primitive.targets[index].find(p_name);
			if (found != p_primitive.targets[index].end()) {
				r_deltas = *p_accessors.read_vectors(static_cast<size_t>(found->second));
				check_count(r_messages, text(p_path, ".targets[", index, "].", p_name),
						r_deltas.size(), p_vertex_count);
			}
		};
		read("POSITION", target.positions);
		read("NORMAL", target.normals);
		read("TANGENT", target.tangents);
	}
	return rig;
}

MeshRig gather_rig(const MeshRig &p_rig, const std::vector<uint32_t> &p_vertices) {
	MeshRig rig;
	rig.vertex_count = p_vertices.size();
	rig.influence_count = p_rig.influence_count;
	for (const uint32_t vertex : p_vertices) {
		const size_t first = size_t(vertex) * p_rig.influence_count;
		for (size_t i = first; i < first + p_rig.influence_count; ++i) {
			rig.joints.push_back(p_rig.joints[i]);
			rig.weights.push_back(p_rig.weights[i]);
		}
	}
	for (const MorphTarget &source : p_rig.targets) {
		MorphTarget &target = rig.targets.emplace_back();
		for (const uint32_t vertex : p_vertices) {
			for (const auto deltas :
					{ &MorphTarget::positions, &MorphTarget::normals, &MorphTarget::tangents }) {
				if (!(source.*deltas).empty()) {
					(target.*deltas).push_back((source.*deltas)[vertex]);
				}
			}
		}
	}
	return rig;
}

std::shared_ptr<const Skin> read_skin(const tinygltf::Model &p_model, size_t p_index,
		const GltfTree &p_tree, GltfAccessors &p_accessors, const GltfMessages &p_messages) {
	const tinygltf::Skin &source = p_model.skins[p_index];
	const std::string path = text("skins[", p_index, "]");
	auto skin = std::make_shared<Skin>();
	skin->joints = source.joints;
	skin->joint_from_mesh.resize(skin->joints.size(), glm::dmat4(1.0));
	if (source.inverseBindMatrices >= 0) {
		const std::vector<float> values =
				p_accessors.read_floats(static_cast<size_t>(source.inverseBindMatrices), 16);
		if (values.size() / 16 < skin->joints.size()) {
			p_messages.fail(path + ".inverseBindMatrices",
					text("has ", values.size() / 16, " elements, must be at least ",
							skin->joints.size(), ", one per joint. ", EXPORT_AGAIN));
		}
		for (size_t i = 0; i < 16 * skin->joints.size(); ++i) {
			if (!std::isfinite(values[i])) {
				p_messages.fail(text(path, ".inverseBindMatrices[", i / 16, "]"),
						text("is not finite. Correct it or export the file again."));
			}
			// The last row is taken as 0, 0, 0, 1, which glTF requires.
			const int element = static_cast<int>(i % 16);
			const bool is_last_row = element % 4 == 3;
			skin->joint_from_mesh[i / 16][element / 4][element % 4] =
					is_last_row ? (element == 15 ? 1.0 : 0.0) : double(values[i]);
		}
	}
	// The frame is the closest common ancestor of all joints that is not a joint itself.
	size_t frame = static_cast<size_t>(skin->joints[0]);
	for (const int joint : skin->joints) {
		if (frame != GltfTree::NONE) {
			frame = find_common_ancestor(p_tree, frame, static_cast<size_t>(joint));
		}
	}
	const auto is_joint = [&](size_t p_node) {
		return std::find(skin->joints.begin(), skin->joints.end(), static_cast<int>(p_node)) !=
				skin->joints.end();
	};
	while (frame != GltfTree::NONE && is_joint(frame)) {
		frame = p_tree.parents[frame];
	}
	skin->frame = frame == GltfTree::NONE ? -1 : static_cast<int>(frame);
	return skin;
}

} // namespace gnomon
