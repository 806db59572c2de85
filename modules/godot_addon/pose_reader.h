#pragma once

#include "modules/scene/mesh_pose.h"
#include "modules/scene/scene_snapshot.h"

#include <godot_api.gen.h>

#include <map>
#include <memory>
#include <vector>

namespace gnomon {

/// Reads where skeletons and blend shapes put the vertices of MeshInstance3Ds. Main thread only.
///
/// Bones are those of the RenderingServer, which it draws with: after all SkeletonModifier3Ds,
/// whose result Skeleton3D itself gives up again. They move vertices in the space of the
/// MeshInstance3D, wherever that is, as if its Skeleton3D were at the same position.
class PoseReader {
public:
	/// Gives the instance its pose; p_rest: its mesh, the surface's, has a rig. Bones beyond those
	/// of the skin, of which Godot itself warns, rest.
	void pose(const godot::MeshInstance3D &p_node, const std::shared_ptr<const Mesh> &p_rest,
			int64_t p_surface, InstanceSnapshot &r_instance);
	/// Once a frame, when all is read: drops what belongs to nodes that are gone or were not read
	/// in many frames.
	void end_frame();

private:
	struct Entry {
		std::shared_ptr<PoseSlot> slot;
		uint64_t last_use = 0; // the frame
	};
	/// None: nothing skins the node, or no bone was placed yet.
	const std::vector<glm::dmat4> &read_bones(const godot::MeshInstance3D &p_node);

	std::map<std::pair<uint64_t, int64_t>, Entry> entries;	 // by the node's id and the surface
	std::map<godot::RID, std::vector<glm::dmat4>> skeletons; // that were read in this frame
	uint64_t frame = 0;
};

} // namespace gnomon
