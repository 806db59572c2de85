#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"

#include <functional>
#include <optional>
#include <string_view>

// Nodes as an inspector sees them: properties by name, whatever the class.

namespace gnomon {

/// A member of a node's class that is a property.
struct NodeField {
	PropertyInfo info;
	PropertyValue (*read)(const Node3D &p_node) = nullptr;
	/// The value is checked and of the property's type.
	void (*write)(Node3D &r_node, const PropertyValue &p_value) = nullptr;
	/// False: it means nothing to this node now. Null: it always does.
	bool (*applies)(const Node3D &p_node) = nullptr;
};

/// Adds what other modules keep in a node's stored properties, or declares again one that is there.
using NodePropertySource = void (*)(const Node3D &p_node, PropertyList &r_list);
void add_node_property_source(NodePropertySource p_source);
void remove_node_property_source(NodePropertySource p_source);

/// All that apply to the node, in the order in which they are shown.
PropertyList list_node_properties(const Node3D &p_node);
/// The value that is set, else the default. A name that the node lacks is an Error.
PropertyValue get_node_property(const Node3D &p_node, std::string_view p_name);
/// False where it has its default.
bool is_node_property_set(const Node3D &p_node, std::string_view p_name);
/// Checks the value, and converts it. A refused value or an unknown name is an Error that names
/// node, property and range. None: back to the default.
void set_node_property(
		Node3D &r_node, std::string_view p_name, const std::optional<PropertyValue> &p_value);

} // namespace gnomon
