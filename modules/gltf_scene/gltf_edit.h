#pragma once

#include "modules/gltf_scene/gltf_json.h"

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace gnomon {

// Helpers that change the JSON of a document in place. Members that exist keep their position. A
// member that is added to an object invalidates all references into that object's members.

/// Returns a member as an object. Any other value is replaced by an empty object.
Json &require_object(Json &r_parent, const char *p_key);
/// Returns the `extras` of an element, which may be of any type. A value that is not an object
/// becomes the member "extras" of a new object.
Json &require_extras(Json &r_element);
/// Returns an extension of an element as an object, and adds its name to the `extensionsUsed` of
/// r_root, the document.
Json &require_extension(Json &r_root, Json &r_element, const char *p_name);
/// Removes a member of r_parent[p_key], and r_parent[p_key] if that leaves it empty.
void erase_member(Json &r_parent, const char *p_key, const std::string &p_member);
/// Appends an element to a list, which may be missing. Returns its index.
size_t append_element(Json &r_parent, const char *p_list, Json p_element);

/// Writes a list of indices unless the file has the same. An empty list is removed.
void write_indices(Json &r_object, const char *p_key, const std::vector<size_t> &p_indices);
/// Writes numbers with the fewest digits that read back as these floats. A number that is the same
/// float as the one in the file keeps its digits.
void write_float(Json &r_object, const char *p_key, float p_value);
void write_floats(Json &r_object, const char *p_key, const std::vector<float> &p_values);
void write_color(Json &r_object, const char *p_key, const glm::vec3 &p_color);

} // namespace gnomon
