#include "modules/godot_addon/pose_reader.h"

#include <algorithm>

namespace gnomon {

namespace {

const uint64_t MAX_UNUSED_POSE_FRAMES = 600; // 10 s at 60 frames per second

std::vector<float> read_weights(const godot::MeshInstance3D &p_node) {
	std::vector<float> weights(size_t(p_node.get_blend_shape_count()));
	for (size_t index = 0; index < weights.size(); ++index) {
		weights[index] = static_cast<float>(p_node.get_blend_shape_value(int64_t(index)));
	}
	return weights;
}

} // namespace

/// Cached by skeleton, because nodes may share one, such as a figure's body and its clothes.
const std::vector<glm::dmat4> &PoseReader::read_bones(const godot::MeshInstance3D &p_node) {
	static const std::vector<glm::dmat4> NONE;
	const godot::Ref<godot::SkinReference> skin = p_node.get_skin_reference();
	if (!skin) {
		return NONE;
	}
	const godot::RID skeleton = skin.get_skeleton();
	const auto [found, is_new] = skeletons.try_emplace(skeleton);
	if (is_new) {
		const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
		const int64_t count = server.skeleton_get_bone_count(skeleton);
		for (int64_t bone = 0; bone < count; ++bone) {
			found->second.push_back(server.skeleton_bone_get_transform(skeleton, bone).to_matrix());
		}
	}
	return found->second;
}

void PoseReader::pose(const Key &p_key, const godot::MeshInstance3D &p_node,
		const std::shared_ptr<const Mesh> &p_rest, VertexMove p_move,
		InstanceSnapshot &r_instance) {
	const MeshRig &rig = *p_rest->attributes.rig;
	std::vector<glm::dmat4> joints;
	if (p_node && rig.influence_count > 0) {
		joints = read_bones(p_node);
	}
	if (!joints.empty()) {
		joints.resize(std::max<size_t>(joints.size(), rig.joint_count), glm::dmat4(1.0));
	}
	std::vector<float> weights;
	if (p_node && !rig.targets.empty()) {
		weights = read_weights(p_node);
	}
	Entry &entry = entries[p_key];
	entry.last_use = frame;
	if (!entry.slot || entry.slot->get_rest() != p_rest) {
		entry.slot = std::make_shared<PoseSlot>(p_rest);
	}
	entry.pose = entry.slot->make_pose(std::move(joints), std::move(weights),
			"Node \"" + r_instance.node_name + "\"", std::move(p_move));
	r_instance.set_pose(entry.slot, entry.pose);
}

bool PoseReader::repeat(const Key &p_key, InstanceSnapshot &r_instance) {
	const auto found = entries.find(p_key);
	if (found == entries.end() || found->second.last_use != frame || !found->second.pose) {
		return false;
	}
	r_instance.set_pose(found->second.slot, found->second.pose);
	return true;
}

void PoseReader::end_frame() {
	skeletons.clear();
	++frame;
	std::erase_if(entries, [&](const auto &p_entry) {
		return frame - p_entry.second.last_use > MAX_UNUSED_POSE_FRAMES ||
				godot::get_instance(p_entry.first.node_id) == nullptr;
	});
}

} // namespace gnomon
