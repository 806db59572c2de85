#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace gnomon {

/// Returns whether every component is a number.
template <glm::length_t COUNT, typename T> bool is_finite(const glm::vec<COUNT, T> &p_vector) {
	for (glm::length_t index = 0; index < COUNT; ++index) {
		if (!std::isfinite(p_vector[index])) {
			return false;
		}
	}
	return true;
}

template <glm::length_t COLUMNS, glm::length_t ROWS, typename T>
bool is_finite(const glm::mat<COLUMNS, ROWS, T> &p_matrix) {
	for (glm::length_t column = 0; column < COLUMNS; ++column) {
		if (!is_finite(p_matrix[column])) {
			return false;
		}
	}
	return true;
}

} // namespace gnomon
