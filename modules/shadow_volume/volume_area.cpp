#include "modules/shadow_volume/volume_area.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gnomon {

namespace {

const size_t CORNER_COUNT = 8;
const double MARGIN_PX = 2.0; // rounding of the rasteriser, and CameraSnapshot::shift: one each
// Against rounding, may_shade_near_plane grows boxes by these fractions of the near distance and of
// their diagonal; and by a pixel at the near distance, for CameraSnapshot::shift.
const double MARGIN_PER_NEAR = 1e-3;
const double MARGIN_PER_BOX = 1e-5;

using Corners = std::array<glm::dvec3, CORNER_COUNT>;

Corners compute_corners_view(const Bounds &p_box_world, const LightView &p_camera) {
	Corners corners;
	for (size_t i = 0; i < CORNER_COUNT; ++i) {
		const glm::dvec3 corner_world((i & 1) != 0 ? p_box_world.maximum.x : p_box_world.minimum.x,
				(i & 2) != 0 ? p_box_world.maximum.y : p_box_world.minimum.y,
				(i & 4) != 0 ? p_box_world.maximum.z : p_box_world.minimum.z);
		corners[i] = glm::dvec3(p_camera.view_from_world * glm::dvec4(corner_world, 1.0));
	}
	return corners;
}

/// The light in camera view space: xyz / w is its centre; w = 0: xyz is the direction towards it.
glm::dvec4 compute_light_view(const LightSnapshot &p_light, const LightView &p_camera) {
	return p_camera.view_from_world *
			(p_light.type == LightType::DIRECTIONAL
							? glm::dvec4(-p_light.get_direction_world(), 0.0)
							: glm::dvec4(p_light.position_world, 1.0));
}

/// Accumulates the bounds of projected points.
struct Projection {
	const LightView &camera;
	glm::dvec2 minimum = glm::dvec2(1e300);
	glm::dvec2 maximum = glm::dvec2(-1e300);
	double min_depth = 1.0;
	double max_depth = 0.0;

	/// Adds a point in homogeneous view space, with z >= near w and w >= 0.
	void add(const glm::dvec4 &p_point) {
		for (int axis = 0; axis < 2; ++axis) {
			const double limit = p_point.z * camera.half_extent[axis];
			// 1e6: far outside the image. Avoids a division by 0 at limit = 0.
			const double ndc = std::abs(p_point[axis]) < 1e6 * limit ? p_point[axis] / limit
					: p_point[axis] < 0								 ? -1e6
																	 : 1e6;
			minimum[axis] = std::min(minimum[axis], ndc);
			maximum[axis] = std::max(maximum[axis], ndc);
		}
		const double depth = p_point.z > 0 ? camera.near_m * p_point.w / p_point.z : 1.0;
		min_depth = std::min(min_depth, depth);
		max_depth = std::max(max_depth, depth);
	}
};

VolumeArea make_area(const Projection &p_projection, glm::uvec2 p_size_px) {
	VolumeArea area;
	const glm::dvec2 size(p_size_px);
	const glm::dvec2 begin = glm::clamp(
			glm::floor((p_projection.minimum * 0.5 + 0.5) * size - MARGIN_PX), glm::dvec2(0), size);
	const glm::dvec2 end = glm::clamp(
			glm::ceil((p_projection.maximum * 0.5 + 0.5) * size + MARGIN_PX), glm::dvec2(0), size);
	if (end.x <= begin.x || end.y <= begin.y) {
		return area;
	}
	area.offset_px = glm::uvec2(begin);
	area.size_px = glm::uvec2(end - begin);
	const double tolerance = 1e-5; // relative error of the stored float and its interpolation
	area.min_depth = static_cast<float>(p_projection.min_depth * (1 - tolerance));
	area.max_depth = static_cast<float>(std::min(p_projection.max_depth * (1 + tolerance), 1.0));
	return area;
}

/// Returns the factor by which the distance of each of the box's corners from the light is
/// multiplied to get the end of its extrusion, which is at or beyond the light's range. 1 or more;
/// infinity without a range, or for a light very near to the box. p_light is not directional.
double compute_extrusion_factor(const Bounds &p_box_world, const LightSnapshot &p_light) {
	const double nearest_m = p_box_world.compute_distance(p_light.position_world);
	return p_light.range_m > 0 && nearest_m > 1e-3 * p_box_world.get_diagonal()
			? std::max(p_light.range_m / nearest_m, 1.0)
			: INFINITY;
}

bool are_all_behind(const Corners &p_corners, const glm::dvec3 &p_normal, double p_offset) {
	return std::all_of(p_corners.begin(), p_corners.end(), [&](const glm::dvec3 &p_corner) {
		return glm::dot(p_normal, p_corner) + p_offset < 0;
	});
}

} // namespace

VolumeArea compute_volume_area(const Bounds &p_box_world, const LightSnapshot &p_light,
		const LightView &p_camera, glm::uvec2 p_size_px) {
	VolumeArea whole;
	whole.size_px = p_size_px;
	const glm::dvec4 light = compute_light_view(p_light, p_camera);
	const bool is_point = light.w != 0;
	if (is_point && p_box_world.compute_distance(p_light.position_world) <= 0) {
		return whole;
	}
	const double extrusion_factor =
			is_point ? compute_extrusion_factor(p_box_world, p_light) : INFINITY;
	std::array<glm::dvec4, 2 * CORNER_COUNT> points;
	const Corners corners = compute_corners_view(p_box_world, p_camera);
	for (size_t i = 0; i < CORNER_COUNT; ++i) {
		const glm::dvec3 ray = corners[i] * light.w - glm::dvec3(light);
		points[i] = glm::dvec4(corners[i], 1.0);
		points[CORNER_COUNT + i] = std::isinf(extrusion_factor)
				? glm::dvec4(ray, 0.0)
				: glm::dvec4(glm::dvec3(light) + ray * extrusion_factor, 1.0);
	}
	Projection projection{ p_camera };
	// Distance beyond the near plane of a point in homogeneous view space, times its w; negative
	// on the camera's side of the plane.
	const auto get_height = [&](const glm::dvec4 &p_point) {
		return p_point.z - p_camera.near_m * p_point.w;
	};
	for (size_t i = 0; i < points.size(); ++i) {
		const double height = get_height(points[i]);
		if (height >= 0) {
			projection.add(points[i]);
		}
		for (size_t j = 0; j < i; ++j) { // all pairs of points: includes the hull's edges
			const double other = get_height(points[j]);
			if ((height < 0) != (other < 0)) {
				const double fraction = height / (height - other);
				projection.add(points[i] + (points[j] - points[i]) * fraction);
			}
		}
	}
	return projection.maximum.x < projection.minimum.x ? VolumeArea()
													   : make_area(projection, p_size_px);
}

bool may_shade_near_plane(
		const Bounds &p_box_world, const LightSnapshot &p_light, const LightView &p_camera) {
	const glm::dvec4 light = compute_light_view(p_light, p_camera);
	Bounds box = p_box_world;
	const double near_m = p_camera.near_m;
	const double pixel_m = 2.0 * near_m * p_camera.half_extent.y / p_camera.size_px.y;
	const double margin_m =
			MARGIN_PER_NEAR * near_m + pixel_m + MARGIN_PER_BOX * p_box_world.get_diagonal();
	box.minimum -= margin_m;
	box.maximum += margin_m;
	const Corners corners = compute_corners_view(box, p_camera);
	const glm::dvec2 half = glm::dvec2(p_camera.half_extent) * near_m;
	const std::array<glm::dvec3, 4> rectangle = { glm::dvec3(-half.x, -half.y, near_m),
		glm::dvec3(half.x, -half.y, near_m), glm::dvec3(half.x, half.y, near_m),
		glm::dvec3(-half.x, half.y, near_m) };
	const glm::dvec3 centre(0, 0, near_m);
	// The near plane: the box does not matter when it is on the side without the light.
	const double light_height = light.z - near_m * light.w;
	if (light_height != 0) {
		const double side = light_height > 0 ? 1.0 : -1.0;
		if (are_all_behind(corners, { 0, 0, side }, -side * near_m)) {
			return false;
		}
	}
	// Planes through the light and a side of the rectangle.
	for (size_t i = 0; i < rectangle.size(); ++i) {
		const glm::dvec3 &corner = rectangle[i];
		const glm::dvec3 along = rectangle[(i + 1) % rectangle.size()] - corner;
		glm::dvec3 normal = glm::cross(along, glm::dvec3(light) - corner * light.w);
		const double inside = glm::dot(normal, centre - corner);
		if (std::abs(inside) <= 1e-9 * glm::length(normal) * near_m) {
			continue; // the light is in the near plane: the plane has no inner side
		}
		normal *= inside > 0 ? 1.0 : -1.0;
		if (are_all_behind(corners, normal, -glm::dot(normal, corner))) {
			return false;
		}
	}
	// Axis-aligned bounds of the light and the rectangle: the space between cannot exceed them.
	if (light.w != 0) {
		for (int axis = 0; axis < 3; ++axis) {
			double lower = light[axis];
			double upper = light[axis];
			for (const glm::dvec3 &corner : rectangle) {
				lower = std::min(lower, corner[axis]);
				upper = std::max(upper, corner[axis]);
			}
			glm::dvec3 direction(0.0);
			direction[axis] = 1.0;
			if (are_all_behind(corners, direction, -lower) ||
					are_all_behind(corners, -direction, upper)) {
				return false;
			}
		}
	}
	return true;
}

} // namespace gnomon
