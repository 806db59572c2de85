#pragma once

#include "modules/shadow_edge_count/caster_order.h"
#include "modules/shadow_edge_count/count_mesh.h"
#include "modules/shadow_edge_count/work_groups.h"
#include "modules/shadows/shadow_technique.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace gnomon {

/// Maximum number of a light's faces, and of its edges. Their indices must fit in 24 bits
/// (EDGE_COUNT_FACE_MASK) and 26 bits (COUNT_EDGE_MASK in count_box_inc.glsl).
constexpr uint32_t MAX_CASTER_FACES = 10'000'000;

/// One caster of a light, or one LOD of it.
struct CountCaster {
	std::shared_ptr<const Mesh> mesh;
	uint32_t instance = 0; // in the scene
	uint64_t pose_hash = 0;
	uint32_t views = 0; // bit i: view i may see it
	uint32_t face_count = 0;
	uint32_t word_count = 0; // words of EDGE_COUNT_EDGES_PER_WORD edges
	// Of a deformed mesh: its vertices in the pool, and the buffer that they are copied from.
	std::shared_ptr<CountPosedMesh> posed;
	BufferRID posed_positions;
	bool is_coarse = false; // the coarse one of two LODs
	/// Its instance's bounds come within R of the light's centre.
	bool may_cut_disc = false;
};

/// A caster, and what passes read of it.
struct RecordedCaster {
	CountCaster caster;
	shader::CountCasterRecord record = {};
};

/// The casters of all views of a light, each once or, for a cut-out with a coarse LOD,
/// twice, and the sizes of all their data together.
struct CountCasters {
	static constexpr uint32_t NO_CASTER = ~0u;

	std::vector<CountCaster> casters;
	std::vector<shader::CountCasterRecord> records;	 // of the casters
	std::vector<shader::CountWorkGroup> face_groups; // of all faces, see work_groups.h
	std::vector<shader::CountWorkGroup> word_groups; // of all words of edges
	std::vector<uint32_t> posed;					 // indices of casters whose mesh is deformed
	/// Indices, ascending, of casters whose transform in light space or pose has changed since the
	/// light's faces and edges were last found.
	std::vector<uint32_t> moved;
	uint32_t coarse_count = 0; // of casters with CountCaster::is_coarse
	uint32_t face_count = 0;
	uint32_t edge_count = 0;
	uint32_t word_count = 0;			   // words of EDGE_COUNT_EDGES_PER_WORD edges
	double disc_radius = 0;				   // R, see CountSettings
	float side_tolerance = 0;			   // see shader::CountFindPush
	uint32_t collapsed_instance_count = 0; // instances collapsed to a line or a point
	bool may_cut_disc = false;			   // some caster's
	uint32_t empty_views = 0;			   // bit i: no caster of view i has a face
	bool has_lods = false;				   // of detail, in some caster's instance
	// What they were made from.
	SharedVector<InstanceSnapshot> instances; // of the scene
	std::vector<uint32_t> indices;			  // of the instances that cast
	std::vector<uint32_t> first_casters;	  // by instance: index of its first caster, NO_CASTER
	Bounds scene_bounds_world;
	bool may_have_lods = false; // there are not too many triangles
	uint32_t view_count = 0;

	/// True if both have the same meshes and flags in the same order, so that face indices stay
	/// valid.
	bool has_layout_of(const CountCasters &p_other) const;
	/// Adds a caster with its items after those of all others, as one that has moved. p_light: its
	/// name. Throws an Error if there are more faces or edges than MAX_CASTER_FACES.
	void add(const std::string &p_light, RecordedCaster p_caster);
};

/// Collects the casters, in the order of r_order, and uploads their meshes where needed. p_indices:
/// of instances that some view may see, ascending. p_disc_radius: R, see CountSettings. Throws an
/// Error if there are more than 10,000,000 faces or edges: face indices have 24 bits, edge
/// indices 26.
CountCasters build_count_casters(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_indices, double p_disc_radius, CasterOrder &r_order);

/// Casters that have moved since CountCasters were collected: their indices there, and what
/// replaces them.
struct MovedCasters {
	std::vector<std::pair<uint32_t, RecordedCaster>> casters;
	SharedVector<InstanceSnapshot> instances; // of the scene
	/// Replaces the casters; CountCasters::moved are these alone.
	void apply_to(CountCasters &r_casters);
};
/// Finds what build_count_casters would return differently, if that is only where casters are.
/// Else, or if many have moved, empty. p_casters: what it returned for the same light, views and
/// disc radius. r_order: as it left it.
std::optional<MovedCasters> find_moved_casters(const ShadowTechnique::Inputs &p_inputs,
		const std::vector<uint32_t> &p_indices, const CountCasters &p_casters,
		CasterOrder &r_order);

/// Removes those casters from CountCasters::moved that have the same transform and pose as in
/// p_before, which are earlier casters of the same light with the same layout.
void compare_casters(const CountCasters &p_before, CountCasters &r_casters);

} // namespace gnomon
