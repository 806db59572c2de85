#pragma once

#include "modules/renderer/shadow_technique.h"
#include "modules/shadow_edge_count/count_mesh.h"

#include <vector>

namespace gnomon {

/// One caster in a light view.
struct CountCaster {
	const CountGpuMesh *gpu = nullptr; // lives as long as the mesh, which the frame's scene holds
	uint64_t mesh_id = 0;
	/// All but record_capacity is filled in.
	shader::CountCasterPush push;
	glm::mat4 clip_from_node = glm::mat4(1.0f);
	bool is_moved = true; // since the view's edges were found the last time
};

/// The casters of one view, and how much room their faces and edges need.
struct CountCasters {
	std::vector<CountCaster> casters;
	uint32_t face_count = 0;
	uint32_t edge_count = 0;
	uint32_t word_count = 0;
	uint32_t block_count = 0;
	uint32_t flat_instance_count = 0; // with a singular transform: they hide nothing
	/// Fragments that the layer map may have at most; UNKNOWN_COUNT where there are too many faces
	/// to ask each.
	uint64_t fragment_bound = 0;

	static constexpr uint64_t UNKNOWN_COUNT = ~uint64_t(0);
};

/// More faces or edges than a 32-bit index can name are an Error.
CountCasters build_count_casters(const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index);

/// Clears CountCaster::is_moved where a caster stands as before. p_before: of the same view and
/// light; when the casters are others, or stand in another order, all have moved.
void compare_casters(const CountCasters &p_before, CountCasters &r_casters);

} // namespace gnomon
