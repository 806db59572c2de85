#pragma once

#include "modules/shadows/shadow_technique.h"

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon {

/// A limit of a technique that a light is beyond.
struct BrokenLimit {
	std::string key;	 // the same for as long as the same limit is broken
	std::string warning; // light, value, range and what to do
};

/// Looks for limits that a light breaks; at a caster's triangles again only when it or the light
/// moved.
class LightLimits {
public:
	/// p_technique_id: for the text. The limits are of that technique with the light's properties.
	const std::vector<BrokenLimit> &find_broken(const SceneSnapshot &p_scene,
			const LightSnapshot &p_light, const std::string &p_technique_id,
			const ShadowLimits &p_limits);

	/// Meshes that were searched since the beginning.
	uint32_t get_search_count() const { return search_count; }

private:
	/// A caster whose triangles were searched, and what came out.
	struct Search {
		uint64_t hash = 0; // of the mesh, its transform, the light's transform and the distance
		bool is_near = false;
	};
	const InstanceSnapshot *find_near_caster(
			const SceneSnapshot &p_scene, const LightSnapshot &p_light, double p_distance_m);

	std::vector<Search> searches; // of the last call
	std::vector<BrokenLimit> broken;
	uint32_t search_count = 0;
};

/// Why shadows of the scene are not what they should be with its size S, of which all receivers are
/// moved by the same part, and what to do; empty: they are.
std::string describe_unfit_size(const SceneSnapshot &p_scene);

} // namespace gnomon
