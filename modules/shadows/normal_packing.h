#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

#include <cmath>
#include <cstdint>

namespace gnomon {

/// The unit vector that a texel of the G-buffer's normals encodes (octahedral mapping): the CPU
/// version of unpack_normal in normal_inc.glsl.
inline glm::vec3 unpack_normal(uint32_t p_packed) {
	const glm::vec2 folded = glm::unpackSnorm2x16(p_packed);
	glm::vec3 n(folded, 1.0f - std::abs(folded.x) - std::abs(folded.y));
	if (n.z < 0.0f) { // the lower half of the octahedron, which packing folded outwards
		const glm::vec2 sign(n.x >= 0.0f ? 1.0f : -1.0f, n.y >= 0.0f ? 1.0f : -1.0f);
		n = glm::vec3(glm::vec2(1.0f - std::abs(n.y), 1.0f - std::abs(n.x)) * sign, n.z);
	}
	return glm::normalize(n);
}

} // namespace gnomon
