#include "modules/scene/node_properties.h"

#include "modules/core/error.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

std::vector<NodePropertySource> &get_sources() {
	static std::vector<NodePropertySource> sources;
	return sources;
}

const NodeField *find_field(const Node3D &p_node, std::string_view p_name) {
	for (const NodeField &field : p_node.get_fields()) {
		if (field.info.name == p_name) {
			return &field;
		}
	}
	return nullptr;
}

PropertyList list_stored_properties(const Node3D &p_node) {
	PropertyList list;
	p_node.add_stored_properties(list);
	for (const NodePropertySource source : get_sources()) {
		source(p_node, list);
	}
	return list;
}

/// Returns the stored properties of a node; an empty list if it has none.
const PropertyValues &get_stored(const Node3D &p_node) {
	static const PropertyValues none;
	const PropertyValues *stored = p_node.find_stored_properties();
	return stored != nullptr ? *stored : none;
}

/// Compares values with a tolerance: members are floats, and their defaults in double differ a
/// little.
bool is_close(const PropertyValue &p_left, const PropertyValue &p_right) {
	const double TOLERANCE = 1e-6; // relative; rounding to float is up to 6e-8
	const double *left = std::get_if<double>(&p_left);
	const double *right = std::get_if<double>(&p_right);
	if (left != nullptr && right != nullptr) {
		return std::abs(*left - *right) <= TOLERANCE * std::max(std::abs(*left), std::abs(*right));
	}
	const glm::dvec3 *left_vector = std::get_if<glm::dvec3>(&p_left);
	const glm::dvec3 *right_vector = std::get_if<glm::dvec3>(&p_right);
	if (left_vector != nullptr && right_vector != nullptr) {
		return glm::length(*left_vector - *right_vector) <= TOLERANCE * glm::length(*left_vector);
	}
	return p_left == p_right;
}

[[noreturn]] void fail_unknown(const Node3D &p_node, std::string_view p_name) {
	std::string names;
	const PropertyList list = list_node_properties(p_node);
	for (const PropertyInfo &info : list.get_properties()) {
		names += (names.empty() ? "" : ", ") + info.name;
	}
	fail(p_node.get_class_name(), " \"", p_node.name, "\": it has no property \"", p_name,
			"\". It has: ", names, ".");
}

} // namespace

void add_node_property_source(NodePropertySource p_source) {
	get_sources().push_back(p_source);
}

void remove_node_property_source(NodePropertySource p_source) {
	std::erase(get_sources(), p_source);
}

PropertyList list_node_properties(const Node3D &p_node) {
	PropertyList list;
	for (const NodeField &field : p_node.get_fields()) {
		if (!field.applies || field.applies(p_node)) {
			list.add(field.info);
		}
	}
	const PropertyList stored = list_stored_properties(p_node);
	for (const PropertyInfo &info : stored.get_properties()) {
		list.add(info);
	}
	return list;
}

PropertyValue get_node_property(const Node3D &p_node, std::string_view p_name) {
	if (const NodeField *field = find_field(p_node, p_name)) {
		return field->read(p_node);
	}
	const PropertyList list = list_stored_properties(p_node);
	const PropertyInfo *info = list.find(p_name);
	if (!info) {
		fail_unknown(p_node, p_name);
	}
	// A file may contain any type of value under a name that was undeclared when it was read.
	const auto stored = get_stored(p_node).find(p_name);
	const bool is_used =
			stored != get_stored(p_node).end() && check_property(*info, stored->second).empty();
	return is_used ? convert_property(*info, stored->second) : info->default_value;
}

bool is_node_property_set(const Node3D &p_node, std::string_view p_name) {
	if (const NodeField *field = find_field(p_node, p_name)) {
		return !is_close(field->read(p_node), field->info.default_value);
	}
	return get_stored(p_node).contains(p_name);
}

void set_node_property(
		Node3D &r_node, std::string_view p_name, const std::optional<PropertyValue> &p_value) {
	const NodeField *field = find_field(r_node, p_name);
	const PropertyList list = field ? PropertyList() : list_stored_properties(r_node);
	const PropertyInfo *info = field ? &field->info : list.find(p_name);
	if (!info) {
		fail_unknown(r_node, p_name);
	}
	const PropertyValue &value = p_value ? *p_value : info->default_value;
	const std::string refusal = check_property(*info, value);
	if (!refusal.empty()) {
		fail(r_node.get_class_name(), " \"", r_node.name, "\": ", p_name, " ", refusal, ".");
	}
	PropertyValues *stored = r_node.get_stored_properties();
	if (field) {
		field->write(r_node, convert_property(*info, value));
	} else if (p_value) {
		stored->insert_or_assign(std::string(p_name), convert_property(*info, value));
	} else {
		stored->erase(std::string(p_name));
	}
}

} // namespace gnomon
