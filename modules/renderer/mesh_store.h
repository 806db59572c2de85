#pragma once

#include "modules/renderer/light_view.h"
#include "modules/renderer/shadow_technique.h"
#include "modules/rendering_device/rendering_device.h"
#include "modules/scene/mesh.h"

#include <map>
#include <memory>

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
	/// Frees what belongs to meshes that are gone. Once a frame.
	void collect_garbage();
	size_t get_mesh_count() const { return meshes.size(); }

private:
	RenderingDevice &device;
	std::map<uint64_t, GpuMesh> meshes; // by Mesh::id
};

/// Vertex layouts that match MeshStore's buffers: position at location 0, normal at location 1.
std::vector<VertexAttribute> get_position_attributes();
std::vector<VertexAttribute> get_position_normal_attributes();

/// A pass that draws a view's casters, depth only, into one layer of a D32_SFLOAT texture: both
/// sides, reversed depth, depth clamped at the near plane where the device can, cleared first.
void add_depth_pass(RenderGraph &r_graph, const std::string &p_name,
		const ShadowTechnique::Inputs &p_inputs, const LightView &p_view,
		const CasterList &p_casters, RGTexture p_target, uint32_t p_layer);

} // namespace gnomon
