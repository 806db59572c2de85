#pragma once

#include "modules/godot_addon/receiver_shader.h"
#include "modules/godot_addon/watched_resource.h"

#include <map>
#include <set>

namespace gnomon {

/// Gives materials in use a copy of their shader whose light() reads masks, on Godot's
/// RenderingServer alone: no resource and no scene changes. Main thread only.
///
/// A BaseMaterial3D gives its generated shader to the editor's viewer of shaders alone: nodes of a
/// group are called, before the next frame.
class ReceiverMaterials {
public:
	ReceiverMaterials();
	/// Takes everything back.
	~ReceiverMaterials();
	ReceiverMaterials(const ReceiverMaterials &) = delete;
	ReceiverMaterials &operator=(const ReceiverMaterials &) = delete;

	/// Before the materials of a frame are used.
	void begin_frame();
	/// Of a surface that shows p_material; p_owner: the node, for messages. GODOT where it stays as
	/// it is, with one warning, and as long as its shader is not known.
	ReceiverKind use(const godot::Material &p_material, const godot::Node &p_owner);
	/// Of a surface of p_mesh that has no material.
	ReceiverKind use_bare(const godot::Mesh &p_mesh, int64_t p_surface);
	/// Once all materials of a frame are used: queries their shaders, and gives those that it does
	/// not use their own back. p_node: of the class GnomonShadow3D.
	void end_frame(const godot::Node &p_node, const godot::SceneTree &p_tree);
	/// Takes everything back: all looks as without the add-on.
	void clear();

private:
	/// A material in use.
	struct Known {
		godot::RID original; // its shader; none: not known yet
		godot::RID applied;	 // the original whose copy it has; none: it has its own
		bool is_generated = false;
		bool is_used = false;
		bool is_warned = false;
	};
	/// A shader's copy.
	struct Copy {
		ReceiverShader receiver;
		godot::RID shader;						  // PATCHED
		godot::Ref<godot::Resource> holder;		  // keeps the original
		std::unique_ptr<WatchedResource> watched; // of a ShaderMaterial
	};
	Copy &find_copy(const Known &p_known, const godot::Material &p_material);
	void copy_code(godot::RID p_original, Copy &r_copy) const;
	void restore(uint64_t p_material, const Known &p_known) const;
	void restore_bare(uint64_t p_mesh) const;
	void take_answers();
	void make_bare_material();
	void free(godot::RID &r_owned) const;

	godot::RenderingServer server;
	std::map<uint64_t, Known> materials; // by id
	std::map<godot::RID, Copy> copies;	 // by original
	std::vector<uint64_t> queried;		 // materials, in the order of the answers
	std::vector<godot::RID> answers;
	int silent_frames = 0; // in a row, in which not all answered
	godot::RID bare_shader;
	godot::RID bare_material;
	std::set<uint64_t> bare_meshes; // ids
	std::set<uint64_t> used_bare_meshes;
};

} // namespace gnomon
