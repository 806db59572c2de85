#pragma once

#include "modules/godot_addon/detail_levels.h"
#include "modules/godot_addon/topology_worker.h"
#include "modules/godot_addon/vertex_translation.h"
#include "modules/godot_addon/watched_resource.h"
#include "modules/scene/mesh.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// A surface of a Godot mesh, as a mesh of the engine.
struct ReadSurface {
	std::shared_ptr<const Mesh> mesh; // null if it has no triangles or cannot be read
	int64_t index = 0;				  // in Godot's mesh
	/// Null if it has no levels of detail.
	std::shared_ptr<const DetailLevels> levels;
};

/// Reads the surfaces with triangles of a mesh of the RenderingServer, without levels of detail and
/// rigs. r_materials: gets their materials. Empty: p_mesh is no mesh, or has none.
std::vector<ReadSurface> read_server_mesh(godot::RID p_mesh, std::vector<godot::RID> &r_materials);

/// Reads the triangles of Godot's meshes, and caches them until the mesh changes. Main thread only.
///
/// A read copies the mesh from the GPU and waits for it: a cost at load time, not in each frame.
class MeshReader {
public:
	/// Returns the surfaces of a mesh. p_name: the node's name, for messages. The reference is
	/// valid until the next read of the mesh or the next forget_unused().
	const std::vector<ReadSurface> &read(const godot::Mesh &p_mesh, const std::string &p_name);
	/// False while the worker thread computes the surface's edges. Until then it cannot cast a
	/// shadow.
	bool is_ready(const ReadSurface &p_surface) { return is_ready(p_surface.mesh); }
	bool is_ready(const std::shared_ptr<const Mesh> &p_mesh) { return worker.is_ready(p_mesh); }
	/// The same for p_cut, the mesh that the alpha test leaves of a surface. The first call passes
	/// it to the worker.
	bool is_cut_ready(const std::shared_ptr<const Mesh> &p_cut);
	/// Passes a mesh that was not read here to the worker, once; see is_ready().
	void prepare(const std::shared_ptr<const Mesh> &p_mesh);
	/// Returns the surface's mesh with each vertex moved along its normal. p_grow_m: the distance,
	/// in mesh space.
	std::shared_ptr<const Mesh> grow(const ReadSurface &p_surface, float p_grow_m);
	/// Returns a mesh of the surface that vertex() may move: with a rig, and the attributes that it
	/// reads. p_mesh: Godot's mesh of the surface.
	std::shared_ptr<const Mesh> make_movable(const ReadSurface &p_surface,
			const godot::Mesh &p_mesh, const VertexTranslation &p_translation);
	/// Removes meshes that were freed or not read for 600 frames. Call once per frame.
	void forget_unused();

private:
	struct Entry {
		std::unique_ptr<WatchedResource> watched;
		int64_t surface_count = 0;
		std::vector<ReadSurface> surfaces;
		uint64_t last_use = 0;
	};

	TopologyWorker worker;
	std::map<uint64_t, std::weak_ptr<const Mesh>> prepared; // given to the worker, by Mesh::id
	struct ChangedMesh {
		std::shared_ptr<const Mesh> mesh;
		uint64_t last_use = 0;
	};
	std::map<std::pair<uint64_t, float>, ChangedMesh>
			grown; // by Mesh::id of the original, distance
	/// By Mesh::id of the original, and the attributes that vertex() reads.
	std::map<std::pair<uint64_t, uint32_t>, ChangedMesh> movable;
	std::map<uint64_t, Entry> entries; // by the resource's id
	uint64_t frame = 0;
};

} // namespace gnomon
