#pragma once

#include "modules/core/limits.h"
#include "modules/scene/node_properties.h"

#include <memory>
#include <vector>

// Helpers for the files that declare members of node classes as properties.

namespace gnomon {

/// Casts a node to its class, which the caller knows.
template <typename T> T &to(Node3D &r_node) {
	return static_cast<T &>(r_node);
}
template <typename T> const T &to(const Node3D &p_node) {
	return static_cast<const T &>(p_node);
}

// Functions for NodeField::read and NodeField::write of a member: a bool, a number, or an angle
// that is stored in radians and shown in degrees.

template <typename T, auto MEMBER> PropertyValue read_flag(const Node3D &p_node) {
	return to<T>(p_node).*MEMBER;
}

template <typename T, auto MEMBER> void write_flag(Node3D &r_node, const PropertyValue &p_value) {
	to<T>(r_node).*MEMBER = std::get<bool>(p_value);
}

template <typename T, auto MEMBER> PropertyValue read_number(const Node3D &p_node) {
	return double(to<T>(p_node).*MEMBER);
}

template <typename T, auto MEMBER> void write_number(Node3D &r_node, const PropertyValue &p_value) {
	to<T>(r_node).*MEMBER = float(std::get<double>(p_value));
}

template <typename T, auto MEMBER> PropertyValue read_degrees(const Node3D &p_node) {
	return DEGREES_PER_RADIAN * double(to<T>(p_node).*MEMBER);
}

template <typename T, auto MEMBER>
void write_degrees(Node3D &r_node, const PropertyValue &p_value) {
	to<T>(r_node).*MEMBER = float(std::get<double>(p_value) / DEGREES_PER_RADIAN);
}

inline PropertyInfo make_info(const char *p_name, PropertyType p_type, PropertyValue p_default,
		const char *p_hint, const char *p_tooltip, const char *p_unit, const char *p_group) {
	return { p_name, p_type, std::move(p_default), p_hint, p_tooltip, p_unit, p_group };
}

/// Makes the fields that edit a mesh node's materials.
std::vector<NodeField> make_material_fields();

/// Returns the fields that every node has, followed by p_more.
std::vector<NodeField> extend_node_fields(std::vector<NodeField> p_more);

/// Implements Node3D::copy for class T.
template <typename T> std::unique_ptr<Node3D> copy_as(const Node3D &p_node) {
	auto node = std::make_unique<T>();
	node->assign(p_node);
	return node;
}

} // namespace gnomon
