#include "modules/shadows/translucent_casters.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

/// Bounds of the volume that a caster darkens: a cone from the light's centre, or, for a
/// directional light, a cylinder along its direction, which may_overlap widens by the light's
/// angle.
struct ShadowBounds {
	/// The cone's axis, unit, away from the light. Directional: the caster's centre.
	glm::dvec3 axis_or_centre = glm::dvec3(0.0);
	double radius_m = 0; // of the caster's bounding sphere
	double cosine = 1;	 // of the cone's half angle
	double sine = 0;
	bool is_everywhere = false; // half angle of 90 degrees or more, or the light is inside
};

ShadowBounds compute_shadow_bounds(const LightSnapshot &p_light, const Bounds &p_bounds) {
	ShadowBounds shadow;
	const glm::dvec3 centre = 0.5 * (p_bounds.minimum + p_bounds.maximum);
	shadow.radius_m = 0.5 * p_bounds.get_diagonal();
	if (p_light.type == LightType::DIRECTIONAL) {
		shadow.axis_or_centre = centre;
		return shadow;
	}
	const double light_radius = p_light.get_disc_radius();
	const glm::dvec3 to_caster = centre - p_light.position_world;
	const double distance = glm::length(to_caster);
	shadow.is_everywhere = !(shadow.radius_m + light_radius < distance);
	if (!shadow.is_everywhere) {
		shadow.axis_or_centre = to_caster / distance;
		// The first angle bounds the directions of rays from the light's disc through the caster.
		// Seen from the light's centre, a point on such a ray behind the caster deviates from the
		// ray's direction by up to the second.
		const double half_rad = std::asin((shadow.radius_m + light_radius) / distance) +
				std::asin(std::min(1.0, light_radius / (distance - shadow.radius_m)));
		shadow.is_everywhere = half_rad >= 1.57; // pi / 2, rounded down
		shadow.cosine = std::cos(half_rad);
		shadow.sine = std::sin(half_rad);
	}
	return shadow;
}

/// False only when it is certain that no light ray hits both.
bool may_overlap(
		const LightSnapshot &p_light, const ShadowBounds &p_left, const ShadowBounds &p_right) {
	if (p_left.is_everywhere || p_right.is_everywhere) {
		return true;
	}
	if (p_light.type == LightType::DIRECTIONAL) {
		const glm::dvec3 to_left = p_left.axis_or_centre - p_right.axis_or_centre;
		const double along = glm::dot(to_left, p_light.get_direction_world());
		const double across_squared = std::max(glm::dot(to_left, to_left) - along * along, 0.0);
		// Between the two, rays deviate by at most half the light's angle.
		const double radii_m = p_left.radius_m + p_right.radius_m;
		const double reach_m = radii_m + p_light.get_disc_radius() * (std::abs(along) + radii_m);
		return across_squared <= reach_m * reach_m;
	}
	// They overlap when the angle between their axes is at most the sum of their half angles, which
	// is below pi: cos(a + b) = cos a cos b - sin a sin b.
	return glm::dot(p_left.axis_or_centre, p_right.axis_or_centre) >=
			p_left.cosine * p_right.cosine - p_left.sine * p_right.sine;
}

} // namespace

TranslucentCasters find_translucent_casters(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light) {
	TranslucentCasters casters;
	std::vector<std::vector<ShadowBounds>> group_shadows; // of each group's casters
	for (uint32_t index = 0; index < p_scene.instances.size(); ++index) {
		const InstanceSnapshot &instance = p_scene.instances[index];
		const glm::vec3 transmittance = instance.compute_transmittance();
		if (!instance.casts_shadow || transmittance == glm::vec3(0.0f)) {
			continue;
		}
		casters.is_translucent.resize(p_scene.instances.size());
		casters.is_translucent[index] = 1;
		if (transmittance == glm::vec3(1.0f) || instance.bounds_world.is_empty()) {
			continue;
		}
		const ShadowBounds shadow = compute_shadow_bounds(p_light, instance.bounds_world);
		size_t chosen = casters.groups.size();
		for (size_t group = 0; group < casters.groups.size() && chosen == casters.groups.size();
				++group) {
			if (casters.groups[group].transmittance == transmittance &&
					std::none_of(group_shadows[group].begin(), group_shadows[group].end(),
							[&](const ShadowBounds &p_other) {
								return may_overlap(p_light, shadow, p_other);
							})) {
				chosen = group;
			}
		}
		if (chosen == TranslucentCasters::MAX_GROUP_COUNT) {
			const auto nearest = std::min_element(casters.groups.begin(), casters.groups.end(),
					[&](const TranslucentGroup &p_left, const TranslucentGroup &p_right) {
						return glm::distance(p_left.transmittance, transmittance) <
								glm::distance(p_right.transmittance, transmittance);
					});
			chosen = static_cast<size_t>(nearest - casters.groups.begin());
			++casters.merged_count;
		} else if (chosen == casters.groups.size()) {
			casters.groups.push_back({ {}, transmittance });
			group_shadows.emplace_back();
		}
		casters.groups[chosen].instances.push_back(index);
		group_shadows[chosen].push_back(shadow);
	}
	return casters;
}

CasterFlags find_opaque_casters(const SceneSnapshot &p_scene, const TranslucentCasters &p_casters,
		const TranslucentGroup *p_group) {
	CasterFlags casts(p_scene.instances.size());
	for (size_t index = 0; index < casts.size(); ++index) {
		const bool is_translucent = !p_casters.is_empty() && p_casters.is_translucent[index] != 0;
		casts[index] = p_scene.instances[index].casts_shadow && !is_translucent ? 1 : 0;
	}
	if (p_group != nullptr) {
		for (const uint32_t index : p_group->instances) {
			casts[index] = 1;
		}
	}
	return casts;
}

} // namespace gnomon
