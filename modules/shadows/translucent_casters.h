#pragma once

#include "modules/scene/scene_snapshot.h"

#include <memory>
#include <vector>

namespace gnomon {

/// Casters that leave the same part of the light, and of which no ray of the light meets two: their
/// shadow is one technique's, in one colour.
struct TranslucentGroup {
	std::vector<uint32_t> instances;
	glm::vec3 transmittance = glm::vec3(0.0f); // 0..1 for each colour, below 1 for one at least
};

/// The casters of a light through which some of it goes, in groups. Casters that leave all of the
/// light are in none: they cast nothing.
struct TranslucentCasters {
	static constexpr size_t MAX_GROUP_COUNT = 8; // each is one more run of the technique
	std::vector<TranslucentGroup> groups;
	/// Casters of a colour of their own that went into the nearest group, as there were too many.
	uint32_t forced_count = 0;
	std::vector<uint8_t> is_translucent; // by instance; empty: none is

	bool is_empty() const { return is_translucent.empty(); }
};
TranslucentCasters find_translucent_casters(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light);

/// By instance: 1 where it casts a shadow.
using CasterFlags = std::vector<uint8_t>;

/// What a technique sees that knows opaque casters only: those that are opaque, and the group's as
/// if they were (null: none). The other translucent ones cast nothing.
CasterFlags find_opaque_casters(const SceneSnapshot &p_scene, const TranslucentCasters &p_casters,
		const TranslucentGroup *p_group);

} // namespace gnomon
