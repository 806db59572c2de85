#include "modules/gltf_scene/gltf_transform_writer.h"

#include "modules/core/error.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cmath>

namespace gnomon {

namespace {

// Relative; the rounding of a quaternion there and back.
const double RECOMPOSED_TOLERANCE = 1e-13;

struct Parts {
	glm::dvec3 translation;
	glm::dquat rotation;
	glm::dvec3 scale;
};

/// Nothing when the axes are not at right angles, or one has no length.
std::optional<Parts> decompose(const glm::dmat4 &p_matrix) {
	glm::dmat3 axes(p_matrix);
	Parts parts{ glm::dvec3(p_matrix[3]), {}, {} };
	for (int axis = 0; axis < 3; ++axis) {
		parts.scale[axis] = glm::length(axes[axis]);
		axes[axis] /= parts.scale[axis];
	}
	if (glm::determinant(axes) < 0) {
		parts.scale.x = -parts.scale.x;
		axes[0] = -axes[0];
	}
	parts.rotation = glm::normalize(glm::quat_cast(axes));
	const glm::dmat3 again = glm::mat3_cast(parts.rotation);
	for (int axis = 0; axis < 3; ++axis) {
		if (!(glm::length(again[axis] - axes[axis]) <= RECOMPOSED_TOLERANCE)) {
			return std::nullopt;
		}
	}
	return parts;
}

Json to_json(const glm::dvec3 &p_vector) {
	return Json::array({ p_vector.x, p_vector.y, p_vector.z });
}

bool has_affine_row(const glm::dmat4 &p_matrix) {
	return p_matrix[0].w == 0 && p_matrix[1].w == 0 && p_matrix[2].w == 0 && p_matrix[3].w == 1;
}

} // namespace

void write_transform(const Node3D &p_node, const glm::dmat4 &p_before, Json &r_json) {
	const glm::dmat4 &matrix = p_node.parent_from_node;
	for (int element = 0; element < 16; ++element) {
		if (!std::isfinite(matrix[element / 4][element % 4])) {
			fail("Node \"", p_node.name, "\": its transform is not finite, and no file can hold ",
					"that. Correct it before saving.");
		}
	}
	const bool is_only_moved = has_affine_row(matrix) && has_affine_row(p_before) &&
			glm::dmat3(matrix) == glm::dmat3(p_before);
	if (is_only_moved && !r_json.contains("matrix")) {
		r_json["translation"] = to_json(glm::dvec3(matrix[3]));
		return;
	}
	r_json.erase("translation");
	r_json.erase("rotation");
	r_json.erase("scale");
	const std::optional<Parts> parts =
			has_affine_row(matrix) && !r_json.contains("matrix") ? decompose(matrix) : std::nullopt;
	if (!parts) {
		const double *first = glm::value_ptr(matrix);
		r_json["matrix"] = std::vector<double>(first, first + 16);
		return;
	}
	r_json["translation"] = to_json(parts->translation);
	r_json["rotation"] = Json::array(
			{ parts->rotation.x, parts->rotation.y, parts->rotation.z, parts->rotation.w });
	r_json["scale"] = to_json(parts->scale);
}

} // namespace gnomon
