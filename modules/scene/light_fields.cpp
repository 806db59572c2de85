// Declares the members of lights that are properties, and the gizmos of lights.

#include "modules/scene/node_members.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const double MIN_CONE_GAP = 1e-3; // inner cone at most (1 - this) times the outer cone

PropertyValue read_light_type(const Node3D &p_node) {
	return std::string(get_light_type_name(to<Light3D>(p_node).type));
}

void write_light_type(Node3D &r_node, const PropertyValue &p_value) {
	for (const LightType type : { LightType::OMNI, LightType::SPOT, LightType::DIRECTIONAL }) {
		if (std::get<std::string>(p_value) == get_light_type_name(type)) {
			to<Light3D>(r_node).type = type;
		}
	}
}

PropertyValue read_light_color(const Node3D &p_node) {
	return glm::dvec3(to<Light3D>(p_node).color);
}

void write_light_color(Node3D &r_node, const PropertyValue &p_value) {
	to<Light3D>(r_node).color = glm::vec3(std::get<glm::dvec3>(p_value));
}

bool is_spot(const Node3D &p_node) {
	return to<Light3D>(p_node).type == LightType::SPOT;
}

bool has_position(const Node3D &p_node) {
	return to<Light3D>(p_node).type != LightType::DIRECTIONAL;
}

/// Keeps the inner cone within the outer one by widening the outer one, which must be above 0 even
/// if the inner one is 0.
void write_inner_cone(Node3D &r_node, const PropertyValue &p_value) {
	write_degrees<Light3D, &Light3D::inner_cone_rad>(r_node, p_value);
	Light3D &light = to<Light3D>(r_node);
	light.outer_cone_rad = std::max(
			light.outer_cone_rad, light.inner_cone_rad * float(1.0 + MIN_CONE_GAP) + 1e-6f);
}

void write_outer_cone(Node3D &r_node, const PropertyValue &p_value) {
	write_degrees<Light3D, &Light3D::outer_cone_rad>(r_node, p_value);
	Light3D &light = to<Light3D>(r_node);
	light.inner_cone_rad =
			std::min(light.inner_cone_rad, light.outer_cone_rad * float(1.0 - MIN_CONE_GAP));
}

std::vector<NodeField> make_light_fields() {
	std::vector<NodeField> fields = {
		{ make_info("type", PropertyType::ENUM, std::string("omni"), "omni,spot,directional",
				  "Omni shines all around, spot in a cone, directional in parallel from afar.", "",
				  "Light"),
				&read_light_type, &write_light_type },
		{ make_info("color", PropertyType::VECTOR3, glm::dvec3(1.0), "0,1,0.01",
				  "Colour of the light, linear red, green and blue.", "", "Light"),
				&read_light_color, &write_light_color },
		{ make_info("intensity", PropertyType::FLOAT, 1.0, "0,1000000,0.1",
				  "Luminous intensity in candela; of a directional light illuminance in lux. 0 "
				  "switches the light off.",
				  "", "Light"),
				&read_number<Light3D, &Light3D::intensity>,
				&write_number<Light3D, &Light3D::intensity> },
		{ make_info("range", PropertyType::FLOAT, 0.0, "0,1000000,0.1",
				  "How far the light reaches. 0 is unlimited.", "m", "Light"),
				&read_number<Light3D, &Light3D::range_m>, &write_number<Light3D, &Light3D::range_m>,
				&has_position },
		{ make_info("inner_cone", PropertyType::FLOAT, 0.0, "0,89.9,0.1",
				  "Half angle within which a spot light has its full brightness.", "deg", "Light"),
				&read_degrees<Light3D, &Light3D::inner_cone_rad>, &write_inner_cone, &is_spot },
		{ make_info("outer_cone", PropertyType::FLOAT, 45.0, "0.1,90,0.1",
				  "Half angle of a spot light's cone; outside it is dark.", "deg", "Light"),
				&read_degrees<Light3D, &Light3D::outer_cone_rad>, &write_outer_cone, &is_spot }
	};
	fields[1].info.is_color = true; // "color"
	return extend_node_fields(std::move(fields));
}

} // namespace

const std::vector<NodeField> &Light3D::get_fields() const {
	static const std::vector<NodeField> fields = make_light_fields();
	return fields;
}

void Light3D::add_stored_properties(PropertyList &r_list) const {
	const char *inapplicable =
			type == LightType::DIRECTIONAL ? "light_size" : "light_angular_distance";
	for (const PropertyInfo &info : get_property_list().get_properties()) {
		if (info.name != inapplicable) {
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
		gizmo.radius_m = std::tan(0.5 * angle_deg / DEGREES_PER_RADIAN);
		gizmo.property = "light_angular_distance";
		gizmo.value = angle_deg;
		// Derivative of the angle, 2 atan(radius).
		gizmo.value_per_m = 2.0 * DEGREES_PER_RADIAN / (1.0 + gizmo.radius_m * gizmo.radius_m);
		r_gizmos.push_back(gizmo);
		return;
	}
	gizmo.radius_m = get_float(get_property_list(), properties, "light_size");
	gizmo.property = "light_size";
	gizmo.value = gizmo.radius_m;
	gizmo.is_filled = type == LightType::SPOT;
	r_gizmos.push_back(gizmo);
	if (type == LightType::OMNI) { // a sphere: two more rings, without handles
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
	LightSettings::operator=(other);
	file_path = other.file_path;
}

} // namespace gnomon
