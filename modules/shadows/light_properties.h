#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"

#include <string>
#include <string_view>
#include <vector>

// Light properties that techniques and mask filters declare, in addition to those of every light.

namespace gnomon {

/// A NodePropertySource. For a light it makes shadow_technique an enum of the registered
/// techniques, without examples (ShadowTechniqueInfo::is_example) other than the light's own, and
/// adds the properties of the light's technique and those of all mask filters.
void add_light_properties(const Node3D &p_node, PropertyList &r_list);

/// Returns the property of that name that a technique or filter declares, or null.
const PropertyInfo *find_added_light_property(std::string_view p_name);
/// Returns the property of that name that techniques or filters no longer use, or null.
const RemovedProperty *find_removed_light_property(std::string_view p_name);
/// The names of all light properties that techniques and filters declare.
std::vector<std::string> list_added_light_properties();

/// Returns a value for each property in p_list, that of one technique or filter: the light's own
/// value, or the default. A stored value of the wrong type or out of range is logged once per light
/// and value, and the default is used; removed properties are logged once.
PropertyValues resolve_light_properties(const LightSnapshot &p_light, const PropertyList &p_list);

/// Declares that the light property p_id + "_" + p_name, which older files may have, was removed
/// because it is now the setting p_name of the technique p_id.
void add_moved_setting(const std::string &p_id, const std::string &p_name, PropertyList &r_list);

/// Asserts that every name in p_list, that of a technique or filter, begins with p_id + "_", and
/// that every property has a tooltip.
void check_extension_properties(const std::string &p_id, const PropertyList &p_list);

} // namespace gnomon
