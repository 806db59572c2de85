#pragma once

#include "modules/renderer/shadow_technique.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace gnomon {

/// A limit of a technique that a light is beyond.
struct BrokenLimit {
	std::string key;	 // the same for as long as the same limit is broken
	std::string warning; // light, value, range and what to do
};

/// Looks for limits that a light breaks, and looks again only when something moved.
class LightLimits {
public:
	/// p_technique_id: for the text. The limits are of that technique with the light's properties.
	const std::vector<BrokenLimit> &find_broken(const SceneSnapshot &p_scene,
			const LightSnapshot &p_light, const std::string &p_technique_id,
			const ShadowLimits &p_limits);

private:
	uint64_t asked_hash = 0;
	std::vector<BrokenLimit> broken;
};

} // namespace gnomon
