#pragma once

#include <glm/glm.hpp>
#include <godot_api.gen.h>

#include <cstdint>
#include <string>

namespace gnomon {

/// The values that all surfaces of a node share.
struct SceneBody {
	godot::Node3D node;
	std::string name;
	uint32_t layers = 1;
	bool casts_shadow = true;
	bool is_double_sided = false; // casts with all faces, whatever its materials cull
	bool is_drawn = true;		  // false: it only casts a shadow
	bool is_faded = false;		  // a view draws it transparent, whatever its materials are
	float detail_bias = 1;		  // lod_bias
	size_t instance = 0;		  // the one that is read, of a MultiMesh or a GridMap
	size_t instance_count = 1;
	bool has_instance_colors = false; // of a MultiMesh
};

/// Returns the transform with which Godot draws a node in this frame, with physics interpolation.
inline godot::Transform3D get_drawn_transform(const godot::Node3D &p_node) {
	return p_node.is_physics_interpolated_and_enabled() ? p_node.get_global_transform_interpolated()
														: p_node.get_global_transform();
}

/// Returns the node's box, in its own space, by which Godot culls it, without extra_cull_margin.
godot::AABB get_culling_box(const godot::GeometryInstance3D &p_node);

} // namespace gnomon
