#pragma once

#include "modules/scene/nodes.h"

#include <string>

namespace gnomon {

/// Whether stage_scene adds a camera, and a light with a ground. AUTO: what is missing; ON: all of
/// them, ahead of what exists; OFF: nothing.
enum class StageMode { AUTO, ON, OFF };
/// Parses "auto", "on" or "off"; any other text is an Error that begins with p_object.
StageMode parse_stage_mode(const std::string &p_text, const std::string &p_object);
const char *get_stage_mode_name(StageMode p_mode);

/// Adds what a scene lacks for rendering, because most models have neither camera nor light nor
/// ground: a perspective camera that frames the meshes, and their shadow if a light is added too; a
/// spot light whose radius is a tenth of the diagonal of the meshes' bounds; and, with the light, a
/// ground below the meshes that casts no shadow. The new nodes are marked Node3D::is_staged and
/// come first. Returns one line that lists the additions; empty if there were none, as for a scene
/// without triangles. p_aspect: the image's width divided by its height; above 1 the image's
/// central square is framed.
std::string stage_scene(Scene &r_scene, StageMode p_mode, double p_aspect = 1.0);

} // namespace gnomon
