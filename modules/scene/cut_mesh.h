#pragma once

#include "modules/scene/material.h"
#include "modules/scene/mesh.h"
#include "modules/scene/outlined_texture.h"

#include <cstdint>
#include <memory>

namespace gnomon {

class CutLevels;

/// The part of a mesh that casts its shadow.
struct CutMesh {
	/// The mesh itself where all of it is there; null where nothing is. Else an open mesh: each
	/// triangle cut along the alpha's contour, so that all that reads triangles and edges sees the
	/// holes. It has no coordinates and no colours.
	std::shared_ptr<const Mesh> mesh;
	/// Above 0: the mask has more edges than the budget, and squares represent blocks of so many
	/// texels a side, see AlphaOutline.
	uint32_t block_size_px = 0;
	/// Of the alpha that cut it, which the mesh follows only as closely as its outline does; 0 of
	/// one that is not cut.
	uint64_t content_hash = 0;
	/// Levels of detail, of a mesh that get_cut_mesh cut along the contour; else null.
	std::shared_ptr<const CutLevels> levels;
};

/// Cuts a mesh where its surface is not there: its alpha, that of the material times that of the
/// base colour texture's first level times the mean of the triangle's vertex colours, is below the
/// cutoff. Where the contour crosses an edge of the mesh, both triangles there make the same point,
/// bit for bit, if their coordinates agree. Computed in double, rounded to float once.
/// p_tolerance_px: how far its outline may be from the contour, in texels.
CutMesh cut_mesh(const std::shared_ptr<const Mesh> &p_mesh, const Material &p_material,
		const OutlineBudget &p_budget = {}, double p_tolerance_px = 0.125);

/// As cut_mesh, cached: materials that cut alike share it. For materials that are not cut out the
/// mesh itself. From any thread.
CutMesh get_cut_mesh(const std::shared_ptr<const Mesh> &p_mesh,
		const std::shared_ptr<const Material> &p_material);
/// Frees what get_cut_mesh holds of meshes that are gone, and of materials that are gone or were
/// changed, unless it is in use. Once a frame, from any thread.
void drop_unused_cut_meshes();
/// How many get_cut_mesh holds.
size_t get_cut_mesh_count();

} // namespace gnomon
