#include "modules/gltf_scene/gltf_light_writer.h"

#include "modules/core/error.h"
#include "modules/core/property_json.h"
#include "modules/gltf_scene/gltf_lights.h"

#include <charconv>
#include <cmath>

namespace gnomon {

namespace {

void check_finite(const Light3D &p_light, const char *p_what, double p_value) {
	if (!std::isfinite(p_value)) {
		fail("Light \"", p_light.name, "\": ", p_what,
				" is not finite, and no file can hold that. Set it to a number.");
	}
}

void check_light(const Light3D &p_light) {
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
	if (!p_before || p_light.type != p_before->type) {
		r_light["type"] = p_light.type == LightType::OMNI ? "point"
				: p_light.type == LightType::SPOT		  ? "spot"
														  : "directional";
	}
	if (!p_before || p_light.color != p_before->color) {
		r_light["color"] = Json::array({ to_json_number(p_light.color.x),
				to_json_number(p_light.color.y), to_json_number(p_light.color.z) });
	}
	if (!p_before || p_light.intensity != p_before->intensity) {
		r_light["intensity"] = to_json_number(p_light.intensity);
	}
	if (!p_before || p_light.range_m != p_before->range_m) {
		r_light.erase("range");
		if (p_light.range_m > 0) {
			r_light["range"] = to_json_number(p_light.range_m);
		}
	}
	const bool has_same_cones = p_before && p_light.type == p_before->type &&
			p_light.inner_cone_rad == p_before->inner_cone_rad &&
			p_light.outer_cone_rad == p_before->outer_cone_rad;
	if (p_light.type == LightType::SPOT && !has_same_cones) {
		Json &spot = r_light["spot"];
		if (!spot.is_object()) {
			spot = Json::object();
		}
		spot["innerConeAngle"] = to_json_number(p_light.inner_cone_rad);
		spot["outerConeAngle"] = to_json_number(p_light.outer_cone_rad);
	}
}

void erase_property(Json &r_object, const std::string &p_name) {
	const auto extras = r_object.find("extras");
	if (extras == r_object.end() || !extras->is_object()) {
		return;
	}
	extras->erase(p_name);
	for (const GltfPropertyAlias &alias : get_gltf_property_aliases()) {
		if (alias.property == p_name) {
			extras->erase(std::string(alias.alias));
		}
	}
}

void set_property(Json &r_light, const std::string &p_name, const PropertyValue &p_value) {
	Json &extras = require_extras(r_light);
	extras[p_name] = property_to_json<Json>(p_value);
	// Programs that know only the other name must not read the old value.
	for (const GltfPropertyAlias &alias : get_gltf_property_aliases()) {
		const double *number = std::get_if<double>(&p_value);
		if (alias.property == p_name && number && extras.contains(alias.alias)) {
			extras[std::string(alias.alias)] = *number / alias.factor;
		}
	}
}

} // namespace

Json to_json_number(float p_value) {
	char digits[32];
	const auto written = std::to_chars(digits, digits + sizeof(digits), p_value);
	double number = 0;
	std::from_chars(digits, written.ptr, number);
	return number;
}

Json &require_extras(Json &r_object) {
	Json &extras = r_object["extras"];
	if (!extras.is_object()) {
		// Extras may be any value; what was there moves one level down.
		Json before = std::move(extras);
		extras = Json::object();
		if (!before.is_null()) {
			extras["extras"] = std::move(before);
		}
	}
	return extras;
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
		const PropertyList &list = Light3D::get_property_list();
		(*r_area)["size"] = 2 * get_float(list, p_light.properties, "light_size");
	}
}

} // namespace gnomon
