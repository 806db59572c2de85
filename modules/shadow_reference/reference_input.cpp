#include "modules/shadow_reference/reference_input.h"

#include <cmath>

namespace gnomon {

namespace {

void add_triangles(
		const SceneSnapshot &p_scene, const InstanceSnapshot &p_instance, Triangles &r_triangles) {
	const glm::mat4 matrix = p_scene.get_camera_relative_from_node(p_instance);
	const uint32_t first = static_cast<uint32_t>(r_triangles.positions.size());
	const std::shared_ptr<const Mesh> mesh = p_instance.get_posed_mesh();
	for (const glm::vec3 &position : mesh->positions_node) {
		r_triangles.positions.push_back(glm::vec3(matrix * glm::vec4(position, 1.0f)));
	}
	for (uint32_t index : mesh->indices) {
		r_triangles.indices.push_back(first + index);
	}
}

CutOutTriangles make_cut_out(const SceneSnapshot &p_scene, const InstanceSnapshot &p_instance) {
	CutOutTriangles body;
	add_triangles(p_scene, p_instance, body.triangles);
	const MeshAttributes &attributes = p_instance.mesh->attributes;
	const Material &material = *p_instance.material;
	const Texture &texture = material.base_color_texture;
	for (size_t i = 0; i < body.triangles.positions.size(); ++i) {
		const std::vector<glm::vec2> &uvs = attributes.uvs[texture.uv_set];
		body.uvs.push_back(texture.transform_uv(uvs.empty() ? glm::vec2(0.0f) : uvs[i]));
		body.alphas.push_back(
				material.alpha * (attributes.colors.empty() ? 1.0f : attributes.colors[i].w));
	}
	body.image = texture.image;
	body.test = make_alpha_test(material);
	return body;
}

} // namespace

std::vector<ReceiverPoint> make_receiver_points(std::span<const SurfacePoint> p_surfaces,
		const SurfaceSpread *p_spread, const std::function<bool(size_t)> &p_is_receiver) {
	std::vector<ReceiverPoint> points(p_surfaces.size());
	for (size_t pixel = 0; pixel < points.size(); ++pixel) {
		const SurfacePoint &surface = p_surfaces[pixel];
		if (surface.is_valid && p_is_receiver(pixel)) {
			points[pixel] = { surface.position, surface.geometric_normal, /*is_receiver=*/true,
				p_spread != nullptr
						? p_spread->compute_radius_m(surface.material, surface.pixel_size_m)
						: 0.0f,
				surface.receiver_offset_m };
		}
	}
	return points;
}

CasterTriangles collect_triangles(const SceneSnapshot &p_scene) {
	CasterTriangles triangles;
	for (const InstanceSnapshot &instance : p_scene.instances) {
		const glm::vec3 transmittance = instance.compute_transmittance();
		if (!instance.casts_shadow) {
			continue;
		}
		if (instance.material->is_cut_out()) {
			triangles.cut_out.push_back(make_cut_out(p_scene, instance));
		} else if (transmittance == glm::vec3(0.0f)) {
			add_triangles(p_scene, instance, triangles.opaque);
		} else if (transmittance != glm::vec3(1.0f)) {
			TranslucentTriangles &body = triangles.translucent.emplace_back();
			body.transmittance = transmittance;
			add_triangles(p_scene, instance, body.triangles);
		}
	}
	return triangles;
}

std::vector<Triangles> collect_spread_bodies(
		const SceneSnapshot &p_scene, const SurfaceSpread *p_spread) {
	std::vector<Triangles> bodies;
	for (const InstanceSnapshot &instance : p_scene.instances) {
		const SurfaceMaterial material = { instance.material->scatter,
			instance.material->scatter_distance_m };
		constexpr float ANY_PIXEL_SIZE_M = 1.0f; // it does not decide whether the radius is 0
		if (p_spread != nullptr && p_spread->compute_radius_m(material, ANY_PIXEL_SIZE_M) > 0.0f) {
			add_triangles(p_scene, instance, bodies.emplace_back());
		}
	}
	return bodies;
}

AreaLight make_area_light(const SceneSnapshot &p_scene, const LightSnapshot &p_light) {
	AreaLight light;
	light.is_directional = p_light.type == LightType::DIRECTIONAL;
	if (!light.is_directional) {
		light.position = p_scene.to_camera_relative(p_light.position_world);
	}
	light.direction = glm::vec3(p_light.get_direction_world());
	light.disc_radius = p_light.get_disc_radius();
	light.range_m = p_light.range_m;
	light.cos_outer = p_light.type == LightType::SPOT ? std::cos(p_light.outer_cone_rad) : -1.0f;
	return light;
}

} // namespace gnomon
