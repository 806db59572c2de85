#pragma once

#include "modules/shadows/shadow_technique.h"

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon {

/// A limit of a technique that a light exceeds.
struct BrokenLimit {
	std::string key;	 // the same for as long as the same limit is broken
	std::string warning; // light, value, range and what to do
};

/// Finds the limits that a light exceeds. A caster's triangles are searched again only when the
/// caster, the light or the distance changed.
class LightLimits {
public:
	/// p_technique_id is used in the text. p_limits: ShadowTechnique::get_limits of that technique.
	const std::vector<BrokenLimit> &find_broken(const SceneSnapshot &p_scene,
			const LightSnapshot &p_light, const std::string &p_technique_id,
			const ShadowLimits &p_limits);

	/// Number of meshes searched since construction.
	uint32_t get_search_count() const { return search_count; }

private:
	/// A caster whose triangles were searched, and the result.
	struct Search {
		uint64_t hash = 0; // of the caster, the light and the distance
		bool is_near = false;
	};
	const InstanceSnapshot *find_near_caster(
			const SceneSnapshot &p_scene, const LightSnapshot &p_light, double p_distance_m);

	std::vector<Search> searches; // of the last call
	std::vector<BrokenLimit> broken;
	uint32_t search_count = 0;
};

/// Why the scene's size S does not fit its casters, and what to do; empty: it fits. All receivers
/// are moved off their surfaces by the same fraction of S.
std::string describe_unfit_size(const SceneSnapshot &p_scene);

} // namespace gnomon
