#include "modules/error_report/light_variant.h"

#include "modules/core/error.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace gnomon {

namespace {

/// Distance from the casters at which a directional light is placed, as a multiple of the scene
/// size S. It is about that of the lights in the benchmark scenes.
const double DISTANCE_IN_SCENE_SIZES = 1.5;
const double MAX_CONE_RAD = 1.4; // half angle; that of a spot light must not exceed pi / 2
const double CONE_MARGIN = 1.1;	 // keeps the bounding sphere of the casters inside the cone

/// References to the members of a light that build_variant changes.
auto tie_state(Light3D &r_light) {
	return std::tie(r_light.type, r_light.parent_from_node, r_light.range_m, r_light.inner_cone_rad,
			r_light.outer_cone_rad, r_light.properties);
}

/// Saves the state of a light and of its children's transforms, and restores it when destroyed.
class LightStateGuard {
public:
	explicit LightStateGuard(Light3D &r_light) : light(r_light), saved(tie_state(r_light)) {
		for (const std::unique_ptr<Node3D> &child : r_light.children) {
			light_from_children.push_back(child->parent_from_node);
		}
	}
	~LightStateGuard() {
		tie_state(light) = saved;
		for (size_t index = 0; index < light_from_children.size(); ++index) {
			light.children[index]->parent_from_node = light_from_children[index];
		}
	}
	LightStateGuard(const LightStateGuard &) = delete;
	LightStateGuard &operator=(const LightStateGuard &) = delete;

private:
	Light3D &light;
	std::tuple<LightType, glm::dmat4, float, float, float, PropertyValues> saved;
	std::vector<glm::dmat4> light_from_children;
};

/// Changes the type of the light and aims it at the casters, see build_variant. p_before: the light
/// in the unchanged p_scene.
void change_type(Light3D &r_light, const LightSnapshot &p_before, const SceneSnapshot &p_scene,
		LightType p_type) {
	const Bounds bounds = p_scene.compute_caster_bounds();
	if (bounds.is_empty()) {
		fail("Light \"", r_light.name, "\": nothing in the scene casts a shadow, so that a light ",
				"of another type has nothing to look at. Use --light-types own.");
	}
	const glm::dvec3 center = (bounds.minimum + bounds.maximum) * 0.5;
	glm::dvec3 position = p_before.position_world;
	if (p_before.type == LightType::DIRECTIONAL) {
		position = center -
				p_before.get_direction_world() * (DISTANCE_IN_SCENE_SIZES * p_scene.scene_size_m);
	}
	const glm::dvec3 to_center = center - position;
	const double distance = glm::length(to_center);
	const glm::dvec3 direction = distance > 0 ? to_center / distance : glm::dvec3(0, -1, 0);
	const glm::dvec3 up = std::abs(direction.y) < 0.99 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
	const glm::dmat4 world_from_light =
			glm::inverse(glm::lookAtRH(position, position + direction, up));
	const glm::dmat4 world_from_parent =
			r_light.parent ? r_light.parent->compute_world_from_node() : glm::dmat4(1.0);
	const glm::dmat4 parent_from_light = glm::inverse(world_from_parent) * world_from_light;
	// Child nodes of the light, such as a lampshade or a camera, keep their world transform.
	const glm::dmat4 new_from_old = glm::inverse(parent_from_light) * r_light.parent_from_node;
	for (const std::unique_ptr<Node3D> &child : r_light.children) {
		child->parent_from_node = new_from_old * child->parent_from_node;
	}
	r_light.parent_from_node = parent_from_light;
	const double sin_half_angle = bounds.get_diagonal() * 0.5 / std::max(distance, 1e-9);
	const double cone_rad =
			sin_half_angle < 1 ? std::asin(sin_half_angle) * CONE_MARGIN : MAX_CONE_RAD;
	r_light.type = p_type;
	r_light.range_m = 0;
	r_light.inner_cone_rad = 0;
	r_light.outer_cone_rad = static_cast<float>(std::min(cone_rad, MAX_CONE_RAD));
}

} // namespace

const LightSnapshot &get_light(const SceneSnapshot &p_scene, const std::string &p_name) {
	const LightSnapshot *light = p_scene.find_light(p_name);
	GNOMON_ASSERT(light != nullptr, "no light ", p_name);
	return *light;
}

double compute_own_size(const Light3D &p_light, double p_scene_size_m) {
	const PropertyList &list = Light3D::get_property_list();
	if (p_light.type != LightType::DIRECTIONAL) {
		return get_float(list, p_light.properties, "light_size");
	}
	const double angle =
			glm::radians(get_float(list, p_light.properties, "light_angular_distance"));
	return DISTANCE_IN_SCENE_SIZES * p_scene_size_m * std::tan(angle / 2);
}

std::shared_ptr<const SceneSnapshot> build_variant(const Scene &p_scene, const Camera3D &p_camera,
		Light3D &r_light, const LightVariant &p_variant, const PropertyValues &p_properties) {
	const LightStateGuard guard(r_light);
	const auto before = build_snapshot(p_scene, p_camera);
	if (p_variant.type != r_light.type) {
		change_type(r_light, get_light(*before, r_light.name), *before, p_variant.type);
	}
	if (p_variant.type == LightType::DIRECTIONAL) {
		const double distance_m = DISTANCE_IN_SCENE_SIZES * before->scene_size_m;
		r_light.properties["light_angular_distance"] =
				2.0 * glm::degrees(std::atan(p_variant.size_m / distance_m));
	} else {
		r_light.properties["light_size"] = p_variant.size_m;
	}
	for (const auto &[name, value] : p_properties) {
		r_light.properties[name] = value;
	}
	return build_snapshot(p_scene, p_camera);
}

bool is_light_disc_above_horizon(const LightSnapshot &p_light, const glm::vec3 &p_light_position,
		const glm::vec3 &p_position, const glm::vec3 &p_normal) {
	const bool is_directional = p_light.type == LightType::DIRECTIONAL;
	const glm::vec3 to_light = is_directional ? glm::vec3(-p_light.get_direction_world())
											  : p_light_position - p_position;
	// 1 for a directional light, whose get_disc_radius() is the tangent of its angular radius.
	const float distance = glm::length(to_light);
	if (!(distance > 0.0f)) {
		return false;
	}
	// The disc is perpendicular to to_light. Its lowest point is R * sine below its centre,
	// measured along the normal.
	const float cosine = glm::dot(to_light, p_normal) / distance;
	const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
	return cosine * distance >= p_light.get_disc_radius() * sine;
}

} // namespace gnomon
