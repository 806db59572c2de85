#pragma once

#include <cstdint>

namespace gnomon {

/// A selection of a mesh's faces; the values are those of VOLUMES_FACES_* in the shaders.
enum class VolumeFaces : uint32_t {
	NONE = 0,
	/// Faces of parts that are not solid, see MeshPart::is_solid.
	NOT_SOLID = 1,
	ALL = 2,
};

constexpr bool includes(VolumeFaces p_faces, bool p_is_solid) {
	return p_faces == VolumeFaces::ALL || (p_faces == VolumeFaces::NOT_SOLID && !p_is_solid);
}

/// The polygons of a caster's shadow volume: always sides along the silhouette edges, and a near
/// cap for each face that has a volume.
struct VolumeShape {
	/// Each of these faces has its own volume, whichever side faces the light. The other faces that
	/// face the light share one volume.
	VolumeFaces robust = VolumeFaces::NONE;
	bool has_far_cap = false; // at infinity
};

} // namespace gnomon
