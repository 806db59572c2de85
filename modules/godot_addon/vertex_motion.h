#pragma once

#include "modules/godot_addon/vertex_programs.h"

#include <glm/glm.hpp>
#include <godot_api.gen.h>

#include <string>

namespace gnomon {

/// How a material moves the vertices of the meshes that it is on.
struct VertexMotion {
	enum class Billboard { NONE, FACING, UPRIGHT };
	Billboard billboard = Billboard::NONE;			// each instance turns to the camera
	bool keeps_scale = false;						// of the node, if it is a billboard
	float grow_m = 0;								// along the normals, in node space
	std::shared_ptr<const VertexFunction> function; // null: vertex() does not move it
	/// Why the drawn mesh is not known; empty: it is. Such surfaces cast no shadow of Gnomon, and
	/// receive none.
	std::string unknown_reason;

	bool operator==(const VertexMotion &) const = default;
};

VertexMotion read_vertex_motion(const godot::BaseMaterial3D &p_material);
/// The same for the shader of a ShaderMaterial.
VertexMotion read_vertex_motion(const ShaderText &p_shader);

/// Returns the transform with which a billboard is drawn. p_world_from_mesh: that of its node or
/// instance.
glm::dmat4 turn_to_camera(const VertexMotion &p_motion, const glm::dmat4 &p_world_from_mesh,
		const glm::dmat4 &p_world_from_camera);

} // namespace gnomon
