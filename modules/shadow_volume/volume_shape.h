#pragma once

#include <cstdint>

namespace gnomon {

/// A selection among a mesh's faces. As VOLUMES_FACES_* of the shaders.
enum class VolumeFaces : uint32_t {
	NONE = 0,
	/// Those of parts that are not solid, see MeshPart::is_solid.
	NOT_SOLID = 1,
	ALL = 2,
};

constexpr bool includes(VolumeFaces p_faces, bool p_is_solid) {
	return p_faces == VolumeFaces::ALL || (p_faces == VolumeFaces::NOT_SOLID && !p_is_solid);
}

/// Which polygons a caster's shadow volume has: always sides along the silhouette edges and a cap
/// at the caster, for each face that has a volume.
struct VolumeShape {
	/// Each of these faces has a volume of its own, whichever of its sides faces the light. Of the
	/// others those that face the light have one volume together.
	VolumeFaces robust = VolumeFaces::NONE;
	bool has_far_cap = false; // at infinity
};

} // namespace gnomon
