#pragma once

#include "modules/scene/mesh_rig.h"
#include "modules/scene/vertex_program.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace gnomon {

/// The vertex positions of one mesh at one moment. Immutable.
class MeshPose {
public:
	/// p_rest must have a rig. p_joints and p_weights: see deform_vertices. p_move: what moves the
	/// vertices afterwards, on the GPU only. A pose that is not finite, or that would move vertices
	/// farther than 1e18 m from the origin, is an Error that names p_object.
	MeshPose(std::shared_ptr<const Mesh> p_rest, std::vector<glm::dmat4> p_joints,
			std::vector<float> p_weights, const std::string &p_object, VertexMove p_move = {});

	const std::vector<glm::dmat4> &get_joints() const { return joints; }
	const std::vector<float> &get_weights() const { return weights; }
	const VertexMove &get_move() const { return move; }
	/// Hash of the joints, the weights and what moves the vertices.
	uint64_t get_hash() const { return hash; }
	/// Bounds that enclose the posed vertices.
	const Bounds &get_bounds() const { return bounds; }
	/// Returns the mesh with posed vertices, which no program has moved, for CPU code. p_rest: the
	/// mesh at rest, or one that was cut out of it. Computed at the first call; thread-safe.
	std::shared_ptr<const Mesh> get_mesh(const std::shared_ptr<const Mesh> &p_rest) const;

private:
	std::shared_ptr<const Mesh> rest;
	std::vector<glm::dmat4> joints;
	std::vector<float> weights;
	VertexMove move;
	Bounds bounds;
	uint64_t hash = 0;
	mutable std::mutex mutex;
	/// Posed meshes, by the id of the mesh at rest, whole or cut.
	mutable std::map<uint64_t, std::shared_ptr<const Mesh>> meshes;
};

/// The current pose of one surface of a node. As long as the pose does not change, the MeshPose and
/// everything derived from it are reused. Deformed meshes are cached while the slot lives; one that
/// is unused for 100 calls of make_pose is dropped. Thread-safe.
class PoseSlot {
public:
	explicit PoseSlot(std::shared_ptr<const Mesh> p_rest);

	const std::shared_ptr<const Mesh> &get_rest() const { return rest; }
	/// Returns the pose: the last one if nothing differs. Parameters and errors as in the
	/// constructor of MeshPose.
	std::shared_ptr<const MeshPose> make_pose(std::vector<glm::dmat4> p_joints,
			std::vector<float> p_weights, const std::string &p_object, VertexMove p_move = {});
	/// Returns the deformed mesh for the mesh at rest, or for one that was cut out of it; its GPU
	/// vertices follow the slot's pose. See Mesh::rest.
	std::shared_ptr<const Mesh> get_deformed(const std::shared_ptr<const Mesh> &p_rest);

private:
	std::shared_ptr<const Mesh> rest;
	uint64_t id = 0; // unique in the process
	std::mutex mutex;
	std::shared_ptr<const MeshPose> pose;
	uint64_t pose_count = 0; // calls of make_pose
	struct Deformed {
		std::shared_ptr<const Mesh> mesh;
		uint64_t last_use = 0; // value of pose_count at the last use
	};
	std::map<uint64_t, Deformed> deformed; // by the id of the mesh at rest, whole or cut
};

} // namespace gnomon
