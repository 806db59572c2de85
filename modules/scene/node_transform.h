#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace gnomon {

/// A transform without shear, translation * rotation * scale. Scene files store these components,
/// and animations replace them one by one.
struct NodeTransform {
	glm::dvec3 translation = glm::dvec3(0.0);
	glm::dquat rotation = glm::dquat(1, 0, 0, 0); // unit
	glm::dvec3 scale = glm::dvec3(1.0);

	/// Returns the matrix.
	glm::dmat4 compose() const;
};

/// Decomposes an affine matrix; a mirroring transform gets a negative x scale. For an axis of
/// length 0 or a shear, the result is an approximation. Check compose() where that matters.
NodeTransform decompose_transform(const glm::dmat4 &p_matrix);

/// Returns the largest factor by which an affine matrix stretches a length. With shear: an upper
/// bound, at most sqrt(3) times as large.
double compute_max_stretch(const glm::dmat4 &p_matrix);

} // namespace gnomon
