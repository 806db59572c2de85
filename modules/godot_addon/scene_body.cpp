#include "modules/godot_addon/scene_body.h"

namespace gnomon {

namespace {

bool is_empty(const godot::AABB &p_box) {
	return p_box.size == glm::vec3(0.0f);
}

} // namespace

godot::AABB get_culling_box(const godot::GeometryInstance3D &p_node) {
	if (const godot::AABB custom = p_node.get_custom_aabb(); !is_empty(custom)) {
		return custom;
	}
	// The box of particles that get_aabb() returns is empty.
	if (const auto particles = godot::cast<godot::GPUParticles3D>(p_node)) {
		return particles.get_visibility_aabb();
	}
	if (const auto particles = godot::cast<godot::CPUParticles3D>(p_node)) {
		const godot::AABB visibility = particles.get_visibility_aabb();
		return is_empty(visibility)
				? godot::RenderingServer(godot::find_singleton("RenderingServer"))
						  .multimesh_get_aabb(p_node.get_base())
				: visibility;
	}
	return p_node.get_aabb();
}

} // namespace gnomon
