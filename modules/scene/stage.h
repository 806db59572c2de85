#pragma once

#include "modules/scene/nodes.h"

#include <string>

namespace gnomon {

/// What a scene gets that a file lacks: AUTO what is missing, ON all of it in front of what there
/// is, OFF nothing.
enum class StageMode { AUTO, ON, OFF };
/// "auto", "on" or "off"; another text is nothing of these: an Error that begins with p_object.
StageMode parse_stage_mode(const std::string &p_text, const std::string &p_object);
const char *get_stage_mode_name(StageMode p_mode);

/// Most models have neither camera nor light nor ground. Adds a perspective camera that frames the
/// meshes, and the shadow of a light that is added too; a spot light whose radius is a tenth of the
/// meshes' diagonal; and, with the light, a ground below them that casts no shadow. The nodes are
/// marked Node3D::is_staged and come first. Returns one line that lists what was added; empty where
/// nothing was, as of a scene without triangles. p_aspect: the image's width over its height; one
/// that is wider than high is framed as a square.
std::string stage_scene(Scene &r_scene, StageMode p_mode, double p_aspect = 1.0);

} // namespace gnomon
