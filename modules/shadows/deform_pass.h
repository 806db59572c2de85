#pragma once

#include "modules/shadows/mesh_store.h"

#include "shadows/shadows_shared.h"

#include <map>
#include <memory>

namespace gnomon {

/// The work of MeshStore::add_deform_pass. It is determined while the pass is recorded, when every
/// reader of vertices has requested its buffers. Three steps, each of which reads what the step
/// before wrote: vertices of rigged meshes, vertices of meshes cut out of those, welded vertices.
class DeformPass {
public:
	DeformPass(MeshStore &r_store, const SceneSnapshot &p_scene, RenderGraph &r_graph);

	bool is_needed() const { return !slots.empty(); }
	/// Number of instances whose vertices do not have the current pose yet.
	uint32_t count_moved() const;
	/// The frame's buffers that the pass reads.
	std::vector<RGBuffer> list_inputs() const;
	void record(PassContext &p_context);

private:
	struct Slot {
		std::shared_ptr<const MeshPose> pose;
		std::shared_ptr<const Mesh> mesh; // the slot's whole mesh
		RGBuffer words;					  // the joints' rows and the targets' weights
	};
	/// One dispatch and what it writes.
	struct Work {
		PipelineRID pipeline;
		std::vector<Binding> bindings;
		std::vector<BufferRID> written;
		shader::DeformPush push;
	};

	const Slot *find_slot(const std::weak_ptr<const Mesh> &p_mesh) const;
	void deform_whole(PassContext &p_context, const Slot &p_slot, GpuMesh &r_gpu);
	void deform_points(
			const Slot &p_slot, const std::shared_ptr<const Mesh> &p_mesh, GpuMesh &r_gpu);
	void deform_welded(const std::shared_ptr<const Mesh> &p_mesh, GpuTopology &r_gpu);
	void deform_normals(const std::shared_ptr<const Mesh> &p_mesh, GpuTopology &r_gpu);
	/// Records the dispatches in `step` and a barrier after them.
	void run(CommandList &r_commands);

	MeshStore &store;
	std::map<uint64_t, Slot> slots; // by Mesh::slot_id
	PipelineRID whole, tangents, points, welded, normals;
	std::vector<Work> step;
};

} // namespace gnomon
