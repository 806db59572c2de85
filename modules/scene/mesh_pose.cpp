#include "modules/scene/mesh_pose.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

#include <atomic>
#include <cmath>

namespace gnomon {

namespace {

// Number of calls of make_pose after which an unused deformed mesh is dropped, such as one that was
// cut with a freed material.
const uint64_t MAX_UNUSED_POSES = 100;
const double MAX_POSITION_M = 1e18; // its square fits into a float

void check_finite(std::span<const glm::dmat4> p_joints, std::span<const float> p_weights,
		const std::string &p_object) {
	for (size_t joint = 0; joint < p_joints.size(); ++joint) {
		for (int element = 0; element < 16; ++element) {
			if (!std::isfinite(p_joints[joint][element / 4][element % 4])) {
				fail(p_object, ": the transform of joint ", joint, " of its skin is not finite. ",
						"Correct the joint's node, its parents or its inverse bind matrix.");
			}
		}
	}
	for (size_t target = 0; target < p_weights.size(); ++target) {
		if (!std::isfinite(p_weights[target])) {
			fail(p_object, ": the weight of morph target ", target, " is ", p_weights[target],
					", must be finite. Correct it or its animation.");
		}
	}
}

/// Moves the vertices of a mesh that was cut out of another. p_cut: the cut mesh; p_positions:
/// the posed vertices of the source.
std::vector<glm::vec3> move_points(const Mesh &p_cut, const std::vector<glm::vec3> &p_positions) {
	std::vector<glm::vec3> moved;
	moved.reserve(p_cut.source.points.size());
	for (const TrianglePoint &point : p_cut.source.points) {
		glm::dvec3 position(0.0);
		for (int corner = 0; corner < 3; ++corner) {
			position +=
					double(point.weights[corner]) * glm::dvec3(p_positions[point.corners[corner]]);
		}
		moved.emplace_back(position);
	}
	return moved;
}

} // namespace

MeshPose::MeshPose(std::shared_ptr<const Mesh> p_rest, std::vector<glm::dmat4> p_joints,
		std::vector<float> p_weights, const std::string &p_object, VertexMove p_move) :
		rest(std::move(p_rest)),
		joints(std::move(p_joints)), weights(std::move(p_weights)), move(std::move(p_move)) {
	check_finite(joints, weights, p_object);
	bounds = move.program ? move.bounds : compute_deformed_bounds(*rest, joints, weights);
	const glm::dvec3 min_position = bounds.minimum;
	const glm::dvec3 max_position = bounds.maximum;
	for (int axis = 0; axis < 3; ++axis) {
		if (!(std::abs(min_position[axis]) <= MAX_POSITION_M &&
					std::abs(max_position[axis]) <= MAX_POSITION_M)) {
			fail(p_object, ": its pose moves vertices to ", min_position[axis], "..",
					max_position[axis], " m, must be within ", MAX_POSITION_M,
					" m. Correct its joints' transforms, its inverse bind matrices or its "
					"weights.");
		}
	}
	hash = compute_hash(bytes_of(std::span<const glm::dmat4>(joints)), 1);
	hash = compute_hash(bytes_of(std::span<const float>(weights)), hash);
	if (move.program) {
		hash = compute_hash(bytes_of(std::span<const char>(move.program->shader)), hash);
		hash = compute_hash(bytes_of(std::span<const uint32_t>(move.values)), hash);
		for (const ProgramTexture &texture : move.textures) {
			hash = compute_value_hash(texture.id, hash);
			hash = compute_value_hash(texture.version, hash);
		}
	}
}

std::shared_ptr<const Mesh> MeshPose::get_mesh(const std::shared_ptr<const Mesh> &p_rest) const {
	const std::lock_guard<std::mutex> lock(mutex);
	const auto get_uncut = [&] {
		std::shared_ptr<const Mesh> &uncut = meshes[rest->id]; // the whole mesh
		if (!uncut) {
			DeformedVertices vertices = deform_vertices(*rest, joints, weights);
			uncut = make_mesh(rest->name, std::move(vertices.positions),
					std::move(vertices.normals), rest->indices, rest->attributes);
		}
		return uncut;
	};
	if (p_rest == rest) {
		return get_uncut();
	}
	std::shared_ptr<const Mesh> &posed_cut = meshes[p_rest->id];
	if (!posed_cut) {
		const std::shared_ptr<const Mesh> uncut = get_uncut();
		posed_cut = make_mesh(p_rest->name, move_points(*p_rest, uncut->positions_node), {},
				p_rest->indices, {},
				MeshSource{ uncut, p_rest->source.triangles, p_rest->source.points });
	}
	return posed_cut;
}

PoseSlot::PoseSlot(std::shared_ptr<const Mesh> p_rest) : rest(std::move(p_rest)) {
	static std::atomic<uint64_t> next_id = 1;
	id = next_id++;
}

std::shared_ptr<const MeshPose> PoseSlot::make_pose(std::vector<glm::dmat4> p_joints,
		std::vector<float> p_weights, const std::string &p_object, VertexMove p_move) {
	const std::lock_guard<std::mutex> lock(mutex);
	++pose_count;
	std::erase_if(deformed, [&](const auto &p_item) {
		return p_item.second.last_use + MAX_UNUSED_POSES < pose_count;
	});
	if (!pose || pose->get_joints() != p_joints || pose->get_weights() != p_weights ||
			pose->get_move() != p_move) {
		pose = std::make_shared<const MeshPose>(
				rest, std::move(p_joints), std::move(p_weights), p_object, std::move(p_move));
	}
	return pose;
}

std::shared_ptr<const Mesh> PoseSlot::get_deformed(const std::shared_ptr<const Mesh> &p_rest) {
	const std::lock_guard<std::mutex> lock(mutex);
	Deformed &entry = deformed[p_rest->id];
	if (!entry.mesh) {
		entry.mesh = make_deformed_mesh(p_rest, id);
	}
	entry.last_use = pose_count;
	return entry.mesh;
}

} // namespace gnomon
