#pragma once

#include "modules/render_graph/render_graph.h"
#include "modules/rendering_device/rendering_device.h"
#include "modules/scene/mesh_pose.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/gpu_topology.h"

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <typeindex>
#include <utility>

namespace gnomon {

/// Name of the pass of MeshStore::add_deform_pass, which all lights share.
inline constexpr char DEFORM_PASS_NAME[] = "deform";

/// One mesh in GPU memory.
struct GpuMesh {
	OwnedBuffer positions;	 // VERTEX | STORAGE, three floats each
	OwnedBuffer normals;	 // VERTEX | STORAGE, three floats each
	SharedBuffer indices;	 // INDEX | STORAGE
	OwnedBuffer tangents;	 // only of a deformed mesh, once requested: four floats each
	BufferRID rest_tangents; // tangents at rest, from which `tangents` are computed
	uint32_t index_count = 0;
	uint64_t pose_hash = 0; // hash of the pose that the vertices have; 0: deform them again
	std::weak_ptr<const Mesh> mesh;
};

/// Keeps the GPU buffers of meshes; collect_garbage() frees those of meshes that no longer exist.
/// Deformed meshes have their own vertices and share the other buffers with their mesh at rest.
class MeshStore {
public:
	explicit MeshStore(RenderingDevice &p_device) : device(p_device) {}

	/// Returns the mesh's buffers, uploaded on the first call. The mesh must have triangles.
	const GpuMesh &get(const std::shared_ptr<const Mesh> &p_mesh);
	/// The mesh's tangents at its pose, a VERTEX buffer. p_rest: the tangents at rest, one per
	/// vertex, which must live as long as the mesh at rest.
	BufferRID get_deformed_tangents(const std::shared_ptr<const Mesh> &p_mesh, BufferRID p_rest);
	/// Returns the mesh's topology and uploads the requested buffers that do not exist yet. Call
	/// before passes are recorded.
	const GpuTopology &get_topology(
			const std::shared_ptr<const Mesh> &p_mesh, TopologyBuffer p_buffers);
	/// Data that a technique derives from a mesh, shared by all lights and cached as long as the
	/// mesh lives; p_make creates a T on the first call. One T per mesh and type; deformed meshes
	/// use the T of their mesh at rest.
	template <typename T, typename Make>
	const T &get_derived(const std::shared_ptr<const Mesh> &p_mesh, Make p_make) {
		const std::shared_ptr<const Mesh> &owner = p_mesh->rest ? p_mesh->rest : p_mesh;
		Derived &entry = derived[{ owner->id, std::type_index(typeid(T)) }];
		if (!entry.value) {
			entry = { std::make_shared<const T>(p_make()), owner };
		}
		return *static_cast<const T *>(entry.value.get());
	}
	/// State that a technique shares among all lights, created from the device on the first call
	/// and cached as long as the store.
	template <typename T> T &get_shared() {
		std::shared_ptr<void> &entry = shared[std::type_index(typeid(T))];
		if (!entry) {
			entry = std::make_shared<T>(device);
		}
		return *static_cast<T *>(entry.get());
	}
	/// Sets how textures of vertex programs are found: it returns the device's texture for one of
	/// the host engine's, empty if there is none any more.
	void set_texture_source(std::function<TextureRID(const ProgramTexture &)> p_source) {
		texture_source = std::move(p_source);
	}
	/// Makes the next deform pass deform all meshes again. Call it after a frame whose commands
	/// were recorded but not executed.
	void forget_poses();
	/// Number of calls of forget_poses(). Copies of deformed vertices are valid until it changes.
	uint64_t get_forget_count() const { return forget_count; }
	/// Adds the pass that deforms meshes to the scene's poses. Call it before all passes that read
	/// vertices; buffers that are requested later in the frame are deformed too. With p_may_reuse,
	/// vertices whose pose did not change stay as they are. Returns the number of instances that
	/// it deforms.
	uint32_t add_deform_pass(
			RenderGraph &r_graph, const SceneSnapshot &p_scene, bool p_may_reuse = true);
	RenderingDevice &get_device() { return device; }
	/// Frees the buffers of meshes that no longer exist. Call once a frame.
	void collect_garbage();
	size_t get_mesh_count() const { return meshes.size(); }

private:
	friend class DeformPass;
	SamplerRID get_sampler(const ProgramTexture &p_texture);
	/// Uploads the data of a deformed mesh that the deform pass reads.
	void prepare_deform(const std::shared_ptr<const Mesh> &p_mesh, bool p_has_topology);
	struct Derived {
		std::shared_ptr<const void> value;
		std::weak_ptr<const Mesh> mesh;
	};

	RenderingDevice &device;
	std::function<TextureRID(const ProgramTexture &)> texture_source;
	std::set<std::string> added_programs; // shaders of vertex programs that the device has
	std::map<std::pair<bool, bool>, OwnedSampler> samplers; // by is_nearest and repeats
	std::map<std::type_index, std::shared_ptr<void>> shared;
	std::map<uint64_t, GpuMesh> meshes; // by Mesh::id
	uint64_t forget_count = 0;
	std::map<uint64_t, GpuTopology> topologies;
	std::map<std::pair<uint64_t, std::type_index>, Derived> derived;
};

/// Vertex layouts that match MeshStore's buffers: position at location 0, normal at location 1.
std::vector<VertexAttribute> get_position_attributes();
std::vector<VertexAttribute> get_position_normal_attributes();

} // namespace gnomon
