// The members of each node class that are properties, and copies of nodes.

#include "modules/core/error.h"
#include "modules/scene/node_properties.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtx/euler_angles.hpp>

#include <algorithm>
#include <cmath>
#include <typeinfo>

namespace gnomon {

namespace {

const double DEGREES = 180.0 / 3.14159265358979323846;
const double NARROWEST_EDGE = 1e-3; // of the outer cone: the inner one stays that much below it
const char LENGTHS[] = "-10000,10000,0.01";

template <typename T> T &to(Node3D &r_node) {
	return static_cast<T &>(r_node);
}
template <typename T> const T &to(const Node3D &p_node) {
	return static_cast<const T &>(p_node);
}

/// A transform in parts: parent_from_node = position * rotation * scale, without shear. Rotation in
/// degrees about y, then x, then z, as Godot's.
struct TransformParts {
	glm::dvec3 position = glm::dvec3(0.0);
	glm::dvec3 rotation_deg = glm::dvec3(0.0);
	glm::dvec3 scale = glm::dvec3(1.0);

	explicit TransformParts(const Node3D &p_node) : position(p_node.parent_from_node[3]) {
		glm::dmat3 axes(p_node.parent_from_node);
		for (int axis = 0; axis < 3; ++axis) {
			scale[axis] = glm::length(axes[axis]);
		}
		scale.x *= glm::determinant(axes) < 0 ? -1.0 : 1.0;
		for (int axis = 0; axis < 3; ++axis) {
			if (scale[axis] != 0) {
				axes[axis] /= scale[axis];
			}
		}
		for (int axis = 0; axis < 3; ++axis) {
			if (scale[axis] == 0) { // flat: the other two still tell how it is turned
				axes[axis] = glm::cross(axes[(axis + 1) % 3], axes[(axis + 2) % 3]);
			}
		}
		if (!(std::abs(glm::determinant(axes) - 1.0) < 0.5)) {
			axes = glm::dmat3(1.0); // a line or a point
		}
		double y = 0;
		double x = 0;
		double z = 0;
		glm::extractEulerAngleYXZ(glm::dmat4(axes), y, x, z);
		const double STEP_DEG = 1e-9; // a matrix has no more digits, and 1e-15 is a 0
		rotation_deg = glm::round(DEGREES * glm::dvec3(x, y, z) / STEP_DEG) * STEP_DEG;
	}

	void apply(Node3D &r_node) const {
		const glm::dvec3 rotation = rotation_deg / DEGREES;
		r_node.parent_from_node = glm::scale(glm::translate(glm::dmat4(1.0), position) *
						glm::eulerAngleYXZ(rotation.y, rotation.x, rotation.z),
				scale);
	}
};

template <glm::dvec3 TransformParts::*PART> PropertyValue read_part(const Node3D &p_node) {
	return TransformParts(p_node).*PART;
}

template <glm::dvec3 TransformParts::*PART>
void write_part(Node3D &r_node, const PropertyValue &p_value) {
	TransformParts parts(r_node);
	parts.*PART = std::get<glm::dvec3>(p_value);
	parts.apply(r_node);
}

template <typename T, bool T::*MEMBER> PropertyValue read_flag(const Node3D &p_node) {
	return to<T>(p_node).*MEMBER;
}

template <typename T, bool T::*MEMBER>
void write_flag(Node3D &r_node, const PropertyValue &p_value) {
	to<T>(r_node).*MEMBER = std::get<bool>(p_value);
}

template <typename T, float T::*MEMBER> PropertyValue read_number(const Node3D &p_node) {
	return double(to<T>(p_node).*MEMBER);
}

template <typename T, float T::*MEMBER>
void write_number(Node3D &r_node, const PropertyValue &p_value) {
	to<T>(r_node).*MEMBER = float(std::get<double>(p_value));
}

template <typename T, float T::*MEMBER> PropertyValue read_degrees(const Node3D &p_node) {
	return DEGREES * double(to<T>(p_node).*MEMBER);
}

template <typename T, float T::*MEMBER>
void write_degrees(Node3D &r_node, const PropertyValue &p_value) {
	to<T>(r_node).*MEMBER = float(std::get<double>(p_value) / DEGREES);
}

const char *const LIGHT_TYPES[] = { "omni", "spot", "directional" };

PropertyValue read_light_type(const Node3D &p_node) {
	return std::string(LIGHT_TYPES[static_cast<int>(to<Light3D>(p_node).type)]);
}

void write_light_type(Node3D &r_node, const PropertyValue &p_value) {
	const std::string &name = std::get<std::string>(p_value);
	const auto found = std::find(std::begin(LIGHT_TYPES), std::end(LIGHT_TYPES), name);
	to<Light3D>(r_node).type = static_cast<LightType>(found - std::begin(LIGHT_TYPES));
}

PropertyValue read_color(const Node3D &p_node) {
	return glm::dvec3(to<Light3D>(p_node).color);
}

void write_color(Node3D &r_node, const PropertyValue &p_value) {
	to<Light3D>(r_node).color = glm::vec3(std::get<glm::dvec3>(p_value));
}

bool is_spot(const Node3D &p_node) {
	return to<Light3D>(p_node).type == LightType::SPOT;
}

bool has_place(const Node3D &p_node) {
	return to<Light3D>(p_node).type != LightType::DIRECTIONAL;
}

/// The inner cone lies within the outer one.
void write_inner_cone(Node3D &r_node, const PropertyValue &p_value) {
	write_degrees<Light3D, &Light3D::inner_cone_rad>(r_node, p_value);
	Light3D &light = to<Light3D>(r_node);
	light.outer_cone_rad = std::max(
			light.outer_cone_rad, light.inner_cone_rad * float(1.0 + NARROWEST_EDGE) + 1e-6f);
}

void write_outer_cone(Node3D &r_node, const PropertyValue &p_value) {
	write_degrees<Light3D, &Light3D::outer_cone_rad>(r_node, p_value);
	Light3D &light = to<Light3D>(r_node);
	light.inner_cone_rad =
			std::min(light.inner_cone_rad, light.outer_cone_rad * float(1.0 - NARROWEST_EDGE));
}

PropertyInfo make_info(const char *p_name, PropertyType p_type, PropertyValue p_default,
		const char *p_hint, const char *p_tooltip, const char *p_unit, const char *p_group) {
	return { p_name, p_type, std::move(p_default), p_hint, p_tooltip, p_unit, p_group };
}

PropertyValue read_position(const Node3D &p_node) {
	return glm::dvec3(p_node.parent_from_node[3]);
}

void write_position(Node3D &r_node, const PropertyValue &p_value) {
	r_node.parent_from_node[3] = glm::dvec4(std::get<glm::dvec3>(p_value), 1.0);
}

std::vector<NodeField> make_node_fields() {
	return { { make_info("position", PropertyType::VECTOR3, glm::dvec3(0.0), LENGTHS,
					   "Place of the node in its parent.", "m", "Transform"),
					 &read_position, &write_position },
		{ make_info("rotation", PropertyType::VECTOR3, glm::dvec3(0.0), "-360,360,1",
				  "Turn about y, then x, then z.", "deg", "Transform"),
				&read_part<&TransformParts::rotation_deg>,
				&write_part<&TransformParts::rotation_deg> },
		{ make_info("scale", PropertyType::VECTOR3, glm::dvec3(1.0), "-10000,10000,0.01",
				  "Size along each axis. 0 along one makes it flat: it casts nothing.", "",
				  "Transform"),
				&read_part<&TransformParts::scale>, &write_part<&TransformParts::scale> } };
}

/// The base's fields, then more.
std::vector<NodeField> extend(std::vector<NodeField> p_more) {
	std::vector<NodeField> fields = make_node_fields();
	std::move(p_more.begin(), p_more.end(), std::back_inserter(fields));
	return fields;
}

std::vector<NodeField> make_light_fields() {
	std::vector<NodeField> fields = {
		{ make_info("type", PropertyType::ENUM, std::string("omni"), "omni,spot,directional",
				  "Omni shines all around, spot in a cone, directional in parallel from afar.", "",
				  "Light"),
				&read_light_type, &write_light_type },
		{ make_info("color", PropertyType::VECTOR3, glm::dvec3(1.0), "0,1,0.01",
				  "Colour of the light, linear red, green and blue.", "", "Light"),
				&read_color, &write_color },
		{ make_info("intensity", PropertyType::FLOAT, 1.0, "0,1000000,0.1",
				  "Luminous intensity in candela; of a directional light illuminance in lux. 0 "
				  "leaves the light out.",
				  "", "Light"),
				&read_number<Light3D, &Light3D::intensity>,
				&write_number<Light3D, &Light3D::intensity> },
		{ make_info("range", PropertyType::FLOAT, 0.0, "0,1000000,0.1",
				  "How far the light reaches. 0 is unlimited.", "m", "Light"),
				&read_number<Light3D, &Light3D::range_m>, &write_number<Light3D, &Light3D::range_m>,
				&has_place },
		{ make_info("inner_cone", PropertyType::FLOAT, 0.0, "0,89.9,0.1",
				  "Half angle within which a spot light has its full brightness.", "deg", "Light"),
				&read_degrees<Light3D, &Light3D::inner_cone_rad>, &write_inner_cone, &is_spot },
		{ make_info("outer_cone", PropertyType::FLOAT, 45.0, "0.1,90,0.1",
				  "Half angle of a spot light's cone; outside it is dark.", "deg", "Light"),
				&read_degrees<Light3D, &Light3D::outer_cone_rad>, &write_outer_cone, &is_spot }
	};
	fields[1].info.is_color = true;
	return extend(std::move(fields));
}

template <typename T> std::unique_ptr<Node3D> copy_as(const Node3D &p_node) {
	auto node = std::make_unique<T>();
	node->assign(p_node);
	return node;
}

} // namespace

const std::vector<NodeField> &Node3D::get_fields() const {
	static const std::vector<NodeField> fields = make_node_fields();
	return fields;
}

std::unique_ptr<Node3D> Node3D::copy() const {
	return copy_as<Node3D>(*this);
}

void Node3D::assign(const Node3D &p_other) {
	GNOMON_ASSERT(typeid(*this) == typeid(p_other), get_class_name(), " is no ",
			p_other.get_class_name());
	name = p_other.name;
	parent_from_node = p_other.parent_from_node;
	file_index = p_other.file_index;
}

const std::vector<NodeField> &MeshInstance3D::get_fields() const {
	static const std::vector<NodeField> fields =
			extend({ { make_info("cast_shadow", PropertyType::BOOL, true, "",
							   "Whether the mesh hides lights.", "", "Shadow"),
							 &read_flag<MeshInstance3D, &MeshInstance3D::casts_shadow>,
							 &write_flag<MeshInstance3D, &MeshInstance3D::casts_shadow> },
					{ make_info("shadow_planar_receiver", PropertyType::BOOL, false, "",
							  "A flat mesh that planar shadows fall on.", "", "Shadow"),
							&read_flag<MeshInstance3D, &MeshInstance3D::is_planar_receiver>,
							&write_flag<MeshInstance3D, &MeshInstance3D::is_planar_receiver> } });
	return fields;
}

std::unique_ptr<Node3D> MeshInstance3D::copy() const {
	return copy_as<MeshInstance3D>(*this);
}

void MeshInstance3D::assign(const Node3D &p_other) {
	Node3D::assign(p_other);
	const MeshInstance3D &other = to<MeshInstance3D>(p_other);
	surfaces = other.surfaces;
	casts_shadow = other.casts_shadow;
	is_planar_receiver = other.is_planar_receiver;
}

const std::vector<NodeField> &Light3D::get_fields() const {
	static const std::vector<NodeField> fields = make_light_fields();
	return fields;
}

void Light3D::add_stored_properties(PropertyList &r_list) const {
	const char *other = type == LightType::DIRECTIONAL ? "light_size" : "light_angular_distance";
	for (const PropertyInfo &info : get_property_list().get_properties()) {
		if (info.name != other) {
			r_list.add(info);
		}
	}
}

void Light3D::add_gizmos(std::vector<NodeGizmo> &r_gizmos) const {
	NodeGizmo gizmo;
	if (type == LightType::DIRECTIONAL) {
		const double angle_deg =
				get_float(get_property_list(), properties, "light_angular_distance");
		gizmo.center = glm::dvec3(0, 0, -1);
		gizmo.radius_m = std::tan(0.5 * angle_deg / DEGREES);
		gizmo.property = "light_angular_distance";
		gizmo.value = angle_deg;
		gizmo.value_per_m = 2.0 * DEGREES / (1.0 + gizmo.radius_m * gizmo.radius_m);
		r_gizmos.push_back(gizmo);
		return;
	}
	gizmo.radius_m = get_float(get_property_list(), properties, "light_size");
	gizmo.property = "light_size";
	gizmo.value = gizmo.radius_m;
	gizmo.is_filled = type == LightType::SPOT;
	r_gizmos.push_back(gizmo);
	if (type == LightType::OMNI) { // a ball: two more rings, without handles
		gizmo.property.clear();
		gizmo.axis_y = glm::dvec3(0, 0, 1);
		r_gizmos.push_back(gizmo);
		gizmo.axis_x = glm::dvec3(0, 1, 0);
		r_gizmos.push_back(gizmo);
	}
}

std::unique_ptr<Node3D> Light3D::copy() const {
	return copy_as<Light3D>(*this);
}

void Light3D::assign(const Node3D &p_other) {
	Node3D::assign(p_other);
	const Light3D &other = to<Light3D>(p_other);
	type = other.type;
	color = other.color;
	intensity = other.intensity;
	range_m = other.range_m;
	inner_cone_rad = other.inner_cone_rad;
	outer_cone_rad = other.outer_cone_rad;
	properties = other.properties;
	file_path = other.file_path;
}

const std::vector<NodeField> &Camera3D::get_fields() const {
	static const std::vector<NodeField> fields =
			extend({ { make_info("fov", PropertyType::FLOAT, 45.0, "1,179,0.1",
							   "Field of view from top to bottom.", "deg", "Camera"),
							 &read_degrees<Camera3D, &Camera3D::vertical_fov_rad>,
							 &write_degrees<Camera3D, &Camera3D::vertical_fov_rad> },
					{ make_info("near", PropertyType::FLOAT, 0.05, "0.0001,1000,0.001",
							  "Nothing nearer than this is drawn.", "m", "Camera"),
							&read_number<Camera3D, &Camera3D::near_m>,
							&write_number<Camera3D, &Camera3D::near_m> } });
	return fields;
}

std::unique_ptr<Node3D> Camera3D::copy() const {
	return copy_as<Camera3D>(*this);
}

void Camera3D::assign(const Node3D &p_other) {
	Node3D::assign(p_other);
	const Camera3D &other = to<Camera3D>(p_other);
	vertical_fov_rad = other.vertical_fov_rad;
	near_m = other.near_m;
}

} // namespace gnomon
