#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"

#include <functional>
#include <optional>
#include <string_view>

// Access to the properties of nodes by name, whatever their class, for an inspector.

namespace gnomon {

/// A property that is a member of the node's class, in contrast to the stored properties
/// (Node3D::get_stored_properties).
struct NodeField {
	PropertyInfo info;
	PropertyValue (*read)(const Node3D &p_node) = nullptr;
	/// The value must be valid and of the property's type.
	void (*write)(Node3D &r_node, const PropertyValue &p_value) = nullptr;
	/// Returns false if the property has no effect on the node in its current state. Null: it
	/// always has one.
	bool (*applies)(const Node3D &p_node) = nullptr;
};

/// A function that adds to r_list, or redeclares there, properties of another module that a node
/// stores by name.
using NodePropertySource = void (*)(const Node3D &p_node, PropertyList &r_list);
void add_node_property_source(NodePropertySource p_source);
void remove_node_property_source(NodePropertySource p_source);

/// Lists all properties that apply to the node, in display order.
PropertyList list_node_properties(const Node3D &p_node);
/// Returns the value that is set; the default if none is set, or if the set one is invalid. A name
/// that the node lacks is an Error.
PropertyValue get_node_property(const Node3D &p_node, std::string_view p_name);
/// Returns whether the property is set: a member of the class if it differs from its default, a
/// stored property if it has any value, even the default.
bool is_node_property_set(const Node3D &p_node, std::string_view p_name);
/// Checks, converts and sets a value; nullopt resets the property to its default. A refused value
/// is an Error that names node, property and range; an unknown name is an Error that lists the
/// known ones.
void set_node_property(
		Node3D &r_node, std::string_view p_name, const std::optional<PropertyValue> &p_value);

} // namespace gnomon
