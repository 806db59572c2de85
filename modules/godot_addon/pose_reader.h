#pragma once

#include "modules/scene/mesh_pose.h"
#include "modules/scene/scene_snapshot.h"

#include <godot_api.gen.h>

#include <map>
#include <memory>
#include <vector>

namespace gnomon {

/// Reads the bone transforms and blend shape weights of MeshInstance3Ds. Main thread only.
///
/// Bone transforms come from the RenderingServer, which has the result of all SkeletonModifier3Ds.
/// Skeleton3D does not keep that result. As in Godot, bones move vertices in the space of the
/// MeshInstance3D, and the transform of the Skeleton3D node has no effect.
class PoseReader {
public:
	/// A surface of a node, or of an instance of a MultiMesh or a GridMap.
	struct Key {
		uint64_t node_id = 0;
		uint64_t mesh_id = 0; // of Godot's mesh: a GridMap has several
		int64_t surface = 0;
		size_t instance = 0;
		auto operator<=>(const Key &) const = default;
	};
	/// Sets the pose of r_instance. p_node: empty if it is no MeshInstance3D. p_rest: the surface's
	/// mesh in its rest pose, must have a rig. p_move: what moves its vertices after bones and
	/// blend shapes. Bones that the skin lacks, of which Godot itself warns, stay at rest.
	void pose(const Key &p_key, const godot::MeshInstance3D &p_node,
			const std::shared_ptr<const Mesh> &p_rest, VertexMove p_move,
			InstanceSnapshot &r_instance);
	/// Sets the pose that an instance with the same key has in this frame. Returns false if there
	/// is none yet.
	bool repeat(const Key &p_key, InstanceSnapshot &r_instance);
	/// Call once per frame after all pose() calls. Removes the data of nodes that were freed or not
	/// read for 600 frames.
	void end_frame();

private:
	struct Entry {
		std::shared_ptr<PoseSlot> slot;
		std::shared_ptr<const MeshPose> pose; // of the last use
		uint64_t last_use = 0;				  // frame number
	};
	/// Returns a matrix for each bone; empty if the node has no skin or no bones are set yet.
	const std::vector<glm::dmat4> &read_bones(const godot::MeshInstance3D &p_node);

	std::map<Key, Entry> entries;
	std::map<godot::RID, std::vector<glm::dmat4>> skeletons; // bones read in this frame
	uint64_t frame = 0;
};

} // namespace gnomon
