#pragma once

#include "modules/scene/nodes.h"

#include <memory>
#include <string>
#include <utility>

namespace gnomon {

/// Adds a node of type T to a parent and returns it.
template <typename T> T *add_child(Node3D &p_parent, const std::string &p_name) {
	auto node = std::make_unique<T>();
	node->name = p_name;
	return static_cast<T *>(p_parent.add_child(std::move(node)));
}

} // namespace gnomon
