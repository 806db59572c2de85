#pragma once

#include "modules/godot_addon/detail_levels.h"
#include "modules/godot_addon/topology_worker.h"
#include "modules/godot_addon/watched_resource.h"
#include "modules/scene/mesh.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// A surface of a mesh of Godot.
struct ReadSurface {
	std::shared_ptr<const Mesh> mesh; // null: it has no triangles, or cannot be read
	int64_t index = 0;				  // in Godot's mesh
	/// Null: there are none.
	std::shared_ptr<const DetailLevels> levels;
};

/// Reads the triangles of Godot's meshes, each once until it changes. Main thread only.
///
/// Godot copies them from the GPU for that, which waits for it: a load, not something for each
/// frame.
class MeshReader {
public:
	/// What is read of a mesh; p_name, for messages, is the node's. Valid until the next forget.
	const std::vector<ReadSurface> &read(const godot::Mesh &p_mesh, const std::string &p_name);
	/// False while the worker thread finds its edges: until then it can cast no shadow.
	bool is_ready(const ReadSurface &p_surface) { return worker.is_ready(p_surface.mesh); }
	/// As above of what is left of a surface; it may be queried in each frame.
	bool is_cut_ready(const std::shared_ptr<const Mesh> &p_cut);
	/// Forgets meshes that were not queried in many frames, or are gone. Once a frame.
	void forget_unused();

private:
	struct Entry {
		std::unique_ptr<WatchedResource> watched;
		int64_t surface_count = 0;
		std::vector<ReadSurface> surfaces;
		uint64_t last_use = 0;
	};

	TopologyWorker worker;
	std::map<uint64_t, std::weak_ptr<const Mesh>> cut; // that the worker has, by Mesh::id
	std::map<uint64_t, Entry> entries;				   // by the resource's id
	uint64_t frame = 0;
};

} // namespace gnomon
