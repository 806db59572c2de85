#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <memory>
#include <string>

namespace gnomon {

/// A caster or receiver of a stability scene.
struct StabilityBody {
	std::string name;
	std::shared_ptr<const Mesh> mesh;
	glm::dmat4 world_from_node = glm::dmat4(1.0);
	bool casts_shadow = true;
};

/// A closed sphere of 320 triangles.
std::shared_ptr<const Mesh> make_globe(double p_radius_m);
/// A closed cube each of whose faces is cut beside one of its edges, so that the strip's triangles
/// have this ratio of length to width; at 1 in the middle.
std::shared_ptr<const Mesh> make_cut_box(double p_half_size_m, double p_aspect_ratio);
/// A closed box whose faces look inwards.
std::shared_ptr<const Mesh> make_turned_box(double p_half_size_m);
/// One leaning triangle without thickness.
std::shared_ptr<const Mesh> make_sheet();
/// Triangles of no area, slivers, faces that lie on each other, and normals of length 0.
std::shared_ptr<const Mesh> make_odd_mesh();

} // namespace gnomon
