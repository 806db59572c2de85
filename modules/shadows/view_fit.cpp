#include "modules/shadows/view_fit.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const double LEAST_PART = 1.0 / 1024.0;
const double STEPS_PER_HALF = 4.0; // steps per half extent to which the view's centre is snapped
// Maximum fraction of the view's half extent that the content may fill: rounding to a step takes
// an eighth of it, a filter's border the rest.
const double MOST_FILLED = 0.75;

} // namespace

double compute_fit_reach_m(
		const LightView &p_view, const LightSnapshot &p_light, const SceneSnapshot &p_scene) {
	const double widest_m =
			std::max({ p_light.penumbra_outer_width_m, p_light.penumbra_inner_width_m, 0.0f });
	const double tangent =
			std::max(double(p_light.get_disc_radius()), widest_m / p_scene.scene_size_m);
	const double depth_m = double(p_view.far_m) - p_view.near_m;
	return tangent * depth_m + widest_m + p_view.caster_margin_m + 1e-3 * p_scene.scene_size_m;
}

void fit_to_receivers(LightView &r_view, const VisibleReceivers &p_receivers, double p_reach_m) {
	if (!r_view.is_orthographic || p_receivers.list.empty()) {
		return;
	}
	Bounds seen;
	for (const VisibleReceiver &receiver : p_receivers.list) {
		seen.add(transform_bounds(receiver.bounds_world, r_view.view_from_world));
	}
	const glm::dvec2 whole(r_view.half_extent);
	const glm::dvec2 least = glm::max(glm::dvec2(seen.minimum) - p_reach_m, -whole);
	const glm::dvec2 greatest = glm::min(glm::dvec2(seen.maximum) + p_reach_m, whole);
	const glm::dvec2 needed = 0.5 * (greatest - least);
	if (needed.x <= 0 || needed.y <= 0) {
		return; // outside all casters
	}
	double part = 1;
	while (part > LEAST_PART &&
			glm::all(glm::lessThanEqual(needed, 0.5 * part * MOST_FILLED * whole))) {
		part *= 0.5;
	}
	if (part < 1) {
		const glm::dvec2 step = part * whole / STEPS_PER_HALF;
		const glm::dvec2 centre = glm::round(0.5 * (least + greatest) / step) * step;
		r_view.view_from_world[3] -= glm::dvec4(centre, 0.0, 0.0);
		r_view.half_extent = glm::vec2(part * whole);
	}
}

} // namespace gnomon
