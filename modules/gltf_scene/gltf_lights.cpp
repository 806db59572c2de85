#include "modules/gltf_scene/gltf_lights.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/core/property.h"
#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_edit.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace gnomon {

namespace {

const double DEFAULT_OUTER_CONE_RAD = 0.785398163397448; // KHR_lights_punctual: pi / 4
const double MAX_READ_CONE_RAD =
		1.57079632679490 + 1e-6;		// exporters round pi / 2 up as often as down
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

void read_cones(const GltfObject &p_definition, LightSettings &r_light) {
	double outer = DEFAULT_OUTER_CONE_RAD;
	double inner = 0;
	const Json *json = p_definition.find("spot");
	if (json && !json->is_object()) {
		p_definition.report_value("spot", "an object", "the default");
	} else if (json) {
		const GltfObject spot = *p_definition.find_object("spot");
		outer = spot.read_number("outerConeAngle", outer, 0, MAX_READ_CONE_RAD, "rad");
		inner = spot.read_number("innerConeAngle", inner, 0, MAX_READ_CONE_RAD, "rad");
		if (!(outer > 0)) {
			spot.report_value("outerConeAngle", "above 0", text(DEFAULT_OUTER_CONE_RAD));
			outer = DEFAULT_OUTER_CONE_RAD;
			inner = 0;
		} else if (inner > outer) {
			spot.report_value("innerConeAngle", text("at most outerConeAngle, ", outer), "0");
			inner = 0;
		}
	}
	r_light.outer_cone_rad = std::min(static_cast<float>(outer), MAX_CONE_RAD);
	// Files with a hard edge set both angles to the same value, although the extension requires a
	// smaller inner angle.
	r_light.inner_cone_rad =
			std::min(static_cast<float>(inner), std::nextafter(r_light.outer_cone_rad, 0.0f));
}

/// Returns nothing if the type is unknown.
std::optional<LightSettings> read_definition(const GltfObject &p_definition) {
	LightSettings light;
	const std::string type = p_definition.get_text("type");
	const bool is_known = type == "point" || type == "spot" || type == "directional";
	if (!is_known) {
		p_definition.report_value("type", "\"point\", \"spot\" or \"directional\"", "no light");
	}
	light.type = type == "point" ? LightType::OMNI
			: type == "spot"	 ? LightType::SPOT
								 : LightType::DIRECTIONAL;
	p_definition.read_color("color", FLT_MAX, std::span<float, 3>(&light.color.x, 3));
	light.intensity =
			static_cast<float>(p_definition.read_number("intensity", light.intensity, 0, FLT_MAX));
	if (const Json *range = p_definition.find("range")) {
		const double range_m = range->is_number() ? range->get<double>() : NAN;
		if (range_m > 0 && range_m <= FLT_MAX) {
			light.range_m = static_cast<float>(range_m);
		} else {
			p_definition.report_value("range", "a finite number above 0 m", "no limit");
		}
	}
	if (light.type == LightType::SPOT) {
		read_cones(p_definition, light);
	}
	return is_known ? std::optional(light) : std::nullopt;
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

void write_punctual(const Light3D &p_light, const LightSettings *p_before, Json &r_light) {
	const bool has_same_type = p_before && p_light.type == p_before->type;
	if (!has_same_type) {
		r_light["type"] = p_light.type == LightType::OMNI ? "point"
				: p_light.type == LightType::SPOT		  ? "spot"
														  : "directional";
	}
	if (!p_before || p_light.color != p_before->color) {
		write_color(r_light, "color", p_light.color);
	}
	if (!p_before || p_light.intensity != p_before->intensity) {
		write_float(r_light, "intensity", p_light.intensity);
	}
	if (p_light.range_m != (p_before ? p_before->range_m : 0)) {
		if (p_light.range_m > 0) {
			write_float(r_light, "range", p_light.range_m);
		} else {
			r_light.erase("range"); // absent: unlimited
		}
	}
	if (p_light.type != LightType::SPOT) {
		if (!has_same_type) {
			r_light.erase("spot");
		}
	} else if (!has_same_type || p_light.inner_cone_rad != p_before->inner_cone_rad ||
			p_light.outer_cone_rad != p_before->outer_cone_rad) {
		Json &spot = require_object(r_light, "spot");
		write_float(spot, "innerConeAngle", p_light.inner_cone_rad);
		write_float(spot, "outerConeAngle", p_light.outer_cone_rad);
	}
}

void erase_property(Json &r_element, const std::string &p_name) {
	erase_member(r_element, "extras", p_name);
	for (const PropertyAlias &alias : ALIASES) {
		if (alias.property == p_name) {
			erase_member(r_element, "extras", std::string(alias.alias));
		}
	}
}

void set_property(Json &r_light, const std::string &p_name, const PropertyValue &p_value) {
	Json &members = require_extras(r_light);
	members[p_name] = property_to_json<Json>(p_value);
	// Also updates the aliases, so that programs that know only those do not read the old value.
	for (const PropertyAlias &alias : ALIASES) {
		const double *number = std::get_if<double>(&p_value);
		const auto other = members.find(std::string(alias.alias));
		if (alias.property == p_name && number && other != members.end()) {
			*other = *number / alias.factor;
		}
	}
}

} // namespace

std::vector<std::optional<LightSettings>> read_light_definitions(const GltfObject &p_root) {
	std::vector<std::optional<LightSettings>> lights;
	if (const auto punctual = p_root.find_extension(GLTF_PUNCTUAL)) {
		punctual->for_each("lights", [&](const GltfObject &p_definition) {
			lights.push_back(read_definition(p_definition));
		});
	}
	return lights;
}

void read_light_properties(const GltfLightSources &p_sources, const GltfLoadOptions &p_options,
		PropertyValues &r_properties) {
	std::vector<GltfObject> all_extras;
	const auto add_extras = [&](const GltfObject &p_owner) {
		if (const auto extras = p_owner.find_extras()) {
			all_extras.push_back(*extras);
		}
	};
	add_extras(p_sources.definition);
	std::for_each(p_sources.nodes.begin(), p_sources.nodes.end(), add_extras);
	const bool has_area_size = p_sources.area && read_area_size(*p_sources.area, r_properties);
	for (const PropertyInfo &info : Light3D::get_property_list().get_properties()) {
		if (!(has_area_size && info.name == "light_size")) {
			read_declared_property(info, all_extras, r_properties);
		}
	}
	read_technique_properties(all_extras, p_options, r_properties);
}

void write_light(const Light3D &p_light, const LightSettings *p_before, Json &r_light,
		const std::vector<Json *> &p_nodes, Json *r_area) {
	check_light(p_light);
	write_punctual(p_light, p_before, r_light);
	const PropertyValues nothing;
	const PropertyValues &before = p_before ? p_before->properties : nothing;
	for (const auto &[name, value] : before) {
		if (!p_light.properties.contains(name)) {
			erase_property(r_light, name);
			for (Json *node : p_nodes) {
				erase_property(*node, name);
			}
		}
	}
	for (const auto &[name, value] : p_light.properties) {
		const auto found = before.find(name);
		if (found == before.end() || found->second != value) {
			set_property(r_light, name, value);
		}
	}
	if (r_area) {
		(*r_area)["size"] =
				2 * get_float(Light3D::get_property_list(), p_light.properties, "light_size");
	}
}

} // namespace gnomon
