#include "modules/scene/scene_snapshot.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/scene/cut_mesh.h"
#include "modules/scene/mesh_pose.h"
#include "modules/scene/node_transform.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace gnomon {

namespace {

// Volume of the unit axes' parallelepiped below which an orientation is rounding noise.
const double MIN_AXES_VOLUME = 1e-9;

/// Reads a property, checked and converted to its type. Values from files and the inspector are
/// checked already, but code may set any value.
PropertyValue read_property(const LightSnapshot &p_light, std::string_view p_name) {
	const PropertyList &list = Light3D::get_property_list();
	const PropertyInfo &info = *list.find(p_name);
	const PropertyValue &value = get_property(list, p_light.properties, p_name);
	const std::string refusal = check_property(info, value);
	if (!refusal.empty()) {
		fail("Light \"", p_light.name, "\": ", p_name, " ", refusal,
				". Set it to an allowed value.");
	}
	return convert_property(info, value);
}

float read_float(const LightSnapshot &p_light, std::string_view p_name) {
	return static_cast<float>(std::get<double>(read_property(p_light, p_name)));
}

/// Returns the longest of the cross products of a matrix's columns: the normal of their plane if
/// all are in one.
glm::dvec3 find_longest_cross_product(const glm::dmat3 &p_matrix) {
	glm::dvec3 longest(0.0);
	for (int column = 0; column < 3; ++column) {
		const glm::dvec3 product = glm::cross(p_matrix[column], p_matrix[(column + 1) % 3]);
		longest = glm::length(product) > glm::length(longest) ? product : longest;
	}
	return longest;
}

/// A transform that flattens a node, such as a scale of 0, leaves a flat mesh that casts shadows,
/// but whose faces have no front or back. It gets the smallest thickness that restores them.
void thicken_if_flat(glm::dmat4 &r_world_from_node) {
	const double THICKNESS = 1e-6; // of the longest axis
	const double ROUNDING = 1e-14; // relative: smaller areas and volumes count as 0
	const glm::dmat3 axes(r_world_from_node);
	const double longest =
			std::max({ glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]) });
	// The longest cross product is at most the square of the longest axis, so this is not flat.
	if (std::abs(glm::determinant(axes)) > ROUNDING * longest * longest * longest) {
		return;
	}
	const glm::dvec3 normal_world = find_longest_cross_product(axes);
	const glm::dvec3 flat_axis_node = find_longest_cross_product(glm::transpose(axes));
	if (longest <= 0 || glm::length(normal_world) <= ROUNDING * longest * longest ||
			std::abs(glm::determinant(axes)) > ROUNDING * longest * glm::length(normal_world)) {
		return; // not flat, or collapsed to a line or a point
	}
	const glm::dvec3 along = THICKNESS * longest * glm::normalize(normal_world);
	const glm::dvec3 flat_axis = glm::normalize(flat_axis_node);
	glm::dmat3 thick = axes + glm::outerProduct(along, flat_axis);
	if (glm::determinant(thick) < 0) {
		thick = axes - glm::outerProduct(along, flat_axis);
	}
	for (int column = 0; column < 3; ++column) {
		r_world_from_node[column] = glm::dvec4(thick[column], 0.0);
	}
}

void check_bounds(const InstanceSnapshot &p_instance) {
	if (!std::isfinite(p_instance.bounds_world.get_diagonal())) {
		fail("Node \"", p_instance.node_name, "\": its vertices are not finite in the world. Make ",
				"its scale smaller.");
	}
}

} // namespace

glm::dmat3 compute_orientation(
		const glm::dmat4 &p_world_from_node, const char *p_kind, const std::string &p_name) {
	glm::dmat3 axes(p_world_from_node);
	bool is_degenerate = false;
	for (int axis = 0; axis < 3; ++axis) {
		const double length = glm::length(axes[axis]);
		is_degenerate = is_degenerate || !(length > 0) || !std::isfinite(length);
		axes[axis] /= length;
	}
	if (is_degenerate || !(std::abs(glm::determinant(axes)) > MIN_AXES_VOLUME)) {
		fail(p_kind, " \"", p_name,
				"\": its transform has no orientation (a scale is 0, too large, ",
				"or axes coincide). Correct the scale of it and of its parents.");
	}
	const glm::dvec3 back = axes[2];
	const glm::dvec3 right = glm::normalize(axes[0] - back * glm::dot(axes[0], back));
	return glm::dmat3(right, glm::cross(back, right), back);
}

InstanceSnapshot make_instance(std::shared_ptr<const Mesh> p_mesh,
		std::shared_ptr<const Material> p_material, const glm::dmat4 &p_world_from_node,
		const std::string &p_node_name) {
	// A mesh without a material is still visible: it gets the default material.
	static const auto default_material = std::make_shared<const Material>();
	InstanceSnapshot instance;
	instance.mesh = std::move(p_mesh);
	instance.material = p_material ? std::move(p_material) : default_material;
	const CutMesh cut = get_cut_mesh(instance.mesh, instance.material);
	instance.casts_shadow = cut.mesh != nullptr;
	instance.caster_mesh = cut.mesh ? cut.mesh : instance.mesh;
	instance.caster_levels = cut.levels;
	instance.cut_block_size_px = cut.block_size_px;
	instance.cut_hash = cut.content_hash;
	instance.node_name = p_node_name;
	instance.caster_bounds_node = instance.caster_mesh->bounds_node;
	instance.set_transform(p_world_from_node);
	return instance;
}

void InstanceSnapshot::set_transform(const glm::dmat4 &p_world_from_node) {
	world_from_node = p_world_from_node;
	thicken_if_flat(world_from_node);
	bounds_world = transform_bounds(mesh->bounds_node, world_from_node);
	check_bounds(*this);
}

void InstanceSnapshot::set_pose(
		std::shared_ptr<PoseSlot> p_slot, std::shared_ptr<const MeshPose> p_pose) {
	pose_slot = std::move(p_slot);
	pose = std::move(p_pose);
	const bool casts_itself = caster_mesh == mesh;
	mesh = pose_slot->get_deformed(mesh);
	caster_mesh = casts_itself ? mesh : pose_slot->get_deformed(caster_mesh);
	caster_bounds_node = pose->get_bounds();
	bounds_world = transform_bounds(pose->get_bounds(), world_from_node);
	check_bounds(*this);
}

std::shared_ptr<const Mesh> InstanceSnapshot::get_posed_mesh() const {
	return pose ? pose->get_mesh(mesh->rest) : mesh;
}

std::shared_ptr<const Mesh> InstanceSnapshot::get_posed_caster_mesh() const {
	return pose ? pose->get_mesh(caster_mesh->rest) : caster_mesh;
}

uint64_t InstanceSnapshot::get_pose_hash() const {
	return pose ? pose->get_hash() : 0;
}

uint64_t CameraSnapshot::compute_hash(uint64_t p_seed) const {
	uint64_t hash = compute_value_hash(position_world, p_seed);
	hash = compute_value_hash(world_from_camera, hash);
	hash = compute_value_hash(vertical_fov_rad, hash);
	hash = compute_value_hash(shift, hash);
	return compute_value_hash(near_m, hash);
}

void LightSnapshot::decide_settings(double p_scene_size_m) {
	light_size_m = read_float(*this, "light_size");
	light_angular_distance_deg = read_float(*this, "light_angular_distance");
	casts_shadow = std::get<bool>(read_property(*this, "shadow_enabled"));
	technique_id = std::get<std::string>(read_property(*this, "shadow_technique"));
	// May exceed the range of explicit widths: a scene of any size has the penumbra of its light's
	// angle.
	size_m = type == LightType::DIRECTIONAL ? get_disc_radius() * static_cast<float>(p_scene_size_m)
											: light_size_m;
	penumbra_outer_width_m = read_float(*this, "penumbra_outer_width");
	penumbra_inner_width_m = read_float(*this, "penumbra_inner_width");
	is_outer_width_derived = penumbra_outer_width_m < 0;
	is_inner_width_derived = penumbra_inner_width_m < 0;
	derive_widths({});
}

void LightSnapshot::derive_widths(const DerivedWidths &p_widths) {
	if (is_outer_width_derived) {
		penumbra_outer_width_m = p_widths.outer_per_size * size_m;
	}
	if (is_inner_width_derived) {
		penumbra_inner_width_m = p_widths.inner_per_size * size_m;
	}
}

double LightSnapshot::compute_max_penumbra_half_width(
		const Bounds &p_caster, const Bounds &p_scene) const {
	double max_half_width = 0;
	for (int index = 0; index < 8; ++index) {
		const glm::dvec3 corner = p_caster.get_corner(index);
		const glm::dvec3 from_light = corner - position_world;
		const double distance = glm::length(from_light);
		const bool is_directional = type == LightType::DIRECTIONAL;
		const glm::dvec3 direction =
				is_directional || distance <= 0 ? get_direction_world() : from_light / distance;
		const double distance_behind = p_scene.compute_exit_distance(corner, direction);
		const double ratio = is_directional
				? distance_behind
				: distance_behind / std::max(distance + distance_behind, 1e-300);
		max_half_width = std::max(max_half_width, get_disc_radius() * ratio);
	}
	return max_half_width;
}

uint64_t LightSnapshot::compute_hash(uint64_t p_seed) const {
	uint64_t hash = compute_value_hash(type, p_seed);
	hash = compute_value_hash(position_world, hash);
	hash = compute_value_hash(world_from_light, hash);
	hash = compute_value_hash(range_m, hash);
	hash = compute_value_hash(outer_cone_rad, hash);
	return compute_value_hash(get_disc_radius(), hash);
}

uint64_t InstanceSnapshot::compute_hash(uint64_t p_seed) const {
	uint64_t hash = compute_value_hash(mesh->content_hash, p_seed);
	hash = compute_value_hash(get_pose_hash(), hash);
	hash = compute_value_hash(cut_hash, hash);
	hash = compute_value_hash(world_from_node, hash);
	hash = compute_value_hash(casts_shadow, hash);
	return compute_value_hash(compute_transmittance(), hash);
}

float LightSnapshot::get_disc_radius() const {
	if (type == LightType::DIRECTIONAL) {
		const double half_rad = glm::radians(light_angular_distance_deg) * 0.5f;
		return static_cast<float>(std::tan(half_rad)); // rounded alike with every C library
	}
	return light_size_m;
}

double InstanceSnapshot::compute_max_penumbra_half_width(
		const LightSnapshot &p_light, const Bounds &p_scene_bounds) const {
	return p_light.compute_max_penumbra_half_width(bounds_world, p_scene_bounds) /
			compute_max_stretch(world_from_node);
}

glm::vec3 InstanceSnapshot::compute_transmittance() const {
	if (!(material->transmission > 0.0f)) {
		return glm::vec3(0.0f); // most instances; without the scale
	}
	const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(world_from_node))));
	return material->compute_transmittance(static_cast<float>(scale));
}

bool InstanceSnapshot::is_mirrored() const {
	return glm::determinant(glm::dmat3(world_from_node)) < 0;
}

glm::mat4 SceneSnapshot::get_camera_relative_from_node(const InstanceSnapshot &p_instance) const {
	glm::dmat4 camera_relative_from_node = p_instance.world_from_node;
	camera_relative_from_node[3] -= glm::dvec4(camera.position_world, 0.0);
	return glm::mat4(camera_relative_from_node);
}

const LightSnapshot *SceneSnapshot::find_light(const std::string &p_name) const {
	for (const LightSnapshot &light : lights) {
		if (light.name == p_name) {
			return &light;
		}
	}
	return nullptr;
}

Bounds SceneSnapshot::compute_bounds() const {
	Bounds bounds;
	for (const InstanceSnapshot &instance : instances) {
		bounds.add(instance.bounds_world);
	}
	return bounds;
}

std::string SceneSnapshot::describe_largest_caster() const {
	struct Group {
		const InstanceSnapshot *first = nullptr;
		uint64_t node_count = 0;
		uint64_t triangle_count = 0;
	};
	std::map<uint64_t, Group> groups; // by mesh id
	uint64_t total = 0;
	for (const InstanceSnapshot &instance : instances) {
		if (instance.casts_shadow) {
			Group &group = groups[instance.caster_mesh->id];
			group.first = group.first ? group.first : &instance;
			++group.node_count;
			group.triangle_count += instance.caster_mesh->get_triangle_count();
			total += instance.caster_mesh->get_triangle_count();
		}
	}
	const auto largest = std::max_element(
			groups.begin(), groups.end(), [](const auto &p_left, const auto &p_right) {
				return p_left.second.triangle_count < p_right.second.triangle_count;
			});
	if (largest == groups.end()) {
		return {};
	}
	const Group &group = largest->second;
	std::string nodes = text("\"", group.first->node_name, "\"");
	if (group.node_count > 1) {
		nodes += text(" and ", group.node_count - 1, " other node", group.node_count > 2 ? "s" : "",
				" with its mesh");
	}
	return text("Of ", total, " triangles, ", group.triangle_count, " are of ", nodes, ".");
}

Bounds SceneSnapshot::compute_caster_bounds() const {
	Bounds bounds;
	for (const InstanceSnapshot &instance : instances) {
		if (instance.casts_shadow) {
			bounds.add(instance.bounds_world);
		}
	}
	return bounds;
}

} // namespace gnomon
