#pragma once

#include "modules/gltf_scene/gltf_json.h"

#include <tiny_gltf.h>

#include <optional>
#include <string>

namespace gnomon {

/// tinygltf's values, which hold extras and extensions, as JSON and back. It knows neither null nor
/// whole numbers of more than 32 bits; those become fractions.
Json to_json(const tinygltf::Value &p_value);
tinygltf::Value to_value(const Json &p_json);

/// An object among extras or extensions, for checked access; nothing where the value is none.
std::optional<GltfObject> find_object(
		const tinygltf::Value &p_value, std::string p_path, GltfMessages &p_messages);
/// An extension of an element, or null.
const tinygltf::Value *find_extension(
		const tinygltf::ExtensionMap &p_extensions, const char *p_name);
/// A number of an object, or the default.
double get_number(const tinygltf::Value &p_object, const char *p_key, double p_default);

/// The value's members; made an object if it was none.
tinygltf::Value::Object &require_object(tinygltf::Value &r_value);
/// The members of `extras`, which may be any value: what was there moves one level down.
tinygltf::Value::Object &require_extras(tinygltf::Value &r_extras);
/// Names an extension in a document's `extensionsUsed`, once.
void declare_extension(tinygltf::Model &r_model, const std::string &p_name);

} // namespace gnomon
