#pragma once

#include "modules/godot_addon/receiver_materials.h"
#include "modules/godot_addon/scene_body.h"
#include "modules/scene/mesh.h"

#include <vector>

namespace gnomon {

/// A surface that takes light, and in which layers it is.
struct Receiver {
	Bounds bounds_world;
	uint32_t layers = 1;
};

/// The surfaces of a world that take light.
struct WorldReceivers {
	std::vector<Receiver> masked; // read masks
	std::vector<Receiver> others; // stay in Godot's light and shadow
};
/// Whether one of them is in the light's reach.
bool reaches(const godot::Light3D &p_light, const std::vector<Receiver> &p_receivers);

/// Finds them, and gives their materials masks to read. Main thread only.
class ReceiverReader {
public:
	explicit ReceiverReader(ReceiverMaterials &r_materials) : materials(r_materials) {}
	/// Reads a surface of a mesh that shows p_material; an empty one: the surface has no material.
	void read(const SceneBody &p_body, const godot::Material &p_material, const godot::Mesh &p_mesh,
			int64_t p_surface, const Bounds &p_bounds_world);
	/// Sprites, labels and particles, whose triangles are not read.
	void read_other(const SceneBody &p_body, const Bounds &p_bounds_world);
	/// What was read since the last time.
	WorldReceivers take() { return std::exchange(world, {}); }

private:
	void read_mesh(
			const SceneBody &p_body, const godot::Mesh &p_mesh, const Bounds &p_bounds_world);
	void note(const SceneBody &p_body, ReceiverKind p_kind, const Bounds &p_bounds_world);

	ReceiverMaterials &materials;
	WorldReceivers world;
};

} // namespace gnomon
