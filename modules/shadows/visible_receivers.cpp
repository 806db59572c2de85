#include "modules/shadows/visible_receivers.h"

#include "modules/shadows/camera_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace gnomon {

namespace {

// ROUNDING bounds the error of float32 positions (about 1e-7 relative) as a fraction of the lengths
// that they are computed from: the distances of the instance's origin and bounds from the camera,
// plus the bounds' diagonal. It also widens the light's range (relative) and cone (rad). Receivers
// are moved off their surfaces by at most MAX_RECEIVER_OFFSET; twice that is allowed for.
constexpr double ROUNDING = 1e-5;
constexpr double OFFSET_PER_SCENE_SIZE = 2 * MAX_RECEIVER_OFFSET;
// The shader compares cosines in float32 (rounding error 6e-8). Near a cosine of 1 this margin is
// an angle of 1.4e-3 rad.
constexpr double COSINE_MARGIN = 1e-6;

using Polygon = std::vector<glm::dvec3>;

/// The part of a convex polygon on the plane's inner side.
Polygon clip(const Polygon &p_polygon, const ViewPlane &p_plane) {
	Polygon clipped;
	for (size_t index = 0; index < p_polygon.size(); ++index) {
		const glm::dvec3 &from = p_polygon[index];
		const glm::dvec3 &to = p_polygon[(index + 1) % p_polygon.size()];
		const double from_side = p_plane.compute_side(from);
		const double to_side = p_plane.compute_side(to);
		if (from_side >= 0) {
			clipped.push_back(from);
		}
		if ((from_side >= 0) != (to_side >= 0)) {
			clipped.push_back(glm::mix(from, to, from_side / (from_side - to_side)));
		}
	}
	return clipped;
}

/// Clips the ray to the box and adds both ends of the clipped segment.
void add_ray(const Bounds &p_box, const glm::dvec3 &p_origin, const glm::dvec3 &p_direction,
		Bounds &r_bounds) {
	double first = 0;
	double last = std::numeric_limits<double>::infinity();
	for (int axis = 0; axis < 3; ++axis) {
		if (p_direction[axis] == 0) {
			if (p_origin[axis] < p_box.minimum[axis] || p_origin[axis] > p_box.maximum[axis]) {
				return;
			}
			continue;
		}
		const double a = (p_box.minimum[axis] - p_origin[axis]) / p_direction[axis];
		const double b = (p_box.maximum[axis] - p_origin[axis]) / p_direction[axis];
		first = std::max(first, std::min(a, b));
		last = std::min(last, std::max(a, b));
	}
	if (first <= last && std::isfinite(last)) {
		r_bounds.add(p_origin + first * p_direction);
		r_bounds.add(p_origin + last * p_direction);
	}
}

/// Bounds of the intersection of the box and the camera's view: of the box's faces, clipped by the
/// view's planes, and of the view's edges inside the box. Empty when they do not intersect.
Bounds compute_visible_bounds(const Bounds &p_box, const LightView &p_view,
		const ViewPlanes &p_planes, const CameraSnapshot &p_camera) {
	bool is_inside = true;
	for (int index = 0; index < 8 && is_inside; ++index) {
		is_inside = std::all_of(p_planes.begin(), p_planes.end(), [&](const ViewPlane &p_plane) {
			return p_plane.compute_side(p_box.get_corner(index)) >= 0;
		});
	}
	if (is_inside) {
		return p_box;
	}
	Bounds bounds;
	for (int axis = 0; axis < 3; ++axis) {
		// Bits of a corner's index, see Bounds::get_corner.
		const int u = 1 << (axis + 1) % 3;
		const int v = 1 << (axis + 2) % 3;
		for (const int side : { 0, 1 << axis }) {
			Polygon face = { p_box.get_corner(side), p_box.get_corner(side | u),
				p_box.get_corner(side | u | v), p_box.get_corner(side | v) };
			for (const ViewPlane &plane : p_planes) {
				face = clip(face, plane);
			}
			for (const glm::dvec3 &point : face) {
				bounds.add(point);
			}
		}
	}
	const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(p_view.view_from_world));
	for (const glm::dvec2 side :
			{ glm::dvec2(-1, -1), glm::dvec2(-1, 1), glm::dvec2(1, -1), glm::dvec2(1, 1) }) {
		const glm::dvec2 tangents = side * glm::dvec2(p_view.half_extent);
		add_ray(p_box, p_camera.position_world, world_from_view * glm::dvec3(tangents, 1.0),
				bounds);
	}
	return bounds;
}

/// Margin for rounding of the instance's positions and for the receivers' offset, metres.
double compute_margin_m(const SceneSnapshot &p_scene, const InstanceSnapshot &p_instance) {
	const glm::dvec3 &camera = p_scene.camera.position_world;
	double distance_m = glm::distance(glm::dvec3(p_instance.world_from_node[3]), camera);
	distance_m += glm::distance(p_instance.bounds_world.minimum, camera);
	distance_m += p_instance.bounds_world.get_diagonal();
	return ROUNDING * distance_m + OFFSET_PER_SCENE_SIZE * p_scene.scene_size_m;
}

/// See VisibleReceiver::bounds_world. Empty when the camera does not see the instance.
std::optional<Bounds> find_visible_part(const SceneSnapshot &p_scene,
		const InstanceSnapshot &p_instance, const LightView &p_camera_view,
		const ViewPlanes &p_planes) {
	if (!p_camera_view.may_see(p_instance.bounds_world)) {
		return {}; // the G-buffer does not draw it either
	}
	const double margin_m = compute_margin_m(p_scene, p_instance);
	Bounds box = p_instance.bounds_world;
	box.minimum -= margin_m;
	box.maximum += margin_m;
	Bounds bounds = compute_visible_bounds(box, p_camera_view, p_planes, p_scene.camera);
	if (bounds.is_empty()) {
		return {};
	}
	bounds.minimum -= margin_m;
	bounds.maximum += margin_m;
	return bounds;
}

/// True when the bounding sphere is certainly outside the cone.
bool is_outside_cone(const LightSnapshot &p_light, const glm::dvec3 &p_centre, double p_radius_m) {
	const glm::dvec3 to_centre = p_centre - p_light.position_world;
	const double distance_m = glm::length(to_centre);
	if (!(distance_m > p_radius_m)) {
		return false;
	}
	const double cosine = glm::dot(to_centre, p_light.get_direction_world()) / distance_m;
	const double angle_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
	const double cone_rad = std::acos(
			std::clamp(std::cos(double(p_light.outer_cone_rad)) - COSINE_MARGIN, -1.0, 1.0));
	return angle_rad - std::asin(p_radius_m / distance_m) > cone_rad + ROUNDING;
}

} // namespace

ViewPlanes find_view_planes(const LightView &p_view) {
	const glm::dmat4 rows = glm::transpose(p_view.view_from_world);
	const glm::dvec4 z = rows[2];
	const glm::dvec2 extent(p_view.half_extent);
	const std::array<glm::dvec4, 5> sides = { z * extent.x - rows[0], z * extent.x + rows[0],
		z * extent.y - rows[1], z * extent.y + rows[1], z };
	ViewPlanes planes;
	for (size_t index = 0; index < sides.size(); ++index) {
		planes[index] = { glm::dvec3(sides[index]), sides[index].w };
	}
	return planes;
}

VisibleReceivers find_visible_receivers(
		const SceneSnapshot &p_scene, const LightView &p_camera_view) {
	std::vector<uint32_t> all_pages(p_scene.instances.get_page_count());
	std::iota(all_pages.begin(), all_pages.end(), 0u);
	return find_visible_receivers(p_scene, p_camera_view, /*p_before=*/{}, all_pages);
}

VisibleReceivers find_visible_receivers(const SceneSnapshot &p_scene,
		const LightView &p_camera_view, const VisibleReceivers &p_before,
		std::span<const uint32_t> p_changed_pages) {
	const size_t PAGE_SIZE = SharedVector<InstanceSnapshot>::PAGE_SIZE;
	const ViewPlanes planes = find_view_planes(p_camera_view);
	VisibleReceivers receivers;
	receivers.list.reserve(p_before.list.size());
	auto before = p_before.list.begin();
	const auto add_before = [&](size_t p_end, bool p_is_changed) {
		for (; before != p_before.list.end() && before->instance_index < p_end; ++before) {
			if (!p_is_changed) {
				receivers.add(*before);
			}
		}
	};
	for (const uint32_t page : p_changed_pages) {
		size_t index = page * PAGE_SIZE;
		add_before(index, /*p_is_changed=*/false);
		for (const InstanceSnapshot &instance : p_scene.instances.get_page(page)) {
			const std::optional<Bounds> bounds =
					find_visible_part(p_scene, instance, p_camera_view, planes);
			if (bounds) {
				receivers.add({ static_cast<uint32_t>(index), *bounds });
			}
			++index;
		}
		add_before(index, /*p_is_changed=*/true);
	}
	add_before(p_scene.instances.size(), /*p_is_changed=*/false);
	return receivers;
}

bool may_light_reach(const LightSnapshot &p_light, const Bounds &p_bounds_world) {
	if (p_light.type == LightType::DIRECTIONAL) {
		return true;
	}
	const glm::dvec3 &light = p_light.position_world;
	const double distance_m = p_bounds_world.compute_distance(light);
	if (p_light.range_m > 0 && distance_m > p_light.range_m * (1 + ROUNDING)) {
		return false;
	}
	if (p_light.type != LightType::SPOT) {
		return true;
	}
	const glm::dvec3 centre = 0.5 * (p_bounds_world.minimum + p_bounds_world.maximum);
	const double radius_m = 0.5 * p_bounds_world.get_diagonal();
	if (is_outside_cone(p_light, centre, radius_m)) {
		return false;
	}
	// The bounding sphere of a large flat box is far larger than the box, so the box itself is also
	// tested, against the four planes of the pyramid around the cone.
	LightView cone;
	const double cone_rad = double(p_light.outer_cone_rad) + std::sqrt(2 * COSINE_MARGIN);
	if (cone_rad >= 1.5) {
		return true; // the pyramid would be nearly a half-space and reject little
	}
	const glm::dmat3 &axes = p_light.world_from_light;
	const glm::dmat3 rotation = glm::transpose(glm::dmat3(axes[0], -axes[1], -axes[2]));
	cone.view_from_world = glm::dmat4(rotation);
	cone.view_from_world[3] = glm::dvec4(-(rotation * light), 1.0);
	cone.half_extent = glm::vec2(static_cast<float>(std::tan(cone_rad) * (1 + ROUNDING)));
	return cone.may_see(p_bounds_world);
}

VisibleReceivers find_lit_receivers(
		const LightSnapshot &p_light, const VisibleReceivers &p_receivers) {
	VisibleReceivers lit;
	if (p_receivers.list.empty() || !may_light_reach(p_light, p_receivers.bounds_world)) {
		return lit; // in a scene with many lights, most end here
	}
	for (const VisibleReceiver &receiver : p_receivers.list) {
		if (may_light_reach(p_light, receiver.bounds_world)) {
			lit.add(receiver);
		}
	}
	return lit;
}

bool may_view_contain_any(const LightView &p_view, const VisibleReceivers &p_receivers) {
	return p_view.may_see(p_receivers.bounds_world) &&
			std::any_of(p_receivers.list.begin(), p_receivers.list.end(),
					[&](const VisibleReceiver &p_receiver) {
						return p_view.may_see(p_receiver.bounds_world);
					});
}

} // namespace gnomon
