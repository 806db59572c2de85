#pragma once

#include "modules/shadow_edge_count/count_mesh.h"
#include "modules/shadows/shadow_technique.h"

#include <vector>

namespace gnomon {

/// One caster of a light.
struct CountCaster {
	const CountGpuMesh *gpu = nullptr; // lives as long as the mesh, which the frame's scene holds
	BufferRID positions;			   // lives as long; vec4 per welded vertex
	uint64_t mesh_id = 0;
	uint64_t pose_hash = 0;
	shader::CountCasterPush push;
	bool is_moved = true; // since the light's faces and edges were found the last time
};

/// The casters of all views of a light, each once, and how much room their faces and edges need.
struct CountCasters {
	std::vector<CountCaster> casters;
	uint32_t face_count = 0;
	uint32_t edge_count = 0;
	uint32_t word_count = 0;
	uint32_t block_count = 0;
	uint32_t flat_instance_count = 0; // with a singular transform: they hide nothing
	/// Nodes that the face lists of any one view may have at most; UNKNOWN_COUNT where there are
	/// too many faces to look at each, or poses deform some.
	uint64_t node_bound = 0;
	bool may_cut_disc = false; // some caster comes as near to the light's centre as R
	uint32_t empty_views = 0;  // bit i: no caster of view i has a face

	static constexpr uint64_t UNKNOWN_COUNT = ~uint64_t(0);

	/// The same meshes in the same order: indices of faces mean what they did.
	bool has_layout_of(const CountCasters &p_other) const;
};

/// More faces or edges than a 24-bit index can name are an Error. p_disc_radius: R in metres,
/// directional: a tangent.
CountCasters build_count_casters(const ShadowTechnique::Inputs &p_inputs, double p_disc_radius);

/// Clears CountCaster::is_moved where a caster is where it was. p_before: of the same light, with
/// the same layout.
void compare_casters(const CountCasters &p_before, CountCasters &r_casters);

} // namespace gnomon
