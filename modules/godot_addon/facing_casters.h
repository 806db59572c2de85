#pragma once

#include "modules/godot_addon/mesh_reader.h"

#include <glm/glm.hpp>

namespace gnomon {

/// Which faces of a surface Godot culls in its shadow maps.
enum class ShadowCulling {
	NONE,
	BACK, // those that face away from the light
	FRONT,
};

/// Culls the faces of meshes that Godot culls in its shadow passes. Parts that are closed and
/// not inside out remain whole if the light is outside of the mesh's box, because that does not
/// change their shadow. A lamp inside its bulb shines through it, as in Godot. Main thread only.
class FacingCasters {
public:
	explicit FacingCasters(MeshReader &r_meshes) : meshes(r_meshes) {}
	/// The GnomonShadow3D's id, and the index of the instance in the scene.
	using Slot = std::pair<uint64_t, size_t>;
	/// Returns the mesh that casts the shadow of a light: p_mesh itself, or the faces that are
	/// left; null: none. p_slot: identifies the instance and the light; while a large mesh is
	/// prepared, its former one is returned. p_light_mesh: in mesh space, the light's position with
	/// w = 1, or the direction to it with w = 0.
	std::shared_ptr<const Mesh> select(const std::shared_ptr<const Mesh> &p_mesh,
			const Slot &p_slot, const glm::dvec4 &p_light_mesh, ShadowCulling p_culling);
	/// Removes meshes that were not used in this frame. Call once per frame.
	void forget_unused();

private:
	struct Entry {
		std::weak_ptr<const Mesh> source;
		glm::dvec4 light_mesh = glm::dvec4(0.0);
		ShadowCulling culling = ShadowCulling::NONE;
		std::vector<bool> casts; // per face
		std::shared_ptr<const Mesh> mesh;
		std::shared_ptr<const Mesh> next; // not ready yet
		bool is_used = false;
	};
	MeshReader &meshes;
	std::map<Slot, Entry> entries;
	/// Whether all parts of a mesh are closed and not inside out, by Mesh::id.
	std::map<uint64_t, std::pair<std::weak_ptr<const Mesh>, bool>> solid_meshes;
	bool is_solid(const std::shared_ptr<const Mesh> &p_mesh);
};

} // namespace gnomon
