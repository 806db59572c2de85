#include "modules/scene/node_transform.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

glm::dmat4 NodeTransform::compose() const {
	glm::dmat4 matrix = glm::mat4_cast(rotation);
	for (int axis = 0; axis < 3; ++axis) {
		matrix[axis] *= scale[axis];
		matrix[3][axis] = translation[axis];
	}
	return matrix;
}

NodeTransform decompose_transform(const glm::dmat4 &p_matrix) {
	glm::dmat3 axes(p_matrix);
	NodeTransform parts{ glm::dvec3(p_matrix[3]), {}, {} };
	for (int axis = 0; axis < 3; ++axis) {
		parts.scale[axis] = glm::length(axes[axis]);
		axes[axis] = parts.scale[axis] > 0 ? axes[axis] / parts.scale[axis]
										   : glm::dvec3(glm::dmat3(1.0)[axis]);
	}
	if (glm::determinant(axes) < 0) {
		parts.scale.x = -parts.scale.x;
		axes[0] = -axes[0];
	}
	parts.rotation = glm::normalize(glm::quat_cast(axes));
	return parts;
}

double compute_max_stretch(const glm::dmat4 &p_matrix) {
	const double ROUNDING = 1e-6; // of the largest: below it the columns count as orthogonal
	// The diagonal has the squares of the columns' lengths, the rest their dot products. If the
	// columns are not orthogonal, the Frobenius norm is the bound.
	const glm::dmat3 squares = glm::transpose(glm::dmat3(p_matrix)) * glm::dmat3(p_matrix);
	const double largest = std::max({ squares[0][0], squares[1][1], squares[2][2] });
	const double shear =
			std::max({ std::abs(squares[0][1]), std::abs(squares[0][2]), std::abs(squares[1][2]) });
	const bool is_orthogonal = shear <= ROUNDING * largest;
	return std::sqrt(is_orthogonal ? largest : squares[0][0] + squares[1][1] + squares[2][2]);
}

} // namespace gnomon
