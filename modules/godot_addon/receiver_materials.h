#pragma once

#include "modules/godot_addon/notices.h"
#include "modules/godot_addon/receiver_shader.h"
#include "modules/godot_addon/watched_resource.h"

#include <map>
#include <set>

namespace gnomon {

/// Replaces the shaders of materials in use by copies whose light() reads masks. This changes only
/// materials, and surfaces of meshes without a material, of the RenderingServer; no resource and no
/// scene. Main thread only.
///
/// Godot returns the generated shader of a BaseMaterial3D only to its native shader viewer:
/// inspect_native_shader_code() calls the nodes of the viewer's group before the next frame.
class ReceiverMaterials {
public:
	explicit ReceiverMaterials(Notices &r_notices);
	/// Restores all materials.
	~ReceiverMaterials();
	ReceiverMaterials(const ReceiverMaterials &) = delete;
	ReceiverMaterials &operator=(const ReceiverMaterials &) = delete;

	/// Call before the use() calls of a frame. Takes over the shaders that Godot returned since
	/// end_frame(), and frees copies that no material uses. p_max_copies: how many shaders may be
	/// copied, and thus compiled, in this frame.
	void begin_frame(uint32_t p_max_copies);
	static constexpr uint32_t UNLIMITED = ~0u;
	/// Whether a shader was copied in this frame.
	bool has_copied() const { return copies_left < max_copies; }
	/// Makes p_material, and its next passes, read masks if possible. p_owner: the node, for
	/// messages. Returns GODOT if the material is not supported, with one warning, while the
	/// generated shader of a BaseMaterial3D is not known yet, and while its copy has to wait.
	/// p_unknown_reason: why the drawn surface is not known, see VertexMotion; empty: it is known.
	ReceiverKind use(const godot::Material &p_material, const godot::Node &p_owner,
			const std::string &p_unknown_reason = {});
	/// The same for a surface of p_mesh without a material, which gets a default one.
	ReceiverKind use_bare(const godot::Mesh &p_mesh, int64_t p_surface);
	/// Call after all use() calls of a frame. Queries the generated shaders of the used
	/// BaseMaterial3Ds, and restores unused materials. p_node: a GnomonShadow3D, which receives the
	/// shaders.
	void end_frame(const godot::Node &p_node, const godot::SceneTree &p_tree);
	/// Restores all materials, so that everything looks as without the add-on.
	void clear();

private:
	/// A material in use.
	struct MaterialState {
		godot::RID original;	   // its own shader; empty: not known yet
		godot::RID applied;		   // original of the copy that is set; empty: no copy is set
		bool is_generated = false; // a BaseMaterial3D, whose shader Godot generates
		bool is_used = false;	   // in this frame
	};
	/// The copy of a shader.
	struct Copy {
		ReceiverShader receiver;
		godot::RID shader;						  // if PATCHED
		godot::Ref<godot::Resource> holder;		  // keeps the original alive
		std::unique_ptr<WatchedResource> watched; // the shader of a ShaderMaterial
	};
	/// Whether the copy of the shader exists, or may be made in this frame.
	bool may_copy(godot::RID p_original) const {
		return copies_left > 0 || copies.contains(p_original);
	}
	Copy &find_copy(const MaterialState &p_state, const godot::Material &p_material);
	void copy_code(const MaterialState &p_state, Copy &r_copy);
	void restore(uint64_t p_material, const MaterialState &p_state) const;
	void restore_bare(uint64_t p_mesh) const;
	void take_inspected_shaders();
	void make_bare_material();
	void free(godot::RID &r_owned) const;

	Notices &notices;
	godot::RenderingServer server;
	std::map<uint64_t, MaterialState> materials; // by material id
	std::map<godot::RID, Copy> copies;			 // by original shader
	std::vector<uint64_t> queried;			   // ids of materials whose shaders end_frame() queried
	std::vector<godot::RID> inspected_shaders; // of `queried`, in its order; fewer: none is used
	uint32_t max_copies = UNLIMITED;
	uint32_t copies_left = UNLIMITED;
	int incomplete_frames = 0; // consecutive frames in which shaders were missing
	godot::RID bare_shader;
	godot::RID bare_material;
	std::set<uint64_t> bare_meshes; // mesh ids
	std::set<uint64_t> used_bare_meshes;
};

} // namespace gnomon
