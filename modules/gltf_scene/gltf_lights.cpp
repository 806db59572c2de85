#include "modules/gltf_scene/gltf_lights.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/core/property.h"
#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_values.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

using tinygltf::Value;

namespace {

const float MAX_CONE_RAD = 1.57079637f; // the float nearest to pi / 2

/// An alternative name of a Light3D property in files.
struct PropertyAlias {
	std::string_view property;
	std::string_view alias;
	double factor; // the property's value is the alias's value times this
};
/// The aliases in the order in which they are tried.
const PropertyAlias ALIASES[] = {
	{ "light_size", "radius", 1.0 },
	{ "light_size", "shadow_soft_size", 1.0 },				   // Blender: radius of the light
	{ "light_angular_distance", "angle", DEGREES_PER_RADIAN }, // Blender: full apparent diameter
};
/// Names in a node's extras that are settings of meshes and not properties of a technique.
const std::string_view MESH_SETTING_NAMES[] = { "casts_shadow", "shadow_planar_receiver" };

/// Converts booleans, numbers and strings. Returns nothing for other values, which cannot be
/// properties.
std::optional<PropertyValue> to_property(const Json &p_value) {
	if (p_value.is_boolean()) {
		return p_value.get<bool>();
	}
	if (p_value.is_number_integer() && (!p_value.is_number_unsigned() || p_value <= INT64_MAX)) {
		return p_value.get<int64_t>();
	}
	if (p_value.is_number()) {
		return p_value.get<double>();
	}
	if (p_value.is_string()) {
		return p_value.get<std::string>();
	}
	return std::nullopt;
}

/// Stores the value at p_extras[p_key], multiplied by p_factor if it is a number, as a property. An
/// invalid value is reported instead.
void read_property(const GltfObject &p_extras, std::string_view p_key, const PropertyInfo &p_info,
		double p_factor, PropertyValues &r_properties) {
	std::optional<PropertyValue> value = to_property(*p_extras.find(p_key));
	const int64_t *flag = value ? std::get_if<int64_t>(&*value) : nullptr;
	if (flag && p_info.type == PropertyType::BOOL && (*flag == 0 || *flag == 1)) {
		value = *flag == 1; // Blender writes flags as 0 and 1
	}
	if (value && p_factor != 1.0) {
		const int64_t *integer = std::get_if<int64_t>(&*value);
		const double *number = std::get_if<double>(&*value);
		if (integer || number) {
			value = p_factor * (integer ? static_cast<double>(*integer) : *number);
		}
	}
	if (!value || !check_property(p_info, *value).empty()) {
		std::string range = describe_range(p_info);
		if (p_factor != 1.0) {
			range += text(" after multiplication by ", p_factor);
		}
		p_extras.report_value(p_key, range, format_property(p_info.default_value));
		return;
	}
	r_properties[p_info.name] = convert_property(p_info, *value);
}

/// Reads a property of Light3D from the first object that has it, under its own name or an alias.
void read_declared_property(const PropertyInfo &p_info, const std::vector<GltfObject> &p_extras,
		PropertyValues &r_properties) {
	for (const GltfObject &extras : p_extras) {
		if (extras.find(p_info.name)) {
			read_property(extras, p_info.name, p_info, 1.0, r_properties);
			return;
		}
		for (const PropertyAlias &alias : ALIASES) {
			if (alias.property == p_info.name && extras.find(alias.alias)) {
				read_property(extras, alias.alias, p_info, alias.factor, r_properties);
				return;
			}
		}
	}
}

/// Returns whether a key of the extras has another meaning than a property of a technique.
bool is_reserved(std::string_view p_key) {
	if (Light3D::get_property_list().find(p_key)) {
		return true;
	}
	for (const PropertyAlias &alias : ALIASES) {
		if (alias.alias == p_key) {
			return true;
		}
	}
	return std::find(std::begin(MESH_SETTING_NAMES), std::end(MESH_SETTING_NAMES), p_key) !=
			std::end(MESH_SETTING_NAMES);
}

void read_technique_properties(const std::vector<GltfObject> &p_extras,
		const GltfLoadOptions &p_options, PropertyValues &r_properties) {
	std::set<std::string, std::less<>> seen; // an invalid value also hides later ones
	for (const GltfObject &extras : p_extras) {
		for (auto item = extras.get_json().begin(); item != extras.get_json().end(); ++item) {
			const std::string &key = item.key();
			if (item->is_null() || is_reserved(key) || !seen.insert(key).second) {
				continue;
			}
			const PropertyInfo *info = p_options.find_technique_property
					? p_options.find_technique_property(key)
					: nullptr;
			if (info) {
				read_property(extras, key, *info, 1.0, r_properties);
			} else if (std::optional<PropertyValue> value = to_property(*item)) {
				r_properties[key] = std::move(*value);
			}
		}
	}
}

/// Reads the size of a disk of EXT_lights_area, which is its diameter in metres. Returns true if
/// the area light determines the light's size, even if the size is invalid.
bool read_area_size(const GltfObject &p_area, PropertyValues &r_properties) {
	if (p_area.get_text("type") != "disk") {
		p_area.get_messages().warn("area shape", p_area.get_member_path("type"),
				"is not \"disk\"; only discs give a light its size.");
		return false;
	}
	const PropertyInfo &info = *Light3D::get_property_list().find("light_size");
	const Json *size = p_area.find("size");
	// Absent: the extension's default, 1 m. Not a number: NAN, which check_property refuses.
	const double diameter_m = !size ? 1.0 : size->is_number() ? size->get<double>() : NAN;
	if (!check_property(info, diameter_m / 2).empty()) {
		p_area.report_value("size", "a diameter whose half is in " + describe_range(info),
				"the default of light_size");
		return true;
	}
	r_properties["light_size"] = diameter_m / 2;
	return true;
}

void read_cones(const tinygltf::SpotLight &p_spot, Light3D &r_light) {
	r_light.outer_cone_rad = std::min(static_cast<float>(p_spot.outerConeAngle), MAX_CONE_RAD);
	// Files with a hard edge set both angles to the same value, although the extension requires a
	// smaller inner angle.
	r_light.inner_cone_rad = std::min(static_cast<float>(p_spot.innerConeAngle),
			std::nextafter(r_light.outer_cone_rad, 0.0f));
}

void check_finite(const Light3D &p_light, const char *p_quantity, double p_value) {
	if (!std::isfinite(p_value)) {
		fail("Light \"", p_light.name, "\": ", p_quantity,
				" is not finite, which a file cannot store. Set it to a number.");
	}
}

void check_light(const Light3D &p_light) {
	// A sum is finite only if all its terms are.
	check_finite(p_light, "color", p_light.color.x + p_light.color.y + p_light.color.z);
	check_finite(p_light, "intensity", p_light.intensity);
	check_finite(p_light, "range", p_light.range_m);
	check_finite(p_light, "cone angle", p_light.inner_cone_rad + p_light.outer_cone_rad);
	for (const auto &[name, value] : p_light.properties) {
		if (const double *number = std::get_if<double>(&value)) {
			check_finite(p_light, name.c_str(), *number);
		}
	}
}

void write_punctual(
		const Light3D &p_light, const LightSettings *p_before, tinygltf::Light &r_light) {
	if (!p_before || p_light.type != p_before->type) {
		r_light.type = p_light.type == LightType::OMNI ? "point"
				: p_light.type == LightType::SPOT	   ? "spot"
													   : "directional";
	}
	if (!p_before || p_light.color != p_before->color) {
		const glm::vec3 &color = p_light.color;
		r_light.color = { to_shortest_decimal(color.x), to_shortest_decimal(color.y),
			to_shortest_decimal(color.z) };
	}
	if (!p_before || p_light.intensity != p_before->intensity) {
		r_light.intensity = to_shortest_decimal(p_light.intensity);
	}
	if (!p_before || p_light.range_m != p_before->range_m) {
		// 0: unlimited; tinygltf then writes no range.
		r_light.range = p_light.range_m > 0 ? to_shortest_decimal(p_light.range_m) : 0.0;
	}
	const bool has_same_cones = p_before && p_light.type == p_before->type &&
			p_light.inner_cone_rad == p_before->inner_cone_rad &&
			p_light.outer_cone_rad == p_before->outer_cone_rad;
	if (p_light.type == LightType::SPOT && !has_same_cones) {
		r_light.spot.innerConeAngle = to_shortest_decimal(p_light.inner_cone_rad);
		r_light.spot.outerConeAngle = to_shortest_decimal(p_light.outer_cone_rad);
	}
}

void erase_property(Value &r_extras, const std::string &p_name) {
	if (!r_extras.IsObject()) {
		return;
	}
	Value::Object &members = r_extras.Get<Value::Object>();
	members.erase(p_name);
	for (const PropertyAlias &alias : ALIASES) {
		if (alias.property == p_name) {
			members.erase(std::string(alias.alias));
		}
	}
}

void set_property(Value &r_extras, const std::string &p_name, const PropertyValue &p_value) {
	Value::Object &members = require_extras(r_extras);
	members[p_name] = to_value(property_to_json<Json>(p_value));
	// Also updates the aliases, so that programs that know only those do not read the old value.
	for (const PropertyAlias &alias : ALIASES) {
		const double *number = std::get_if<double>(&p_value);
		const auto other = members.find(std::string(alias.alias));
		if (alias.property == p_name && number && other != members.end()) {
			other->second = Value(*number / alias.factor);
		}
	}
}

} // namespace

bool read_light(const tinygltf::Model &p_model, const GltfLightSources &p_sources,
		const GltfLoadOptions &p_options, GltfMessages &r_messages, Light3D &r_light) {
	const tinygltf::Light &light = p_model.lights[p_sources.light_index];
	if (light.type.empty()) { // GltfChecker::check_light empties an unknown type
		return false;
	}
	r_light.type = light.type == "point" ? LightType::OMNI
			: light.type == "spot"		 ? LightType::SPOT
										 : LightType::DIRECTIONAL;
	if (!light.color.empty()) {
		r_light.color = glm::vec3(light.color[0], light.color[1], light.color[2]);
	}
	r_light.intensity = static_cast<float>(light.intensity);
	r_light.range_m = static_cast<float>(light.range);
	if (r_light.type == LightType::SPOT) {
		read_cones(light.spot, r_light);
	}
	r_light.file_path = text("lights[", p_sources.light_index, "]");

	std::vector<GltfObject> all_extras;
	const auto add_extras = [&](const Value &p_extras, const std::string &p_path) {
		if (const auto extras = find_object(p_extras, p_path + ".extras", r_messages)) {
			all_extras.push_back(*extras);
		}
	};
	add_extras(light.extras, text("extensions.", GLTF_PUNCTUAL, ".", r_light.file_path));
	for (const size_t node : p_sources.nodes) {
		add_extras(p_model.nodes[node].extras, text("nodes[", node, "]"));
	}
	const bool has_area_size =
			p_sources.area && read_area_size(*p_sources.area, r_light.properties);
	for (const PropertyInfo &info : Light3D::get_property_list().get_properties()) {
		if (!(has_area_size && info.name == "light_size")) {
			read_declared_property(info, all_extras, r_light.properties);
		}
	}
	read_technique_properties(all_extras, p_options, r_light.properties);
	return true;
}

void write_light(const Light3D &p_light, const LightSettings *p_before, tinygltf::Light &r_light,
		const std::vector<tinygltf::Node *> &p_nodes, Value *r_area) {
	check_light(p_light);
	write_punctual(p_light, p_before, r_light);
	const PropertyValues nothing;
	const PropertyValues &before = p_before ? p_before->properties : nothing;
	for (const auto &[name, value] : before) {
		if (!p_light.properties.contains(name)) {
			erase_property(r_light.extras, name);
			for (tinygltf::Node *node : p_nodes) {
				erase_property(node->extras, name);
			}
		}
	}
	for (const auto &[name, value] : p_light.properties) {
		const auto found = before.find(name);
		if (found == before.end() || found->second != value) {
			set_property(r_light.extras, name, value);
		}
	}
	if (r_area) {
		const PropertyList &list = Light3D::get_property_list();
		require_object(*r_area)["size"] =
				Value(2 * get_float(list, p_light.properties, "light_size"));
	}
}

} // namespace gnomon
