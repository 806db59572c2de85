#pragma once

#include "modules/scene/mesh_rig.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace gnomon {

/// Where the vertices of one mesh are at one moment. Never changes.
class MeshPose {
public:
	/// p_rest: has a rig. p_joints and p_weights: see deform_vertices. What is not finite, or would
	/// move vertices out of the range of floats, is an Error that names p_object.
	MeshPose(std::shared_ptr<const Mesh> p_rest, std::vector<glm::dmat4> p_joints,
			std::vector<float> p_weights, const std::string &p_object);

	const std::vector<glm::dmat4> &get_joints() const { return joints; }
	const std::vector<float> &get_weights() const { return weights; }
	/// Of joints and weights.
	uint64_t get_hash() const { return hash; }
	/// Encloses the vertices.
	const Bounds &get_bounds() const { return bounds; }
	/// p_rest, or a mesh that was cut out of it, with its vertices where the pose puts them, for
	/// what runs on the CPU. Computed at the first call; thread-safe.
	std::shared_ptr<const Mesh> get_mesh(const std::shared_ptr<const Mesh> &p_rest) const;

private:
	std::shared_ptr<const Mesh> rest;
	std::vector<glm::dmat4> joints;
	std::vector<float> weights;
	Bounds bounds;
	uint64_t hash = 0;
	mutable std::mutex mutex;
	mutable std::map<uint64_t, std::shared_ptr<const Mesh>> meshes; // by the id of that at rest
};

/// The pose of one surface of a node. While it is the same, so are the pose and all that is made of
/// it; the meshes stay the same for as long as the slot lives. Thread-safe.
class PoseSlot {
public:
	explicit PoseSlot(std::shared_ptr<const Mesh> p_rest);

	const std::shared_ptr<const Mesh> &get_rest() const { return rest; }
	/// See MeshPose.
	std::shared_ptr<const MeshPose> make_pose(std::vector<glm::dmat4> p_joints,
			std::vector<float> p_weights, const std::string &p_object);
	/// Of the mesh at rest, or of one that was cut out of it: the mesh whose vertices on the GPU
	/// follow the slot's pose. See Mesh::rest.
	std::shared_ptr<const Mesh> get_deformed(const std::shared_ptr<const Mesh> &p_rest);

private:
	std::shared_ptr<const Mesh> rest;
	uint64_t id = 0; // unique in the process
	std::mutex mutex;
	std::shared_ptr<const MeshPose> pose;
	uint64_t pose_count = 0; // calls of make_pose
	struct Deformed {
		std::shared_ptr<const Mesh> mesh;
		uint64_t last_use = 0; // pose_count then
	};
	std::map<uint64_t, Deformed> deformed; // by the id of the mesh at rest
};

} // namespace gnomon
