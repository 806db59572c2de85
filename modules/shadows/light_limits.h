#pragma once

#include "modules/shadows/scene_summary.h"
#include "modules/shadows/shadow_technique.h"

#include <cstdint>
#include <string>
#include <vector>

namespace gnomon {

/// A limit of a technique that a light exceeds.
struct ExceededLimit {
	std::string key;	 // identifies light, technique and limit
	std::string warning; // light, value, range and what to do
};

/// Finds the limits that a light exceeds. Whether a caster is too near to the light is found by a
/// search of its triangles, repeated only when the caster, the light or the distance changes.
class LightLimits {
public:
	/// p_technique_id is used in the text. p_limits: ShadowTechnique::get_limits of that technique.
	/// p_summary: of p_scene.
	const std::vector<ExceededLimit> &find_exceeded(const SceneSnapshot &p_scene,
			const SceneSummary &p_summary, const LightSnapshot &p_light,
			const std::string &p_technique_id, const ShadowLimits &p_limits);

	/// Number of meshes searched since construction.
	uint32_t get_search_count() const { return search_count; }

private:
	/// A caster whose triangles were searched, and the result.
	struct Search {
		uint64_t hash = 0; // of the caster, the light and the distance
		bool is_near = false;
	};
	/// Returns a caster with a triangle nearer to the light's centre than p_distance_m, or null.
	/// For a spot light, casters entirely behind it are ignored.
	const InstanceSnapshot *find_near_caster(const SceneSnapshot &p_scene,
			const SceneSummary &p_summary, const LightSnapshot &p_light, double p_distance_m);

	std::vector<Search> searches; // of the last call
	std::vector<ExceededLimit> exceeded;
	uint32_t search_count = 0;
};

/// Returns why the scene size S is too large or too small for its casters, and what to do. Empty
/// when S fits. It matters because the offset of receivers from their surfaces depends on S.
/// p_summary: of the scene's instances.
std::string describe_scene_size_problem(double p_scene_size_m, const SceneSummary &p_summary);

} // namespace gnomon
