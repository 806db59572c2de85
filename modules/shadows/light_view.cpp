#include "modules/shadows/light_view.h"

#include "modules/core/error.h"

#include <glm/gtc/matrix_inverse.hpp>

#include <cmath>

namespace gnomon {

namespace {

// Beyond this cone half angle one perspective map distributes its texels badly: at 60 degrees from
// the axis a texel covers a quarter of the angle that one in the centre covers. Six views of 90
// degrees are better.
constexpr float MAX_SINGLE_VIEW_RAD = 1.0471975512f;
// Near plane as a fraction of S. It is this near because casters nearer than that are clamped to
// it or clipped there. Reversed float depth has enough precision: no error grows from far : near =
// 10 to 1e7 (doc/stability.md).
constexpr double NEAR_PER_SCENE_SIZE = 1e-8;
// Keeps the view's extent finite for a cone of zero degrees.
constexpr float MIN_TANGENT = 1e-4f;

/// Matrix from world to view space. The rows of its rotation are right, down and forward.
glm::dmat4 make_view(const glm::dvec3 &p_right, const glm::dvec3 &p_down,
		const glm::dvec3 &p_forward, const glm::dvec3 &p_origin_world) {
	const glm::dmat3 rotation = glm::transpose(glm::dmat3(p_right, p_down, p_forward));
	glm::dmat4 view(rotation);
	view[3] = glm::dvec4(-(rotation * p_origin_world), 1.0);
	return view;
}

/// Factor for the view's extent so that a border of p_border_px texels is free around its content.
float widen_for_border(uint32_t p_map_size_px, uint32_t p_border_px) {
	GNOMON_ASSERT(p_map_size_px > 2 * p_border_px, "map of ", p_map_size_px,
			" px has no room for two borders of ", p_border_px, " px");
	return static_cast<float>(p_map_size_px) / static_cast<float>(p_map_size_px - 2 * p_border_px);
}

template <typename Function> void for_each_corner(const Bounds &p_bounds, Function p_function) {
	for (int corner = 0; corner < 8; ++corner) {
		p_function(p_bounds.get_corner(corner));
	}
}

LightView build_directional_view(const LightSnapshot &p_light, const LightScene &p_scene,
		uint32_t p_map_size_px, uint32_t p_border_px, float p_caster_margin_m) {
	LightView view;
	view.is_orthographic = true;
	view.size_px = glm::uvec2(p_map_size_px);
	const glm::dmat3 &axes = p_light.world_from_light;
	Bounds bounds = p_scene.caster_bounds_world;
	if (bounds.is_empty()) {
		bounds.add(p_scene.scene.camera.position_world);
	}
	const glm::dvec3 centre = 0.5 * (bounds.minimum + bounds.maximum);
	view.view_from_world = make_view(axes[0], -axes[1], -axes[2], centre);
	Bounds seen;
	for_each_corner(bounds, [&](const glm::dvec3 &p_corner) {
		seen.add(glm::dvec3(view.view_from_world * glm::dvec4(p_corner, 1.0)));
	});
	// 1e-3 S: room around the casters, so that the depth range of a flat caster is not 0.
	const double margin_m = 1e-3 * p_scene.scene.scene_size_m + p_caster_margin_m;
	// With the origin on the near plane, depths are positive and as small as possible.
	view.view_from_world[3].z += margin_m - seen.minimum.z;
	view.near_m = 0.0f;
	view.far_m = static_cast<float>(seen.maximum.z - seen.minimum.z + 2 * margin_m);
	const glm::dvec2 half_extent =
			glm::max(glm::abs(glm::dvec2(seen.minimum)), glm::abs(glm::dvec2(seen.maximum)));
	view.half_extent =
			glm::vec2(half_extent + margin_m) * widen_for_border(p_map_size_px, p_border_px);
	view.caster_margin_m = p_caster_margin_m;
	return view;
}

} // namespace

glm::dmat4 LightView::compute_clip_from_view() const {
	glm::dmat4 clip(0.0);
	clip[0][0] = 1.0 / half_extent.x;
	clip[1][1] = 1.0 / half_extent.y;
	if (is_orthographic) {
		const double range_m = double(far_m) - near_m;
		clip[2][2] = -1.0 / range_m; // (far - z) / (far - near)
		clip[3][2] = far_m / range_m;
		clip[3][3] = 1.0;
	} else {
		clip[3][2] = near_m; // depth = near / z
		clip[2][3] = 1.0;
	}
	return clip;
}

glm::mat4 LightView::compute_clip_from_node(const glm::dmat4 &p_world_from_node) const {
	return glm::mat4(compute_clip_from_view() * (view_from_world * p_world_from_node));
}

glm::mat4 LightView::compute_view_from_camera_relative(const CameraSnapshot &p_camera) const {
	return glm::mat4(view_from_world * glm::translate(glm::dmat4(1.0), p_camera.position_world));
}

shader::LightViewConstants LightView::compute_constants(
		const CameraSnapshot &p_camera, uint32_t p_layer) const {
	shader::LightViewConstants constants = {};
	constants.view_from_camera_relative = compute_view_from_camera_relative(p_camera);
	constants.half_extent = half_extent;
	constants.depth_scale = is_orthographic ? 1.0f / (far_m - near_m) : near_m;
	constants.far_m = far_m;
	constants.size_px = size_px;
	constants.is_orthographic = is_orthographic ? 1u : 0u;
	constants.layer = p_layer;
	return constants;
}

bool LightView::may_see_box(
		const Bounds &p_box, const glm::dmat4 &p_view_from_box, double p_margin_m) const {
	// The box is outside when all of it is farther than the margin outside one plane: the four
	// sides, and z > 0 for a perspective view. A linear function is lowest at one of its corners.
	const glm::dvec3 centre = 0.5 * (p_box.minimum + p_box.maximum);
	const glm::dvec3 half_size = 0.5 * (p_box.maximum - p_box.minimum);
	const glm::dvec3 origin = glm::dvec3(p_view_from_box * glm::dvec4(centre, 1.0));
	const glm::dmat3 axes(glm::dvec3(p_view_from_box[0]) * half_size.x,
			glm::dvec3(p_view_from_box[1]) * half_size.y,
			glm::dvec3(p_view_from_box[2]) * half_size.z);
	const double ROUNDING = 1e-13; // relative
	// Whether normal . p is above the limit for all p of the box.
	const auto is_above = [&](const glm::dvec3 &p_normal, double p_limit) {
		const glm::dvec3 reach = glm::abs(p_normal * axes); // of each axis
		const glm::dvec3 terms = glm::abs(p_normal * origin);
		const double middle = glm::dot(p_normal, origin);
		const double rounding = ROUNDING * (terms.x + terms.y + terms.z + std::abs(p_limit));
		return middle - (reach.x + reach.y + reach.z) > p_limit + rounding;
	};
	const glm::dvec2 extent(half_extent);
	if (is_orthographic) {
		return !is_above({ 1.0, 0.0, 0.0 }, extent.x + p_margin_m) &&
				!is_above({ -1.0, 0.0, 0.0 }, extent.x + p_margin_m) &&
				!is_above({ 0.0, 1.0, 0.0 }, extent.y + p_margin_m) &&
				!is_above({ 0.0, -1.0, 0.0 }, extent.y + p_margin_m);
	}
	const glm::dvec2 margin = p_margin_m * glm::sqrt(1.0 + extent * extent);
	return !is_above({ 0.0, 0.0, -1.0 }, p_margin_m) &&
			!is_above({ 1.0, 0.0, -extent.x }, margin.x) &&
			!is_above({ -1.0, 0.0, -extent.x }, margin.x) &&
			!is_above({ 0.0, 1.0, -extent.y }, margin.y) &&
			!is_above({ 0.0, -1.0, -extent.y }, margin.y);
}

bool LightView::may_see(const Bounds &p_bounds_world) const {
	return !p_bounds_world.is_empty() &&
			may_see_box(p_bounds_world, view_from_world, caster_margin_m);
}

bool LightView::may_see(const InstanceSnapshot &p_instance) const {
	return may_see(p_instance.bounds_world) &&
			may_see_box(p_instance.caster_bounds_node, view_from_world * p_instance.world_from_node,
					caster_margin_m);
}

namespace {

glm::dvec2 compute_range_m(const Bounds &p_box, const glm::dmat4 &p_view_from_box) {
	// z is linear in each of the box's coordinates, so each axis adds its own minimum and maximum.
	glm::dvec2 range(p_view_from_box[3].z);
	for (int axis = 0; axis < 3; ++axis) {
		const double low = p_view_from_box[axis].z * p_box.minimum[axis];
		const double high = p_view_from_box[axis].z * p_box.maximum[axis];
		range += glm::dvec2(std::min(low, high), std::max(low, high));
	}
	return range;
}

} // namespace

glm::dvec2 LightView::compute_distance_range_m(const Bounds &p_bounds_world) const {
	return compute_range_m(p_bounds_world, view_from_world);
}

glm::dvec2 LightView::compute_distance_range_m(const InstanceSnapshot &p_instance) const {
	return compute_range_m(
			p_instance.caster_bounds_node, view_from_world * p_instance.world_from_node);
}

std::vector<LightView> build_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		uint32_t p_map_size_px, uint32_t p_border_px, float p_caster_margin_m) {
	if (p_light.type == LightType::DIRECTIONAL) {
		return { build_directional_view(
				p_light, p_scene, p_map_size_px, p_border_px, p_caster_margin_m) };
	}
	const glm::dmat3 &axes = p_light.world_from_light;
	LightView view;
	view.size_px = glm::uvec2(p_map_size_px);
	view.caster_margin_m = p_caster_margin_m;
	view.near_m = static_cast<float>(NEAR_PER_SCENE_SIZE * p_scene.scene.scene_size_m);
	const float widening = widen_for_border(p_map_size_px, p_border_px);
	if (p_light.type == LightType::SPOT && p_light.outer_cone_rad <= MAX_SINGLE_VIEW_RAD) {
		view.view_from_world = make_view(axes[0], -axes[1], -axes[2], p_light.position_world);
		// In double precision, whose rounding to float is the same with every C library.
		const float exact = static_cast<float>(std::tan(double(p_light.outer_cone_rad)));
		const float tangent = std::max(exact, MIN_TANGENT);
		view.half_extent = glm::vec2(tangent * widening);
		return { view };
	}
	std::vector<LightView> views;
	view.half_extent = glm::vec2(widening);
	for (int face = 0; face < 6; ++face) {
		const int axis = face / 2;
		const glm::dvec3 forward = axes[axis] * (face % 2 == 0 ? 1.0 : -1.0);
		const glm::dvec3 right = axes[(axis + 1) % 3];
		view.view_from_world =
				make_view(right, glm::cross(forward, right), forward, p_light.position_world);
		views.push_back(view);
	}
	return views;
}

shader::LightConstants compute_light_constants(
		const LightSnapshot &p_light, const CameraSnapshot &p_camera) {
	shader::LightConstants constants = {};
	const glm::dvec3 position = p_light.type == LightType::DIRECTIONAL
			? glm::dvec3(0.0)
			: p_light.position_world - p_camera.position_world;
	constants.position_radius = glm::vec4(glm::vec3(position), p_light.get_disc_radius());
	constants.direction = glm::vec4(glm::vec3(p_light.get_direction_world()), 0.0f);
	constants.intensity = glm::vec4(p_light.color * p_light.intensity, 0.0f);
	constants.range_m = p_light.range_m;
	constants.cos_outer = static_cast<float>(std::cos(double(p_light.outer_cone_rad)));
	constants.cos_inner = static_cast<float>(std::cos(double(p_light.inner_cone_rad)));
	constants.type = p_light.type == LightType::OMNI ? LIGHT_TYPE_OMNI
			: p_light.type == LightType::SPOT		 ? LIGHT_TYPE_SPOT
													 : LIGHT_TYPE_DIRECTIONAL;
	return constants;
}

glm::mat4 compute_light_from_camera_relative(
		const LightSnapshot &p_light, const CameraSnapshot &p_camera) {
	const glm::dmat3 light_from_world = glm::transpose(p_light.world_from_light);
	glm::dmat4 result(light_from_world);
	result[3] =
			glm::dvec4(light_from_world * (p_camera.position_world - p_light.position_world), 1.0);
	return glm::mat4(result);
}

shader::LightViewsConstants compute_light_views_constants(const LightSnapshot &p_light,
		const CameraSnapshot &p_camera, const std::vector<LightView> &p_views) {
	GNOMON_ASSERT(p_views.size() <= MAX_LIGHT_VIEWS, "light \"", p_light.name, "\" has ",
			p_views.size(), " views, must be at most ", MAX_LIGHT_VIEWS);
	shader::LightViewsConstants constants = {};
	for (uint32_t index = 0; index < p_views.size(); ++index) {
		constants.views[index] = p_views[index].compute_constants(p_camera, index);
	}
	constants.light_from_camera_relative = compute_light_from_camera_relative(p_light, p_camera);
	constants.view_count = static_cast<uint32_t>(p_views.size());
	return constants;
}

} // namespace gnomon
