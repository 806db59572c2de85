#pragma once

#include "modules/render_graph/render_graph.h"
#include "modules/rendering_device/rendering_device.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/gpu_topology.h"

#include <map>
#include <memory>
#include <typeindex>
#include <utility>

namespace gnomon {

/// Of MeshStore::add_deform_pass; all lights have it in common.
inline constexpr char DEFORM_PASS_NAME[] = "deform";

/// One mesh in GPU memory.
struct GpuMesh {
	OwnedBuffer positions;	 // VERTEX | STORAGE, three floats each
	OwnedBuffer normals;	 // VERTEX | STORAGE, three floats each
	SharedBuffer indices;	 // INDEX | STORAGE
	OwnedBuffer tangents;	 // of a mesh that poses deform, once requested: four floats each
	BufferRID rest_tangents; // from which those come
	uint32_t index_count = 0;
	uint64_t pose_hash = 0; // of the pose that the vertices have; 0: at rest
	std::weak_ptr<const Mesh> mesh;
};

/// Keeps the GPU buffers of the meshes in use; a mesh that nothing holds any more is freed. Those
/// that poses deform have vertices of their own and share the rest with their mesh at rest.
class MeshStore {
public:
	explicit MeshStore(RenderingDevice &p_device) : device(p_device) {}

	/// Uploads the mesh the first time. The mesh must have triangles.
	const GpuMesh &get(const std::shared_ptr<const Mesh> &p_mesh);
	/// The mesh's tangents as its pose turns them, VERTEX. p_rest: those at rest, one a vertex,
	/// which live as long as the mesh at rest.
	BufferRID get_deformed_tangents(const std::shared_ptr<const Mesh> &p_mesh, BufferRID p_rest);
	/// Uploads those parts of the mesh's topology that were not requested before. Before passes are
	/// recorded.
	const GpuTopology &get_topology(
			const std::shared_ptr<const Mesh> &p_mesh, TopologyPart p_parts);
	/// What a technique of its own derives from a mesh, shared by all lights and cached as long as
	/// the mesh lives; p_make makes a T the first time. One T per mesh and type; meshes that poses
	/// deform have those of their mesh at rest.
	template <typename T, typename Make>
	const T &get_derived(const std::shared_ptr<const Mesh> &p_mesh, Make p_make) {
		const std::shared_ptr<const Mesh> &owner = p_mesh->rest ? p_mesh->rest : p_mesh;
		Derived &entry = derived[{ owner->id, std::type_index(typeid(T)) }];
		if (!entry.value) {
			entry = { std::make_shared<const T>(p_make()), owner };
		}
		return *static_cast<const T *>(entry.value.get());
	}
	/// Before all passes that read vertices: brings those of meshes that poses deform up to the
	/// scene's poses, also of buffers that are requested later in the frame. Those whose pose is
	/// the same as before stay as they are, where p_may_reuse. Returns how many instances' vertices
	/// the pass moves now.
	uint32_t add_deform_pass(
			RenderGraph &r_graph, const SceneSnapshot &p_scene, bool p_may_reuse = true);
	RenderingDevice &get_device() { return device; }
	/// Frees what belongs to meshes that are gone. Once a frame.
	void collect_garbage();
	size_t get_mesh_count() const { return meshes.size(); }

private:
	friend class DeformPass;
	/// Uploads what the deform pass will read of a mesh that poses deform.
	void prepare_deform(const std::shared_ptr<const Mesh> &p_mesh, bool p_has_topology);
	struct Derived {
		std::shared_ptr<const void> value;
		std::weak_ptr<const Mesh> mesh;
	};

	RenderingDevice &device;
	std::map<uint64_t, GpuMesh> meshes; // by Mesh::id
	std::map<uint64_t, GpuTopology> topologies;
	std::map<std::pair<uint64_t, std::type_index>, Derived> derived;
};

/// Vertex layouts that match MeshStore's buffers: position at location 0, normal at location 1.
std::vector<VertexAttribute> get_position_attributes();
std::vector<VertexAttribute> get_position_normal_attributes();

} // namespace gnomon
