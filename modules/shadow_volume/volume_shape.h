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

/// True when the selection includes the faces of a mesh part that is solid, or not solid.
constexpr bool includes(VolumeFaces p_faces, bool p_is_solid) {
	return p_faces == VolumeFaces::ALL || (p_faces == VolumeFaces::NOT_SOLID && !p_is_solid);
}

/// The polygons of a caster's shadow volume: always sides along the silhouette edges, and a near
/// cap for each face that has a volume.
struct VolumeShape {
	/// Each of these faces has a volume of its own, whichever side faces the light. The other
	/// light-facing faces together have one volume.
	VolumeFaces robust = VolumeFaces::NONE;
	bool has_far_cap = false; // at infinity
};

} // namespace gnomon
