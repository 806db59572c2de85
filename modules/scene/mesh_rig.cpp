#include "modules/scene/mesh_rig.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/finite.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace gnomon {

namespace {

void check_counts(const MeshRig &p_rig, size_t p_vertex_count, const std::string &p_name) {
	const uint32_t influences = p_rig.influence_count;
	if (influences != 0 && influences != 4 && influences != 8) {
		fail(p_name, ": has ", influences, " joints a vertex, must be 0, 4 or 8. Export it again.");
	}
	const size_t expected = p_vertex_count * influences;
	if (p_rig.joints.size() != expected || p_rig.weights.size() != expected) {
		fail(p_name, ": has ", p_rig.joints.size(), " joints and ", p_rig.weights.size(),
				" weights, must be ", expected, " each, ", influences,
				" a vertex. Export it again.");
	}
	GNOMON_ASSERT(p_rig.program_inputs.empty() || p_rig.program_inputs.size() == p_vertex_count,
			p_name, ": has ", p_rig.program_inputs.size(), " inputs of a vertex program");
	for (size_t target = 0; target < p_rig.targets.size(); ++target) {
		const MorphTarget &morph = p_rig.targets[target];
		for (const std::vector<glm::vec3> *deltas :
				{ &morph.positions, &morph.normals, &morph.tangents }) {
			if (!deltas->empty() && deltas->size() != p_vertex_count) {
				fail(p_name, ": morph target ", target, " has ", deltas->size(),
						" elements, must be ", p_vertex_count, ", one a vertex. Export it again.");
			}
			const auto bad = std::find_if(deltas->begin(), deltas->end(),
					[](const glm::vec3 &p_delta) { return !is_finite(p_delta); });
			if (bad != deltas->end()) {
				fail(p_name, ": morph target ", target, ", vertex ", bad - deltas->begin(),
						" is not finite. Correct it or export the mesh again.");
			}
		}
	}
}

void normalize_weights(MeshRig &r_rig, const std::string &p_name) {
	const size_t influences = r_rig.influence_count;
	for (size_t vertex = 0; influences > 0 && vertex < r_rig.vertex_count; ++vertex) {
		float *weights = &r_rig.weights[vertex * influences];
		double sum = 0;
		for (size_t i = 0; i < influences; ++i) {
			if (!(weights[i] >= 0) || !std::isfinite(weights[i])) {
				fail(p_name, ": weight ", i, " of vertex ", vertex, " is ", weights[i],
						", must be 0..1. Correct it or export the mesh again.");
			}
			sum += weights[i];
		}
		if (r_rig.keeps_weight_sums) {
			r_rig.min_weight_sum = std::min(r_rig.min_weight_sum, sum);
			r_rig.max_weight_sum = std::max(r_rig.max_weight_sum, sum);
		} else if (sum > 0) {
			for (size_t i = 0; i < influences; ++i) {
				weights[i] = static_cast<float>(weights[i] / sum);
			}
		} else {
			weights[0] = 1;
		}
	}
}

void compute_rig_bounds(MeshRig &r_rig, std::span<const glm::vec3> p_positions) {
	r_rig.joint_count = 0;
	for (const uint32_t joint : r_rig.joints) {
		r_rig.joint_count = std::max(r_rig.joint_count, joint + 1);
	}
	r_rig.joint_bounds.assign(r_rig.joint_count, {});
	for (size_t i = 0; i < r_rig.joints.size(); ++i) {
		if (r_rig.weights[i] > 0) {
			r_rig.joint_bounds[r_rig.joints[i]].add(
					glm::dvec3(p_positions[i / r_rig.influence_count]));
		}
	}
	r_rig.target_bounds.clear();
	for (const MorphTarget &target : r_rig.targets) {
		Bounds bounds;
		bounds.add(glm::dvec3(0.0)); // the only offset if the target has no positions
		for (const glm::vec3 &delta : target.positions) {
			bounds.add(glm::dvec3(delta));
		}
		r_rig.target_bounds.push_back(bounds);
	}
}

template <typename T> uint64_t add_hash(const std::vector<T> &p_values, uint64_t p_hash) {
	return compute_hash(bytes_of(std::span<const T>(p_values)), p_hash);
}

/// Returns the weighted sum of the joints' matrices at a vertex.
glm::dmat4 blend_joints(
		const MeshRig &p_rig, size_t p_vertex, std::span<const glm::dmat4> p_joints) {
	glm::dmat4 blended(0.0);
	const size_t first = p_vertex * p_rig.influence_count;
	for (size_t i = first; i < first + p_rig.influence_count; ++i) {
		if (p_rig.weights[i] > 0) {
			blended += p_joints[p_rig.joints[i]] * double(p_rig.weights[i]);
		}
	}
	return blended;
}

/// Returns the matrix that transforms normals, up to their length: the cofactors, which exist even
/// where the inverse does not.
glm::dmat3 compute_cofactors(const glm::dmat3 &p_matrix) {
	return glm::dmat3(glm::cross(p_matrix[1], p_matrix[2]), glm::cross(p_matrix[2], p_matrix[0]),
			glm::cross(p_matrix[0], p_matrix[1]));
}

double get_weight(std::span<const float> p_weights, size_t p_target) {
	return p_target < p_weights.size() ? double(p_weights[p_target]) : 0.0;
}

} // namespace

uint64_t MeshRig::compute_vertex_hash(uint32_t p_vertex) const {
	std::map<uint32_t, float> joint_weights; // sorted by joint
	for (size_t i = 0; i < influence_count; ++i) {
		const size_t index = size_t(p_vertex) * influence_count + i;
		if (weights[index] > 0) {
			joint_weights[joints[index]] += weights[index];
		}
	}
	uint64_t hash = 1;
	for (const auto &[joint, weight] : joint_weights) {
		hash = compute_value_hash(joint, hash);
		hash = compute_value_hash(weight, hash);
	}
	for (const MorphTarget &target : targets) {
		if (!target.positions.empty()) { // + 0: -0 and 0 get the same hash
			hash = compute_value_hash(target.positions[p_vertex] + 0.0f, hash);
		}
	}
	return program_inputs.empty() ? hash : compute_value_hash(program_inputs[p_vertex], hash);
}

std::shared_ptr<const MeshRig> make_mesh_rig(
		MeshRig p_rig, std::span<const glm::vec3> p_positions_node, const std::string &p_name) {
	check_counts(p_rig, p_positions_node.size(), p_name);
	auto rig = std::make_shared<MeshRig>(std::move(p_rig));
	rig->vertex_count = p_positions_node.size();
	normalize_weights(*rig, p_name);
	compute_rig_bounds(*rig, p_positions_node);
	uint64_t hash = add_hash(rig->joints, 1);
	hash = add_hash(rig->weights, hash);
	for (const MorphTarget &target : rig->targets) {
		hash = add_hash(target.positions, hash);
		hash = add_hash(target.normals, hash);
	}
	rig->content_hash = add_hash(rig->program_inputs, hash);
	return rig;
}

DeformedVertices deform_vertices(const Mesh &p_mesh, std::span<const glm::dmat4> p_joints,
		std::span<const float> p_weights) {
	const MeshRig &rig = *p_mesh.attributes.rig;
	const bool is_skinned = rig.influence_count > 0 && !p_joints.empty();
	GNOMON_ASSERT(!is_skinned || p_joints.size() >= rig.joint_count, "mesh ", p_mesh.name,
			" needs ", rig.joint_count, " joints, has ", p_joints.size());
	DeformedVertices vertices;
	vertices.positions.reserve(rig.vertex_count);
	vertices.normals.reserve(rig.vertex_count);
	for (size_t vertex = 0; vertex < rig.vertex_count; ++vertex) {
		glm::dvec3 position = p_mesh.positions_node[vertex];
		glm::dvec3 normal = p_mesh.normals_node[vertex];
		for (size_t target = 0; target < rig.targets.size(); ++target) {
			const double weight = get_weight(p_weights, target);
			const MorphTarget &morph = rig.targets[target];
			if (weight != 0 && !morph.positions.empty()) {
				position += weight * glm::dvec3(morph.positions[vertex]);
			}
			if (weight != 0 && !morph.normals.empty()) {
				normal += weight * glm::dvec3(morph.normals[vertex]);
			}
		}
		if (is_skinned) {
			const glm::dmat4 matrix = blend_joints(rig, vertex, p_joints);
			position = glm::dvec3(matrix * glm::dvec4(position, 1.0));
			normal = compute_cofactors(glm::dmat3(matrix)) * normal;
		}
		const double length = glm::length(normal);
		vertices.positions.emplace_back(position);
		vertices.normals.emplace_back(length > 0 && std::isfinite(length)
						? glm::vec3(normal / length)
						: p_mesh.normals_node[vertex]);
	}
	return vertices;
}

Bounds compute_deformed_bounds(const Mesh &p_mesh, std::span<const glm::dmat4> p_joints,
		std::span<const float> p_weights) {
	const MeshRig &rig = *p_mesh.attributes.rig;
	Bounds added; // offsets by all targets together
	added.add(glm::dvec3(0.0));
	for (size_t target = 0; target < rig.targets.size(); ++target) {
		const double weight = get_weight(p_weights, target);
		const Bounds &bounds = rig.target_bounds[target];
		const glm::dvec3 one = weight * bounds.minimum;
		const glm::dvec3 other = weight * bounds.maximum;
		added.minimum += glm::min(one, other);
		added.maximum += glm::max(one, other);
	}
	const auto widen = [&](const Bounds &p_bounds) {
		return Bounds{ p_bounds.minimum + added.minimum, p_bounds.maximum + added.maximum };
	};
	if (rig.influence_count == 0 || p_joints.empty()) {
		return widen(p_mesh.bounds_node);
	}
	Bounds bounds;
	for (size_t joint = 0; joint < rig.joint_count; ++joint) {
		if (!rig.joint_bounds[joint].is_empty()) {
			bounds.add(transform_bounds(widen(rig.joint_bounds[joint]), p_joints[joint]));
		}
	}
	// The blend of the joints is inside these bounds; a weight sum other than 1 scales it.
	Bounds scaled;
	for (const double sum : { rig.min_weight_sum, rig.max_weight_sum }) {
		scaled.add(sum * bounds.minimum);
		scaled.add(sum * bounds.maximum);
	}
	return scaled;
}

} // namespace gnomon
