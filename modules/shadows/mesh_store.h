#pragma once

#include "modules/rendering_device/rendering_device.h"
#include "modules/scene/mesh.h"
#include "modules/shadows/gpu_topology.h"

#include <map>
#include <memory>
#include <typeindex>
#include <utility>

namespace gnomon {

/// One mesh in GPU memory.
struct GpuMesh {
	OwnedBuffer positions; // VERTEX | STORAGE, three floats each
	OwnedBuffer normals;   // VERTEX
	OwnedBuffer indices;   // INDEX | STORAGE
	uint32_t index_count = 0;
	std::weak_ptr<const Mesh> mesh;
};

/// Keeps the GPU buffers of the meshes in use; a mesh that nobody holds any more is freed.
class MeshStore {
public:
	explicit MeshStore(RenderingDevice &p_device) : device(p_device) {}

	/// Uploads the mesh the first time. The mesh must have triangles.
	const GpuMesh &get(const std::shared_ptr<const Mesh> &p_mesh);
	/// Uploads those parts of the mesh's topology that nobody asked for before. Before passes are
	/// recorded.
	const GpuTopology &get_topology(
			const std::shared_ptr<const Mesh> &p_mesh, TopologyPart p_parts);
	/// What a technique of its own derives from a mesh, shared by all lights and kept as long as
	/// the mesh lives; p_make makes a T the first time. One T per mesh and type.
	template <typename T, typename Make>
	const T &get_derived(const std::shared_ptr<const Mesh> &p_mesh, Make p_make) {
		Derived &entry = derived[{ p_mesh->id, std::type_index(typeid(T)) }];
		if (!entry.value) {
			entry = { std::make_shared<const T>(p_make()), p_mesh };
		}
		return *static_cast<const T *>(entry.value.get());
	}
	RenderingDevice &get_device() { return device; }
	/// Frees what belongs to meshes that are gone. Once a frame.
	void collect_garbage();
	size_t get_mesh_count() const { return meshes.size(); }

private:
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
