#pragma once

#include "modules/godot_addon/receiver_materials.h"
#include "modules/godot_addon/scene_body.h"
#include "modules/scene/mesh.h"

#include <vector>

namespace gnomon {

/// Bounds and render layers of a lit surface.
struct Receiver {
	Bounds bounds_world;
	uint32_t layers = 1;
};

/// The lit surfaces of a world.
struct WorldReceivers {
	std::vector<Receiver> masked; // their materials read masks
	std::vector<Receiver> others; // keep Godot's light and shadow
	/// Some of them are drawn transparent with materials that read masks. These materials need the
	/// depth of the masks, to see that the masks are not theirs.
	bool has_faded = false;
};
/// Whether one of the receivers is in the light's range and cull mask.
bool reaches(const godot::Light3D &p_light, const std::vector<Receiver> &p_receivers);

/// Collects lit surfaces, and makes their materials read masks. Main thread only.
class ReceiverReader {
public:
	explicit ReceiverReader(ReceiverMaterials &r_materials) : materials(r_materials) {}
	/// Adds a surface of p_mesh. p_material: empty if the surface has none. p_unknown_reason: see
	/// ReceiverMaterials::use.
	void read(const SceneBody &p_body, const godot::Material &p_material, const godot::Mesh &p_mesh,
			int64_t p_surface, const Bounds &p_bounds_world,
			const std::string &p_unknown_reason = {});
	/// Adds a node whose triangles are not read, such as a sprite, a label or particles.
	void read_other(const SceneBody &p_body, const Bounds &p_bounds_world);
	/// Adds a surface that is no node's.
	void add(ReceiverKind p_kind, const Bounds &p_bounds_world, uint32_t p_layers);
	/// Returns the surfaces that were added since the last call.
	WorldReceivers take() { return std::exchange(world, {}); }

private:
	void read_mesh(
			const SceneBody &p_body, const godot::Mesh &p_mesh, const Bounds &p_bounds_world);
	void add_receiver(const SceneBody &p_body, ReceiverKind p_kind, const Bounds &p_bounds_world);

	ReceiverMaterials &materials;
	WorldReceivers world;
};

} // namespace gnomon
