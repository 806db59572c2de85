#pragma once

#include "modules/scene/mesh_rig.h"

#include <godot_api.gen.h>

#include <memory>
#include <span>
#include <string>

namespace gnomon {

/// How a surface of a mesh of Godot deforms: its bones and weights, and its blend shapes as what
/// each adds to a vertex, whatever the mesh's mode. Of the latter the positions alone: shadows are
/// made of positions, and what Godot draws has Godot's normals. Null: it does not deform. p_arrays:
/// the surface's; p_positions: in them. What does not fit is an Error that names the mesh.
std::shared_ptr<const MeshRig> read_rig(const godot::Mesh &p_mesh, int64_t p_surface,
		const godot::Array &p_arrays, std::span<const glm::vec3> p_positions,
		const std::string &p_name);

} // namespace gnomon
