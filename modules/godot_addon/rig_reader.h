#pragma once

#include "modules/scene/mesh_rig.h"

#include <godot_api.gen.h>

#include <memory>
#include <span>
#include <string>

namespace gnomon {

/// Reads the bone weights and blend shapes of a surface; returns null if it has neither. Blend
/// shapes become offsets from the rest positions, whatever the mesh's blend shape mode. Their
/// normals are not read: shadows need only positions, and Godot itself draws the surface. p_arrays:
/// arrays of the surface. p_positions: its vertex positions. Throws an Error that names the mesh
/// p_name if the data is invalid.
std::shared_ptr<const MeshRig> read_rig(const godot::Mesh &p_mesh, int64_t p_surface,
		const godot::Array &p_arrays, std::span<const glm::vec3> p_positions,
		const std::string &p_name);

} // namespace gnomon
