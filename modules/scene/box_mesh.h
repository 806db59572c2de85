#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>

namespace gnomon {

/// A closed box about the origin, faces counter-clockwise from outside, normals per face.
std::shared_ptr<const Mesh> make_box_mesh(
		const std::string &p_name, const glm::vec3 &p_half_size_m);

} // namespace gnomon
