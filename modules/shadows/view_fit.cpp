#include "modules/shadows/view_fit.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const double MIN_SCALE = 1.0 / 1024.0; // minimum factor by which a view is narrowed
const double STEPS_PER_HALF = 4.0; // steps per half extent to which the view's centre is snapped
// Maximum fraction of the view's half extent that the content may fill: rounding to a step takes
// an eighth of it, a filter's border the rest.
const double MAX_FILL = 0.75;

} // namespace

Bounds find_bounds_in_view(const LightView &p_view, const VisibleReceivers &p_receivers) {
	Bounds seen;
	for (const VisibleReceiver &receiver : p_receivers.list) {
		seen.add(transform_bounds(receiver.bounds_world, p_view.view_from_world));
	}
	return seen;
}

double compute_fit_reach_m(const LightView &p_view, const LightSnapshot &p_light,
		const SceneSnapshot &p_scene, const Bounds &p_receivers) {
	const double widest_m =
			std::max({ p_light.penumbra_outer_width_m, p_light.penumbra_inner_width_m, 0.0f });
	// A directional light's R is a tangent, and its penumbra widths correspond to R times S.
	const double tangent =
			std::max(double(p_light.get_disc_radius()), widest_m / p_scene.scene_size_m);
	const double depth_m = std::max(double(p_view.far_m), p_receivers.maximum.z) - p_view.near_m;
	return tangent * depth_m + widest_m + p_view.caster_margin_m + 1e-3 * p_scene.scene_size_m;
}

void fit_to_receivers(LightView &r_view, const Bounds &p_receivers, double p_reach_m) {
	if (!r_view.is_orthographic || p_receivers.is_empty()) {
		return;
	}
	const glm::dvec2 whole(r_view.half_extent);
	const glm::dvec2 low = glm::max(glm::dvec2(p_receivers.minimum) - p_reach_m, -whole);
	const glm::dvec2 high = glm::min(glm::dvec2(p_receivers.maximum) + p_reach_m, whole);
	const glm::dvec2 needed = 0.5 * (high - low);
	if (needed.x <= 0 || needed.y <= 0) {
		return; // no receiver is within p_reach_m of a caster
	}
	double scale = 1;
	while (scale > MIN_SCALE &&
			glm::all(glm::lessThanEqual(needed, 0.5 * scale * MAX_FILL * whole))) {
		scale *= 0.5;
	}
	if (scale < 1) {
		const glm::dvec2 step = scale * whole / STEPS_PER_HALF;
		const glm::dvec2 centre = glm::round(0.5 * (low + high) / step) * step;
		r_view.view_from_world[3] -= glm::dvec4(centre, 0.0, 0.0);
		r_view.half_extent = glm::vec2(scale * whole);
	}
}

} // namespace gnomon
