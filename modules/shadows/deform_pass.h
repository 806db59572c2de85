#pragma once

#include "modules/shadows/mesh_store.h"

#include "shadows/shadows_shared.h"

#include <map>
#include <memory>

namespace gnomon {

/// Implements MeshStore::add_deform_pass. Which buffers to deform is decided when the pass is
/// recorded, because by then every reader of vertices has requested its buffers. Each of the
/// following reads results of the previous ones, so barriers separate them: vertices of rigged
/// meshes, those that a vertex program moves, vertices of meshes cut out of those, welded
/// positions, welded normals.
class DeformPass {
public:
	DeformPass(MeshStore &r_store, const SceneSnapshot &p_scene, RenderGraph &r_graph);

	bool is_needed() const { return !slots.empty(); }
	/// Number of posed instances whose vertices do not have the current pose yet.
	uint32_t count_moved() const;
	/// The frame's buffers that the pass reads.
	std::vector<RGBuffer> list_inputs() const;
	void record(PassContext &p_context);

private:
	/// A rigged mesh that is deformed in this frame, see PoseSlot.
	struct Slot {
		std::shared_ptr<const MeshPose> pose;
		std::shared_ptr<const Mesh> mesh; // the rigged mesh, from which others may be cut out
		RGBuffer pose_data;				  // three matrix rows per joint, then the morph weights
		PipelineRID program;			  // empty: no vertex program
		RGBuffer program_values;
	};
	/// One dispatch and the buffers that it writes.
	struct Work {
		PipelineRID pipeline;
		std::vector<Binding> bindings;
		std::vector<BufferRID> written;
		shader::DeformPush push;
	};

	/// Returns the slot of a mesh, null when the mesh is not deformed in this frame.
	const Slot *find_slot(const std::weak_ptr<const Mesh> &p_mesh) const;
	// Each of the next five adds dispatches to `pending`: for a rigged mesh, its vertex program, a
	// mesh cut out of one, welded positions, and welded normals.
	void deform_rigged(PassContext &p_context, const Slot &p_slot, GpuMesh &r_gpu);
	void move_by_program(PassContext &p_context, const Slot &p_slot, GpuMesh &r_gpu);
	void deform_points(
			const Slot &p_slot, const std::shared_ptr<const Mesh> &p_mesh, GpuMesh &r_gpu);
	void deform_welded(const std::shared_ptr<const Mesh> &p_mesh, GpuTopology &r_gpu);
	void deform_normals(const std::shared_ptr<const Mesh> &p_mesh, GpuTopology &r_gpu);
	/// Adds what a vertex program needs to its slot.
	void prepare_program(Slot &r_slot, RenderGraph &r_graph);
	/// Records the dispatches in `pending`, with barriers before and after them, and clears it.
	void run(CommandList &r_commands);

	MeshStore &store;
	std::map<uint64_t, Slot> slots;						   // by Mesh::slot_id
	PipelineRID rigged, tangents, points, welded, normals; // of the deform*.comp shaders
	std::vector<Work> pending;							   // for the next run()
};

} // namespace gnomon
