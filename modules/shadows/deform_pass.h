#pragma once

#include "modules/shadows/mesh_store.h"

#include "shadows/shadows_shared.h"

#include <map>
#include <memory>

namespace gnomon {

/// The work of MeshStore::add_deform_pass, found when the pass is recorded: by then all that reads
/// vertices has requested its buffers. In three steps, each with what the one before wrote:
/// vertices of the meshes with rigs, those of what was cut out of them, welded ones.
class DeformPass {
public:
	DeformPass(MeshStore &r_store, const SceneSnapshot &p_scene, RenderGraph &r_graph);

	bool is_needed() const { return !slots.empty(); }
	/// Instances whose vertices do not have their pose yet.
	uint32_t count_moved() const;
	/// What the pass reads of the frame.
	std::vector<RGBuffer> list_inputs() const;
	void record(PassContext &p_context);

private:
	struct Slot {
		std::shared_ptr<const MeshPose> pose;
		std::shared_ptr<const Mesh> mesh; // of the slot, whole
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
	/// Records what was found and waits for it.
	void run(CommandList &r_commands);

	MeshStore &store;
	std::map<uint64_t, Slot> slots; // by Mesh::slot_id
	PipelineRID whole, tangents, points, welded, normals;
	std::vector<Work> step;
};

} // namespace gnomon
