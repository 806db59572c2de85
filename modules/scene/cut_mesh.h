#pragma once

#include "modules/scene/material.h"
#include "modules/scene/mesh.h"
#include "modules/scene/outlined_texture.h"

#include <cstdint>
#include <memory>

namespace gnomon {

class CutLevels;

/// The part of a mesh that casts a shadow: where the alpha test passes.
struct CutMesh {
	/// The source mesh itself if nothing was cut away; null if nothing is left. Otherwise an open
	/// mesh whose triangles are cut along the alpha contour, so that everything that reads
	/// triangles and edges sees the holes. It has no texture coordinates and no colours.
	std::shared_ptr<const Mesh> mesh;
	/// Above 0: the outline of the texture's alpha has more edges than OutlineBudget allows, and
	/// squares replace blocks of this many texels a side, see AlphaOutline.
	uint32_t block_size_px = 0;
	/// Hash of the exact alpha test, which the mesh only approximates; 0 if the material is not cut
	/// out.
	uint64_t content_hash = 0;
	/// Levels of detail. Set by get_cut_mesh if it cut the mesh along a contour; otherwise null.
	std::shared_ptr<const CutLevels> levels;
};

/// Cuts away the parts of a mesh whose alpha is below the cutoff. Alpha is the product of the
/// material's alpha, the alpha of the base colour texture's first mip level, and the mean alpha of
/// the triangle's vertex colours. If that mean is not 1, the threshold for the texture is rounded
/// to a multiple of 1/32. Where the contour crosses a mesh edge, both triangles compute the same
/// point, bit for bit, if their texture coordinates agree there. Computed in double, rounded to
/// float once. p_tolerance_px: see make_alpha_outline.
CutMesh cut_mesh(const std::shared_ptr<const Mesh> &p_mesh, const Material &p_material,
		const OutlineBudget &p_budget = {}, double p_tolerance_px = 0.125);

/// Cuts like cut_mesh, but cached: materials with the same alpha test get one result. If the
/// material is not cut out, it returns the mesh itself. Callable from any thread.
CutMesh get_cut_mesh(const std::shared_ptr<const Mesh> &p_mesh,
		const std::shared_ptr<const Material> &p_material);
/// Sets the budget of meshes that get_cut_mesh cuts from now on, OutlineBudget() by default. For
/// hosts whose scenes need speed more than the last leaf. Callable from any thread.
void set_outline_budget(const OutlineBudget &p_budget);
/// Frees cached cut meshes whose source mesh was freed, and those whose material was freed or
/// changed unless they are in use. Call it once a frame, from any thread.
void drop_unused_cut_meshes();
/// Returns the number of cached cut meshes.
size_t get_cut_mesh_count();

} // namespace gnomon
