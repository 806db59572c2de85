#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace gnomon {

/// A transform without shear in parts, as scene files have it and animations replace them:
/// translation * rotation * scale.
struct NodeTransform {
	glm::dvec3 translation = glm::dvec3(0.0);
	glm::dquat rotation = glm::dquat(1, 0, 0, 0); // unit
	glm::dvec3 scale = glm::dvec3(1.0);

	glm::dmat4 compose() const;
};

/// Of an affine matrix; x mirrors where something does. An axis without length, and shear, give the
/// nearest that there is. Check compose() where that matters.
NodeTransform decompose_transform(const glm::dmat4 &p_matrix);

} // namespace gnomon
