#include "modules/shadow_reference/reference_input.h"

namespace gnomon {

std::vector<ReceiverPoint> make_receiver_points(std::span<const SurfacePoint> p_surfaces,
		const std::function<bool(size_t)> &p_is_receiver) {
	std::vector<ReceiverPoint> points(p_surfaces.size());
	for (size_t pixel = 0; pixel < points.size(); ++pixel) {
		if (p_surfaces[pixel].is_there && p_is_receiver(pixel)) {
			points[pixel] = { p_surfaces[pixel].position, p_surfaces[pixel].geometric_normal,
				true };
		}
	}
	return points;
}

CasterTriangles collect_triangles(const SceneSnapshot &p_scene) {
	CasterTriangles triangles;
	for (const InstanceSnapshot &instance : p_scene.instances) {
		if (!instance.casts_shadow) {
			continue;
		}
		const glm::mat4 matrix = p_scene.get_camera_relative_from_node(instance);
		const uint32_t first = static_cast<uint32_t>(triangles.positions.size());
		for (const glm::vec3 &position : instance.mesh->positions_node) {
			triangles.positions.push_back(glm::vec3(matrix * glm::vec4(position, 1.0f)));
		}
		for (uint32_t index : instance.mesh->indices) {
			triangles.indices.push_back(first + index);
		}
	}
	return triangles;
}

AreaLight make_area_light(const SceneSnapshot &p_scene, const LightSnapshot &p_light) {
	AreaLight light;
	light.is_directional = p_light.type == LightType::DIRECTIONAL;
	if (!light.is_directional) {
		light.position = p_scene.to_camera_relative(p_light.position_world);
	}
	light.direction = glm::vec3(p_light.get_direction_world());
	light.disc_radius = p_light.get_disc_radius();
	return light;
}

} // namespace gnomon
