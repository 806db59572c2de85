#pragma once

#include "modules/shadow_edge_count/count_edges.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// All casters along one ray from the light's centre.
struct LayerFragment {
	double w = 0;
	bool is_away = false;		  // the face is turned away from the light's centre
	bool is_double_sided = false; // counts as one turned away and one turned towards
};

/// Per texel the fragments of all casters at its centre, the receivers' own meshes included, in no
/// order. How many are turned away and nearer to the light than a point says in how many complete
/// solids' shadow it lies.
class LayerMap {
public:
	/// p_half_extent: of the view, x' and y' (tangents or metres). p_size_px: 1..8192 each.
	LayerMap(const CountSpace &p_space, const glm::dvec2 &p_half_extent,
			const glm::uvec2 &p_size_px);

	void add_mesh(const MeshTopology &p_topology, const glm::dmat4 &p_view_from_node);
	/// Marks the texels that a silhouette from the light's centre passes nearer than a rasteriser's
	/// rounding of vertices: what such a texel holds may belong to either side.
	void mark_buried(const std::vector<CountEdge> &p_edges);

	glm::uvec2 get_size_px() const { return size_px; }
	/// Texel coordinates of a point (x', y'); texel i covers [i, i + 1).
	glm::dvec2 to_texels(const glm::dvec2 &p_point) const {
		return (p_point / half_extent * 0.5 + 0.5) * glm::dvec2(size_px);
	}
	glm::dvec2 get_center(const glm::ivec2 &p_texel) const {
		return ((glm::dvec2(p_texel) + 0.5) / glm::dvec2(size_px) * 2.0 - 1.0) * half_extent;
	}
	bool is_inside(const glm::ivec2 &p_texel) const {
		return p_texel.x >= 0 && p_texel.y >= 0 && p_texel.x < int(size_px.x) &&
				p_texel.y < int(size_px.y);
	}
	const std::vector<LayerFragment> &get_fragments(const glm::ivec2 &p_texel) const {
		return fragments[get_index(p_texel)];
	}
	bool is_buried(const glm::ivec2 &p_texel) const { return buried[get_index(p_texel)] != 0; }

private:
	size_t get_index(const glm::ivec2 &p_texel) const {
		return size_t(p_texel.y) * size_px.x + size_t(p_texel.x);
	}
	void add_triangle(
			const glm::dvec3 (&p_corners)[3], const glm::dvec4 &p_plane, bool p_is_double_sided);

	const CountSpace space;
	glm::dvec2 half_extent;
	glm::uvec2 size_px;
	std::vector<std::vector<LayerFragment>> fragments;
	std::vector<uint8_t> buried;
};

} // namespace gnomon
