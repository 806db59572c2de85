#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"

namespace gnomon {

/// A NodePropertySource: of a light, shadow_technique as a choice of those that are registered, and
/// the properties of the one that it has.
void add_light_properties(const Node3D &p_node, PropertyList &r_list);

} // namespace gnomon
