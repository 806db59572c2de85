#include "modules/renderer/light_limits.h"

#include "modules/core/files.h"
#include "modules/core/text.h"
#include "modules/mesh_tools/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon {

namespace {

const char *const WHERE_TO_READ = "; doc/stability.md tells the limits of each technique.";

uint64_t compute_asked_hash(const SceneSnapshot &p_scene, const LightSnapshot &p_light,
		const std::string &p_technique_id, const ShadowLimits &p_limits) {
	uint64_t hash = compute_text_hash(p_technique_id, 1);
	hash = compute_value_hash(p_light.type, hash);
	hash = compute_value_hash(p_light.position_world, hash);
	hash = compute_value_hash(p_light.get_disc_radius(), hash);
	hash = compute_value_hash(p_light.penumbra_outer_width_m, hash);
	hash = compute_value_hash(p_light.penumbra_inner_width_m, hash);
	hash = compute_value_hash(p_limits.least_caster_distance_radii, hash);
	hash = compute_value_hash(p_limits.most_width_sizes, hash);
	hash = compute_value_hash(p_scene.scene_size_m, hash);
	for (const InstanceSnapshot &instance : p_scene.instances) {
		if (instance.casts_shadow) {
			hash = compute_value_hash(instance.mesh->id, hash);
			hash = compute_value_hash(instance.world_from_node, hash);
		}
	}
	return hash;
}

double compute_box_distance_m(const Bounds &p_bounds, const glm::dvec3 &p_point) {
	return glm::distance(p_point, glm::clamp(p_point, p_bounds.minimum, p_bounds.maximum));
}

/// The caster that comes nearer to the light's centre than that; null: none does.
const InstanceSnapshot *find_near_caster(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light, double p_distance_m) {
	for (const InstanceSnapshot &instance : p_scene.instances) {
		if (instance.casts_shadow && !instance.bounds_world.is_empty() &&
				compute_box_distance_m(instance.bounds_world, p_light.position_world) <
						p_distance_m &&
				has_triangle_within(*instance.mesh, instance.world_from_node,
						p_light.position_world, p_distance_m)) {
			return &instance;
		}
	}
	return nullptr;
}

} // namespace

const std::vector<BrokenLimit> &LightLimits::find_broken(const SceneSnapshot &p_scene,
		const LightSnapshot &p_light, const std::string &p_technique_id,
		const ShadowLimits &p_limits) {
	const uint64_t hash = compute_asked_hash(p_scene, p_light, p_technique_id, p_limits);
	if (hash == asked_hash) {
		return broken;
	}
	asked_hash = hash;
	broken.clear();
	const std::string light = text("Light \"", p_light.name, "\": ");
	const std::string key = p_light.name + "/" + p_technique_id;
	if (p_light.type != LightType::DIRECTIONAL && p_light.light_size_m > 0) {
		const double radii = p_limits.least_caster_distance_radii;
		if (const InstanceSnapshot *caster =
						find_near_caster(p_scene, p_light, radii * p_light.light_size_m)) {
			broken.push_back({ key + "/near_caster",
					text(light, "caster \"", caster->mesh->name,
							"\" comes nearer to its centre than ", radii,
							" x light_size = ", radii * p_light.light_size_m,
							" m, where the shadow of ", p_technique_id,
							" is wrong. Lower light_size, move the light or the caster, or set "
							"another shadow_technique",
							WHERE_TO_READ) });
		}
	}
	const double width_m = std::max(p_light.penumbra_outer_width_m, p_light.penumbra_inner_width_m);
	const double most_m = p_limits.most_width_sizes * p_scene.scene_size_m;
	if (width_m > most_m) {
		broken.push_back({ key + "/widths",
				text(light, "penumbra_outer_width is ", p_light.penumbra_outer_width_m,
						" m and penumbra_inner_width ", p_light.penumbra_inner_width_m, " m, and ",
						p_technique_id, " is wrong above ", most_m, " m (",
						p_limits.most_width_sizes,
						" of the scene's size). Lower them, or set another shadow_technique",
						WHERE_TO_READ) });
	}
	return broken;
}

} // namespace gnomon
