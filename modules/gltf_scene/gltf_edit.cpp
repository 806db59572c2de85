#include "modules/gltf_scene/gltf_edit.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

namespace gnomon {

namespace {

/// Returns p_before if it is the same float, which keeps its digits; otherwise p_value with the
/// fewest digits.
Json make_number(const Json &p_before, float p_value) {
	const double before = p_before.is_number() ? p_before.get<double>() : NAN;
	const bool is_same = std::abs(before) <= FLT_MAX && static_cast<float>(before) == p_value;
	return is_same ? p_before : Json(to_shortest_decimal(p_value));
}

} // namespace

Json &require_object(Json &r_parent, const char *p_key) {
	Json &value = r_parent[p_key];
	if (!value.is_object()) {
		value = Json::object();
	}
	return value;
}

Json &require_extras(Json &r_element) {
	Json &extras = r_element["extras"];
	if (!extras.is_null() && !extras.is_object()) {
		Json members = Json::object();
		members["extras"] = std::move(extras);
		extras = std::move(members);
	}
	return require_object(r_element, "extras");
}

Json &require_extension(Json &r_root, Json &r_element, const char *p_name) {
	Json &used = r_root["extensionsUsed"];
	if (!used.is_array()) {
		used = Json::array();
	}
	if (std::find(used.begin(), used.end(), p_name) == used.end()) {
		used.push_back(p_name);
	}
	return require_object(require_object(r_element, "extensions"), p_name);
}

void erase_member(Json &r_parent, const char *p_key, const std::string &p_member) {
	const auto object = r_parent.find(p_key);
	if (object != r_parent.end() && object->is_object() && object->erase(p_member) > 0 &&
			object->empty()) {
		r_parent.erase(p_key);
	}
}

size_t append_element(Json &r_parent, const char *p_list, Json p_element) {
	Json &list = r_parent[p_list];
	list.push_back(std::move(p_element));
	return list.size() - 1;
}

void write_indices(Json &r_object, const char *p_key, const std::vector<size_t> &p_indices) {
	const auto before = r_object.find(p_key);
	if (p_indices.empty()) {
		if (before != r_object.end() && !before->empty()) {
			r_object.erase(p_key);
		}
	} else if (before == r_object.end() || *before != Json(p_indices)) {
		r_object[p_key] = p_indices;
	}
}

void write_float(Json &r_object, const char *p_key, float p_value) {
	r_object[p_key] = make_number(r_object[p_key], p_value);
}

void write_floats(Json &r_object, const char *p_key, const std::vector<float> &p_values) {
	Json &list = r_object[p_key];
	const Json before = std::exchange(list, Json::array());
	for (size_t index = 0; index < p_values.size(); ++index) {
		const bool has_number = before.is_array() && index < before.size();
		list.push_back(make_number(has_number ? before[index] : Json(), p_values[index]));
	}
}

void write_color(Json &r_object, const char *p_key, const glm::vec3 &p_color) {
	write_floats(r_object, p_key, { p_color.x, p_color.y, p_color.z });
}

} // namespace gnomon
