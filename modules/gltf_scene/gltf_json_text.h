#pragma once

#include "modules/gltf_scene/gltf_json.h"

#include <string>

namespace gnomon {

/// Writes a document's JSON after a change. p_text: the text that was read; p_before: its value,
/// an object; p_after: the changed object. The text of every part that did not change stays, with
/// its spaces and number formats; what is new is indented like the rest. Throws a Json::exception
/// if a text in p_after is not UTF-8.
std::string update_json_text(const std::string &p_text, const Json &p_before, const Json &p_after);

} // namespace gnomon
