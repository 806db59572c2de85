#include "modules/gltf_scene/gltf_tree.h"

#include "modules/core/error.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cmath>

namespace gnomon {

namespace {

const double LAST_ROW_TOLERANCE = 1e-6; // exporters that compute in float
// Relative; the rounding of a quaternion there and back.
const double RECOMPOSED_TOLERANCE = 1e-13;

void read_children(const GltfObject &p_root, size_t p_index, GltfTree &r_tree) {
	const GltfObject node = p_root.get_element("nodes", p_index);
	const size_t count = node.get_count("children");
	for (size_t place = 0; place < count; ++place) {
		const size_t child = node.require_index_at("children", place, r_tree.parents.size());
		if (r_tree.parents[child] != GltfTree::NONE) {
			node.fail_at(text("children[", place, "]"),
					text("is ", child, ", which is a child of nodes[", r_tree.parents[child],
							"] already. Give it one parent, or export the file again."));
		}
		r_tree.parents[child] = p_index;
		r_tree.children[p_index].push_back(child);
	}
}

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

Json to_json_array(const glm::dvec3 &p_vector) {
	return Json::array({ p_vector.x, p_vector.y, p_vector.z });
}

bool has_affine_row(const glm::dmat4 &p_matrix) {
	return p_matrix[0].w == 0 && p_matrix[1].w == 0 && p_matrix[2].w == 0 && p_matrix[3].w == 1;
}

} // namespace

GltfTree build_gltf_tree(const GltfObject &p_root) {
	const size_t count = p_root.get_count("nodes");
	if (count > GLTF_MAX_NODE_COUNT) {
		p_root.fail_at("nodes",
				text("has ", count, " elements, must be at most ", GLTF_MAX_NODE_COUNT,
						". Split the scene."));
	}
	GltfTree tree;
	tree.parents.resize(count, GltfTree::NONE);
	tree.children.resize(count);
	for (size_t index = 0; index < count; ++index) {
		read_children(p_root, index, tree);
	}
	for (size_t index = 0; index < count; ++index) {
		if (tree.parents[index] == GltfTree::NONE) {
			tree.roots.push_back(index);
		}
	}
	// Level by level from the roots. With one parent each, what is never reached hangs on a cycle.
	std::vector<bool> is_reached(count, false);
	std::vector<size_t> level = tree.roots;
	for (size_t depth = 1; !level.empty(); ++depth) {
		std::vector<size_t> next;
		for (const size_t index : level) {
			is_reached[index] = true;
			next.insert(next.end(), tree.children[index].begin(), tree.children[index].end());
		}
		if (depth > GLTF_MAX_NODE_DEPTH) {
			p_root.fail_at(text("nodes[", level[0], "]"),
					text("is nested ", depth, " deep, must be at most ", GLTF_MAX_NODE_DEPTH,
							". Flatten the hierarchy."));
		}
		level = std::move(next);
	}
	for (size_t index = 0; index < count; ++index) {
		if (!is_reached[index]) {
			p_root.fail_at(text("nodes[", index, "]"),
					"is its own ancestor. Break the cycle, or export the file again.");
		}
	}
	return tree;
}

glm::dmat4 read_transform(const GltfObject &p_node) {
	glm::dmat4 matrix(1.0);
	if (p_node.find_numbers("matrix", std::span(glm::value_ptr(matrix), 16))) {
		const glm::dvec4 last_row(matrix[0].w, matrix[1].w, matrix[2].w, matrix[3].w);
		if (glm::length(last_row - glm::dvec4(0, 0, 0, 1)) > LAST_ROW_TOLERANCE) {
			p_node.fail_value("matrix", "affine: its last row 0, 0, 0, 1");
		}
		for (int column = 0; column < 4; ++column) {
			matrix[column].w = column == 3 ? 1 : 0;
		}
		return matrix;
	}
	double translation[3] = { 0, 0, 0 };
	double rotation[4] = { 0, 0, 0, 1 };
	double scale[3] = { 1, 1, 1 };
	p_node.find_numbers("translation", translation);
	p_node.find_numbers("scale", scale);
	if (p_node.find_numbers("rotation", rotation)) {
		const glm::dquat turn(rotation[3], rotation[0], rotation[1], rotation[2]);
		const double length = glm::length(turn);
		if (!(length > 1e-6) || !std::isfinite(length)) {
			p_node.fail_value("rotation", "a unit quaternion");
		}
		matrix = glm::mat4_cast(turn / length);
	}
	for (int axis = 0; axis < 3; ++axis) {
		matrix[axis] *= scale[axis];
		matrix[3][axis] = translation[axis];
	}
	return matrix;
}

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
		r_json["translation"] = to_json_array(glm::dvec3(matrix[3]));
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
	r_json["translation"] = to_json_array(parts->translation);
	r_json["rotation"] = Json::array(
			{ parts->rotation.x, parts->rotation.y, parts->rotation.z, parts->rotation.w });
	r_json["scale"] = to_json_array(parts->scale);
}

std::optional<size_t> find_blender_owner(
		size_t p_index, const GltfTree &p_tree, const GltfObject &p_root) {
	const size_t parent = p_tree.parents[p_index];
	if (parent == GltfTree::NONE) {
		return std::nullopt;
	}
	const std::string name = p_root.get_element("nodes", p_index).get_text("name");
	const std::string parent_name = p_root.get_element("nodes", parent).get_text("name");
	const bool is_orientation = !parent_name.empty() && name == parent_name + BLENDER_ORIENTATION;
	return is_orientation ? std::optional(parent) : std::nullopt;
}

} // namespace gnomon
