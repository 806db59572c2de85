#include "modules/gltf_scene/gltf_tree.h"

#include "modules/core/error.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cmath>

namespace gnomon {

namespace {

// Tolerance of the unit axes for the rounding when a matrix is converted to a quaternion and back.
const double RECOMPOSED_TOLERANCE = 1e-13;

void read_children(const tinygltf::Model &p_model, size_t p_index, const GltfMessages &p_messages,
		GltfTree &r_tree) {
	const std::vector<int> &children = p_model.nodes[p_index].children;
	for (size_t index = 0; index < children.size(); ++index) {
		const size_t child = static_cast<size_t>(children[index]);
		if (r_tree.parents[child] != GltfTree::NONE) {
			p_messages.fail(text("nodes[", p_index, "].children[", index, "]"),
					text("is ", child, ", which is a child of nodes[", r_tree.parents[child],
							"] already. Give it one parent, or export the file again."));
		}
		r_tree.parents[child] = p_index;
		r_tree.children[p_index].push_back(child);
	}
}

/// Returns nothing if the axes are not orthogonal, or if one has length 0.
std::optional<NodeTransform> decompose(const glm::dmat4 &p_matrix) {
	const NodeTransform trs = decompose_transform(p_matrix);
	const glm::dmat3 axes = glm::mat3_cast(trs.rotation);
	for (int axis = 0; axis < 3; ++axis) {
		const glm::dvec3 unit = glm::dvec3(p_matrix[axis]) / trs.scale[axis];
		if (!(glm::length(axes[axis] - unit) <= RECOMPOSED_TOLERANCE)) {
			return std::nullopt;
		}
	}
	return trs;
}

Json to_json(const glm::dvec3 &p_vector) {
	return { p_vector.x, p_vector.y, p_vector.z };
}

bool has_affine_row(const glm::dmat4 &p_matrix) {
	return p_matrix[0].w == 0 && p_matrix[1].w == 0 && p_matrix[2].w == 0 && p_matrix[3].w == 1;
}

} // namespace

GltfTree build_gltf_tree(const tinygltf::Model &p_model, const GltfMessages &p_messages) {
	const size_t count = p_model.nodes.size();
	GltfTree tree;
	tree.parents.resize(count, GltfTree::NONE);
	tree.children.resize(count);
	for (size_t index = 0; index < count; ++index) {
		read_children(p_model, index, p_messages, tree);
	}
	for (size_t index = 0; index < count; ++index) {
		if (tree.parents[index] == GltfTree::NONE) {
			tree.roots.push_back(index);
		}
	}
	// Visits the nodes level by level from the roots. As each node has at most one parent, nodes
	// that are not reached are on or below a cycle.
	std::vector<bool> is_reached(count, false);
	std::vector<size_t> level = tree.roots;
	for (size_t depth = 1; !level.empty(); ++depth) {
		std::vector<size_t> next;
		for (const size_t index : level) {
			is_reached[index] = true;
			next.insert(next.end(), tree.children[index].begin(), tree.children[index].end());
		}
		if (depth > GLTF_MAX_NODE_DEPTH) {
			p_messages.fail(text("nodes[", level[0], "]"),
					text("is nested ", depth, " deep, must be at most ", GLTF_MAX_NODE_DEPTH,
							". Flatten the hierarchy."));
		}
		level = std::move(next);
	}
	const auto unreached = std::find(is_reached.begin(), is_reached.end(), false);
	if (unreached != is_reached.end()) {
		// After `count` steps towards its ancestors a node below a cycle is on the cycle.
		size_t node = size_t(unreached - is_reached.begin());
		for (size_t step = 0; step < count; ++step) {
			node = tree.parents[node];
		}
		p_messages.fail(text("nodes[", node, "]"),
				"is its own ancestor. Break the cycle, or export the file again.");
	}
	return tree;
}

NodeTransform read_node_transform(const tinygltf::Node &p_node) {
	NodeTransform trs;
	if (!p_node.rotation.empty()) {
		const std::vector<double> &quaternion = p_node.rotation;
		trs.rotation = glm::normalize(
				glm::dquat(quaternion[3], quaternion[0], quaternion[1], quaternion[2]));
	}
	for (int axis = 0; axis < 3; ++axis) {
		const size_t index = static_cast<size_t>(axis);
		trs.scale[axis] = p_node.scale.empty() ? 1.0 : p_node.scale[index];
		trs.translation[axis] = p_node.translation.empty() ? 0.0 : p_node.translation[index];
	}
	return trs;
}

glm::dmat4 read_transform(const tinygltf::Node &p_node) {
	if (p_node.matrix.empty()) {
		return read_node_transform(p_node).compose();
	}
	glm::dmat4 matrix = glm::make_mat4(p_node.matrix.data());
	for (int column = 0; column < 4; ++column) {
		matrix[column].w = column == 3 ? 1 : 0;
	}
	return matrix;
}

void write_transform(const Node3D &p_node, const glm::dmat4 &p_before, Json &r_target) {
	const glm::dmat4 &matrix = p_node.parent_from_node;
	for (int element = 0; element < 16; ++element) {
		if (!std::isfinite(matrix[element / 4][element % 4])) {
			fail("Node \"", p_node.name, "\": its transform is not finite, which a file cannot ",
					"store. Correct it before saving.");
		}
	}
	const auto found = r_target.find("matrix");
	const bool has_matrix = found != r_target.end() && !found->is_null();
	const bool is_only_moved = has_affine_row(matrix) && glm::dmat3(matrix) == glm::dmat3(p_before);
	if (is_only_moved && !has_matrix) {
		r_target["translation"] = to_json(glm::dvec3(matrix[3]));
		return;
	}
	const std::optional<NodeTransform> trs =
			has_affine_row(matrix) && !has_matrix ? decompose(matrix) : std::nullopt;
	if (trs) {
		r_target["translation"] = to_json(trs->translation);
		r_target["rotation"] = { trs->rotation.x, trs->rotation.y, trs->rotation.z,
			trs->rotation.w };
		r_target["scale"] = to_json(trs->scale);
		return;
	}
	for (const char *key : { "translation", "rotation", "scale" }) {
		r_target.erase(key);
	}
	const double *first = glm::value_ptr(matrix);
	r_target["matrix"] = std::vector<double>(first, first + 16);
}

std::optional<size_t> find_blender_owner(
		size_t p_index, const GltfTree &p_tree, const tinygltf::Model &p_model) {
	const size_t parent = p_tree.parents[p_index];
	if (parent == GltfTree::NONE) {
		return std::nullopt;
	}
	const std::string &parent_name = p_model.nodes[parent].name;
	const bool is_orientation = !parent_name.empty() &&
			p_model.nodes[p_index].name == parent_name + BLENDER_ORIENTATION;
	return is_orientation ? std::optional(parent) : std::nullopt;
}

} // namespace gnomon
