#pragma once

#include "modules/scene/material.h"
#include "modules/scene/mesh.h"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

namespace gnomon {

/// Levels of detail of a cut mesh: outlines simplified with several tolerances. Under a wide
/// penumbra a coarser outline with fewer edges casts the same shadow. All levels preserve the area
/// of each hole as far as their tolerance allows.
class CutLevels {
public:
	/// Requested tolerance of the outline's simplification (simplify_loops), in texels, from finest
	/// to coarsest. An outline above the edge budget gets a larger one.
	static constexpr std::array<double, 8> TOLERANCES_PX = { 0.03125, 0.0625, 0.125, 0.25, 0.5, 1.0,
		2.0, 4.0 };
	static constexpr uint32_t BASE_LEVEL = 2; // the level of CutMesh::mesh

	/// p_cut: what cut_mesh makes of the mesh with the default tolerance.
	CutLevels(const std::shared_ptr<const Mesh> &p_mesh, const Material &p_material,
			const std::shared_ptr<const Mesh> &p_cut);

	/// Returns the coarsest level whose outline error is negligible. p_half_width: half the width
	/// of the widest penumbra, measured at the caster, in metres of the node's space. Returns the
	/// finest level if none qualifies, and BASE_LEVEL for a hard shadow (p_half_width <= 0).
	uint32_t choose_level(double p_half_width) const;
	/// Returns a coarser level than p_level for the receivers that see a wide penumbra
	/// (get_min_half_width), for techniques that can choose a level for each receiver. p_half_width
	/// as for choose_level. Returns p_level if none is worth it.
	uint32_t choose_coarse_level(uint32_t p_level, double p_half_width) const;
	/// Returns half the width of a receiver's own penumbra from which the error of a coarse level
	/// is negligible, measured at the caster, in metres of the node's space.
	double get_min_half_width(uint32_t p_level) const;
	/// Returns a level's mesh, built on first use, from any thread. Null if nothing of the mesh is
	/// left, or if the source mesh was freed.
	std::shared_ptr<const Mesh> get_mesh(uint32_t p_level) const;
	/// Returns the level that has this mesh, or nothing.
	std::optional<uint32_t> find_level(const Mesh *p_mesh) const;

private:
	std::weak_ptr<const Mesh> source;
	/// A weak pointer: the owner of the levels owns the base mesh too.
	std::weak_ptr<const Mesh> base;
	Material material;
	/// Largest extent of a texel on the mesh, node-space metres; doubled where the texture repeats
	/// within a triangle.
	double texel_size = 0;
	struct Level {
		std::shared_ptr<const Mesh> mesh;
		bool is_built = false;
	};
	mutable std::mutex mutex;
	mutable std::array<Level, TOLERANCES_PX.size()> levels;
};

} // namespace gnomon
