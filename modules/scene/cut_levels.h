#pragma once

#include "modules/scene/material.h"
#include "modules/scene/mesh.h"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>

namespace gnomon {

/// A cut mesh with outlines of several tolerances: under a wide penumbra a coarser one, which has
/// fewer edges, casts the same shadow. All keep the area of each hole.
class CutLevels {
public:
	/// How far an outline may be from the contour, in texels, from finest to coarsest.
	static constexpr std::array<double, 6> TOLERANCES_PX = { 0.03125, 0.0625, 0.125, 0.25, 0.5,
		1.0 };
	static constexpr uint32_t BASE = 2; // that of CutMesh::mesh

	/// p_cut: what cut_mesh made of the mesh.
	CutLevels(const std::shared_ptr<const Mesh> &p_mesh, const Material &p_material,
			const std::shared_ptr<const Mesh> &p_cut);

	/// The coarsest level that suits penumbrae up to p_radius, half as wide: in metres of the
	/// node's space, on the mesh. The finest where none does; BASE where there is no penumbra.
	uint32_t choose_level(double p_radius) const;
	/// Made on first use, from any thread; null where nothing is left, or the mesh is gone.
	std::shared_ptr<const Mesh> get_mesh(uint32_t p_level) const;

private:
	std::weak_ptr<const Mesh> source;
	std::weak_ptr<const Mesh> base; // whoever has the levels has it too
	Material material;
	double texel_size = 0; // the longest on the mesh, in metres of the node's space
	struct Level {
		std::shared_ptr<const Mesh> mesh;
		bool is_made = false;
	};
	mutable std::mutex mutex;
	mutable std::array<Level, TOLERANCES_PX.size()> levels;
};

} // namespace gnomon
