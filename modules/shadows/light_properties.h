#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"

#include <string>
#include <string_view>
#include <vector>

// What techniques and mask filters add to the properties that every light has.

namespace gnomon {

/// A NodePropertySource: of a light, shadow_technique as a choice of those that are registered, and
/// the properties of the one that it has and of all filters.
void add_light_properties(const Node3D &p_node, PropertyList &r_list);

/// The property of whichever technique or filter declares that name, or null.
const PropertyInfo *find_added_light_property(std::string_view p_name);
/// What they once declared and nothing reads any more, or null.
const RemovedProperty *find_removed_light_property(std::string_view p_name);
/// The names of all of them.
std::vector<std::string> list_added_light_properties();

/// The properties of one technique or filter that the light has, with defaults filled in. A stored
/// value that is out of range is logged once per light and value, and its default is used; a
/// removed property is logged once per file.
PropertyValues resolve_light_properties(const LightSnapshot &p_light, const PropertyList &p_list);

/// A property of lights, ID_NAME, that is the setting NAME of the technique now: files may hold it.
void add_moved_setting(const std::string &p_id, const std::string &p_name, PropertyList &r_list);

/// Names that do not begin with the id, or a property without a tooltip, are programming errors.
void check_own_properties(const std::string &p_id, const PropertyList &p_list);

} // namespace gnomon
