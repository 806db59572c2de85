#include "modules/shadow_edge_count/source_parts.h"

#include "modules/mesh_tools/face_sets.h"
#include "modules/scene/triangle_clip.h"

#include <algorithm>
#include <map>
#include <utility>

namespace gnomon {

SourceParts find_source_parts(const Mesh &p_mesh) {
	const float WIDENING = 1.00001f; // for rounding
	const uint32_t triangle_count = p_mesh.get_triangle_count();
	const auto get_position = [&](uint32_t p_triangle, uint32_t p_corner) {
		return p_mesh.positions_node[p_mesh.indices[3 * size_t(p_triangle) + p_corner % 3]];
	};
	FaceSets sets(triangle_count);
	std::map<std::pair<PositionBits, PositionBits>, uint32_t> first_triangles; // of each edge
	for (uint32_t triangle = 0; triangle < triangle_count; ++triangle) {
		for (uint32_t corner = 0; corner < 3; ++corner) {
			std::pair ends(to_position_bits(get_position(triangle, corner)),
					to_position_bits(get_position(triangle, corner + 1)));
			if (ends.second < ends.first) {
				std::swap(ends.first, ends.second);
			}
			sets.join(triangle, first_triangles.try_emplace(ends, triangle).first->second);
		}
	}
	SourceParts parts;
	std::vector<Bounds> bounds(sets.assign_indices(parts.part_of_triangle));
	for (uint32_t triangle = 0; triangle < triangle_count; ++triangle) {
		for (uint32_t corner = 0; corner < 3; ++corner) {
			bounds[parts.part_of_triangle[triangle]].add(get_position(triangle, corner));
		}
	}
	for (const Bounds &part : bounds) {
		parts.spheres.emplace_back(0.5 * (part.minimum + part.maximum), 0.0);
	}
	for (uint32_t triangle = 0; triangle < triangle_count; ++triangle) {
		glm::vec4 &sphere = parts.spheres[parts.part_of_triangle[triangle]];
		for (uint32_t corner = 0; corner < 3; ++corner) {
			sphere.w = std::max(sphere.w,
					WIDENING * glm::distance(glm::vec3(sphere), get_position(triangle, corner)));
		}
	}
	return parts;
}

} // namespace gnomon
