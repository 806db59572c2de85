#pragma once

#include "modules/shadow_edge_count/count_mesh.h"
#include "modules/shadows/shadow_technique.h"

#include <vector>

namespace gnomon {

/// One caster of a light.
struct CountCaster {
	const CountGpuMesh *gpu = nullptr; // lives as long as the mesh, which the scene owns
	BufferRID positions;			   // same lifetime; vec4 per welded vertex
	uint64_t mesh_id = 0;
	uint64_t pose_hash = 0;
	shader::CountCasterPush push;
	/// Its transform in light space, or its pose, changed after the light's faces and edges were
	/// last found.
	bool is_moved = true;
};

/// The casters of all views of a light, each once, and how much room their faces and edges need.
struct CountCasters {
	std::vector<CountCaster> casters;
	uint32_t face_count = 0;
	uint32_t edge_count = 0;
	uint32_t word_count = 0;
	uint32_t block_count = 0;
	uint32_t flat_instance_count = 0; // with a singular transform: they hide nothing
	/// Upper bound of the nodes in the face lists of one view. UNKNOWN_COUNT when there are too
	/// many faces to examine each, or when some are deformed.
	uint64_t node_bound = 0;
	bool may_cut_disc = false; // a caster's bounds come within R of the light's centre
	uint32_t empty_views = 0;  // bit i: no caster of view i has a face

	static constexpr uint64_t UNKNOWN_COUNT = ~uint64_t(0);

	/// True when both have the same meshes in the same order, so that face indices stay valid.
	bool has_layout_of(const CountCasters &p_other) const;
};

/// Throws an Error when there are more faces or edges than a 24-bit index can name. p_disc_radius:
/// R in metres; directional: a tangent.
CountCasters build_count_casters(const ShadowTechnique::Inputs &p_inputs, double p_disc_radius);

/// Clears CountCaster::is_moved of casters with the same transform and pose as in p_before: earlier
/// casters of the same light, with the same layout.
void compare_casters(const CountCasters &p_before, CountCasters &r_casters);

} // namespace gnomon
