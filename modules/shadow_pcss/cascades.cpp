#include "modules/shadow_pcss/cascades.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

constexpr double UNIFORM_SHARE = 0.25; // of the splits; the rest is logarithmic
constexpr double WIDEST_ASPECT = 16.0 / 9.0;
// The nearest split is this fraction of the farthest distance, or the camera's near plane.
constexpr double MIN_NEAR_SHARE = 1e-4;

/// Distance in metres from the camera to the farthest corner of the casters' bounds, rounded up to
/// a power of two, so that cascades do not change their size while the camera moves.
double find_farthest_m(const LightScene &p_scene) {
	double farthest_m = 0;
	for (int corner = 0; corner < 8 && !p_scene.caster_bounds_world.is_empty(); ++corner) {
		farthest_m = std::max(farthest_m,
				glm::distance(p_scene.caster_bounds_world.get_corner(corner),
						p_scene.scene.camera.position_world));
	}
	return std::exp2(std::ceil(std::log2(std::max(farthest_m, 1e-9))));
}

/// The sphere around the camera's frustum up to a distance.
struct FrustumSphere {
	double center_m = 0; // from the camera, along its view
	double radius_m = 0;
};

FrustumSphere find_frustum_sphere(const CameraSnapshot &p_camera, double p_distance_m) {
	const double tangent = std::tan(0.5 * double(p_camera.vertical_fov_rad)) *
			std::sqrt(1 + WIDEST_ASPECT * WIDEST_ASPECT); // of the corners
	if (tangent >= 1) {
		return { p_distance_m, p_distance_m * tangent };
	}
	const double radius_m = 0.5 * p_distance_m * (1 + tangent * tangent);
	return { radius_m, radius_m };
}

} // namespace

bool is_finer(const LightView &p_view, const LightView &p_other) {
	const auto find_extent = [](const LightView &p_any) {
		return std::max(p_any.half_extent.x, p_any.half_extent.y);
	};
	return find_extent(p_view) < find_extent(p_other);
}

std::vector<LightView> split_into_cascades(const LightView &p_whole, const LightScene &p_scene,
		uint32_t p_count, uint32_t p_border_px) {
	const CameraSnapshot &camera = p_scene.scene.camera;
	const double farthest_m = find_farthest_m(p_scene);
	const double nearest_m = std::max(double(camera.near_m), MIN_NEAR_SHARE * farthest_m);
	const glm::dvec3 forward = -camera.world_from_camera[2];
	std::vector<LightView> views;
	for (uint32_t index = 1; index < p_count; ++index) {
		const double share = double(index) / p_count;
		const double distance_m = std::lerp(nearest_m * std::pow(farthest_m / nearest_m, share),
				std::lerp(nearest_m, farthest_m, share), UNIFORM_SHARE);
		const FrustumSphere sphere = find_frustum_sphere(camera, distance_m);
		const double size_px = double(p_whole.size_px.x);
		const double half_m = sphere.radius_m * size_px / (size_px - 2.0 * p_border_px);
		LightView view = p_whole;
		view.half_extent = glm::vec2(float(half_m));
		if (!is_finer(view, p_whole)) {
			break;
		}
		// In multiples of a texel from the world's origin, which does not move with the casters.
		const double texel_m = 2 * half_m / size_px;
		const glm::dvec4 center(camera.position_world + sphere.center_m * forward, 0.0);
		const glm::dvec2 snapped =
				glm::round(glm::dvec2(p_whole.view_from_world * center) / texel_m) * texel_m;
		view.view_from_world[3].x = -snapped.x;
		view.view_from_world[3].y = -snapped.y;
		views.push_back(view);
	}
	views.push_back(p_whole);
	return views;
}

} // namespace gnomon
