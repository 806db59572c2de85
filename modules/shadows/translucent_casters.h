#pragma once

#include "modules/scene/scene_snapshot.h"

#include <memory>
#include <vector>

namespace gnomon {

/// Casters whose shadow, of one colour, is computed by one run of the technique: they have the same
/// transmittance, and no light ray hits two of them (except merged ones, see
/// TranslucentCasters::merged_count).
struct TranslucentGroup {
	std::vector<uint32_t> instances;		   // indices of SceneSnapshot::instances
	glm::vec3 transmittance = glm::vec3(0.0f); // per colour, 0..1, at least one below 1
};

/// The translucent casters of a light, in groups. Casters that transmit all light are in no group:
/// they cast no shadow.
struct TranslucentCasters {
	static constexpr size_t MAX_GROUP_COUNT = 8; // each is one more run of the technique
	std::vector<TranslucentGroup> groups;
	/// Casters that were put into the group of the nearest colour, since there were
	/// MAX_GROUP_COUNT groups already.
	uint32_t merged_count = 0;
	std::vector<uint8_t> is_translucent; // by instance; empty: none is

	bool is_empty() const { return is_translucent.empty(); }
};
TranslucentCasters find_translucent_casters(
		const SceneSnapshot &p_scene, const LightSnapshot &p_light);

/// One value per instance: 1 when it casts a shadow, else 0.
using CasterFlags = std::vector<uint8_t>;

/// The casters of one run of a technique that only handles opaque casters: the opaque ones, and
/// those of p_group as if they were opaque (null: none). Other translucent casters cast nothing.
CasterFlags find_opaque_casters(const SceneSnapshot &p_scene, const TranslucentCasters &p_casters,
		const TranslucentGroup *p_group);

} // namespace gnomon
