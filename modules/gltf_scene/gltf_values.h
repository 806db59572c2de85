#pragma once

#include "modules/gltf_scene/gltf_json.h"

#include <tiny_gltf.h>

#include <optional>
#include <string>

namespace gnomon {

/// Converts tinygltf's values, which store extras and extensions, to JSON and back. tinygltf's
/// integers have 32 bits, so larger ones become doubles. tinygltf does not preserve null.
Json to_json(const tinygltf::Value &p_value);
tinygltf::Value to_value(const Json &p_json);

/// Returns a value of extras or extensions as an object for checked access; nothing if the value is
/// not an object. p_path: its JSON path.
std::optional<GltfObject> find_object(
		const tinygltf::Value &p_value, std::string p_path, GltfMessages &p_messages);
/// Returns an extension of an element, or null.
const tinygltf::Value *find_extension(
		const tinygltf::ExtensionMap &p_extensions, const char *p_name);
/// Returns a number of an object, or the default if it is absent or not a number.
double get_number(const tinygltf::Value &p_object, const char *p_key, double p_default);

/// Returns the value's members. A value that is not an object is replaced by an empty object.
tinygltf::Value::Object &require_object(tinygltf::Value &r_value);
/// Returns the members of `extras`, which may be of any type. A value that is not an object becomes
/// the member "extras" of a new object.
tinygltf::Value::Object &require_extras(tinygltf::Value &r_extras);
/// Adds an extension to a document's `extensionsUsed` unless it is listed already.
void declare_extension(tinygltf::Model &r_model, const std::string &p_name);

} // namespace gnomon
