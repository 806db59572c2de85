#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"

#include <functional>
#include <optional>
#include <string_view>

// Nodes as an inspector sees them: properties by name, whatever the class.

namespace gnomon {

/// A property that is a member of the node's class.
struct NodeField {
	PropertyInfo info;
	PropertyValue (*read)(const Node3D &p_node) = nullptr;
	/// The value must be valid and of the property's type.
	void (*write)(Node3D &r_node, const PropertyValue &p_value) = nullptr;
	/// Returns false if the property has no effect on the node in its current state. Null: it
	/// always has one.
	bool (*applies)(const Node3D &p_node) = nullptr;
};

/// Adds, or redeclares, properties that other modules keep among a node's stored properties.
using NodePropertySource = void (*)(const Node3D &p_node, PropertyList &r_list);
void add_node_property_source(NodePropertySource p_source);
void remove_node_property_source(NodePropertySource p_source);

/// Lists all properties that apply to the node, in display order.
PropertyList list_node_properties(const Node3D &p_node);
/// The value that is set, else the default. A name that the node lacks is an Error.
PropertyValue get_node_property(const Node3D &p_node, std::string_view p_name);
/// Returns false if the property has its default value.
bool is_node_property_set(const Node3D &p_node, std::string_view p_name);
/// Checks the value, and converts it. A refused value or an unknown name is an Error that names
/// node, property and range. None: back to the default.
void set_node_property(
		Node3D &r_node, std::string_view p_name, const std::optional<PropertyValue> &p_value);

} // namespace gnomon
