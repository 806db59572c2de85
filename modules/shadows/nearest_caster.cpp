#include "modules/shadows/nearest_caster.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

/// Lower bound of the distance along the view to the part of the box that the view sees, metres.
double compute_nearest_distance_m(
		const LightView &p_view, const LightSnapshot &p_light, const InstanceSnapshot &p_instance) {
	const double along_m = p_view.compute_distance_range_m(p_instance).x;
	if (p_view.is_orthographic) {
		return along_m;
	}
	// A box that reaches behind the light may still be far from it inside the view: a point at
	// distance straight_m between the view's sides has at least straight_m / corner along the view.
	const double straight_m = p_instance.bounds_world.compute_distance(p_light.position_world);
	const double corner = std::sqrt(
			1.0 + glm::dot(glm::dvec2(p_view.half_extent), glm::dvec2(p_view.half_extent)));
	return std::max(along_m, straight_m / corner);
}

} // namespace

float compute_nearest_w(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index) {
	const LightView &view = p_inputs.views[p_view_index];
	double nearest_w = 0;
	for (uint32_t caster : p_inputs.casters[p_view_index].instances) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[caster];
		if (!view.may_see(instance)) {
			continue; // listed only because Inputs::may_skip is false
		}
		const double distance_m = std::max(
				double(view.near_m), compute_nearest_distance_m(view, p_inputs.light, instance));
		nearest_w = std::max(
				nearest_w, view.is_orthographic ? view.far_m - distance_m : 1.0 / distance_m);
	}
	return static_cast<float>(nearest_w);
}

float compute_nearest_w(const ShadowTechnique::Inputs &p_inputs) {
	float nearest_w = 0;
	for (uint32_t view = 0; view < p_inputs.views.size(); ++view) {
		nearest_w = std::max(nearest_w, compute_nearest_w(p_inputs, view));
	}
	return nearest_w;
}

glm::vec2 compute_debug_depth_range(const ShadowTechnique::Inputs &p_inputs) {
	double farthest_m = 0;
	for (size_t index = 0; index < p_inputs.views.size(); ++index) {
		if (p_inputs.views[index].is_orthographic) {
			return glm::vec2(0.0f, 1.0f);
		}
		for (uint32_t caster : p_inputs.casters[index].instances) {
			const InstanceSnapshot &instance = p_inputs.scene.instances[caster];
			farthest_m = std::max(
					farthest_m, p_inputs.views[index].compute_distance_range_m(instance).y);
		}
	}
	if (farthest_m <= 0) {
		return glm::vec2(0.0f, 1.0f); // all maps are empty
	}
	// Stored depth is near / distance: white is a third of the farthest caster's distance.
	return static_cast<float>(p_inputs.views[0].near_m / farthest_m) * glm::vec2(1.0f, 3.0f);
}

} // namespace gnomon
