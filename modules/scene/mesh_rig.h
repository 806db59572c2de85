#pragma once

#include "modules/scene/mesh.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// What a morph target adds to each vertex at weight 1. Each list is empty or has one element per
/// vertex.
struct MorphTarget {
	std::vector<glm::vec3> positions; // metres, in the mesh's space
	std::vector<glm::vec3> normals;
	std::vector<glm::vec3> tangents;
};

/// How a mesh deforms: morph targets first, then linear blend skinning (glTF 2.0, 3.7.2.2 and
/// 3.7.3.3). Immutable once shared.
struct MeshRig {
	size_t vertex_count = 0;
	uint32_t influence_count = 0; // joints per vertex: 0 (no skin), 4 or 8
	std::vector<uint32_t> joints; // influence_count per vertex
	std::vector<float> weights;	  // as many as joints; 0..1; sum 1 unless keeps_weight_sums
	/// True: weights are not normalized to a sum of 1, because the host engine (Godot) draws the
	/// mesh with sums that rounding made less than 1.
	bool keeps_weight_sums = false;
	std::vector<MorphTarget> targets;
	/// What a vertex program reads of each vertex besides its position, hashed; empty: no program
	/// moves the mesh. See VertexProgram.
	std::vector<uint64_t> program_inputs;

	// make_mesh_rig fills in the following members.
	uint32_t joint_count = 0; // one more than the largest joint index
	/// Bounds of the rest vertices that each joint moves; may be empty.
	std::vector<Bounds> joint_bounds;
	std::vector<Bounds> target_bounds; // bounds of 0 and the offsets that each target adds
	double min_weight_sum = 1;		   // smallest weight sum of a vertex, at most 1
	double max_weight_sum = 1;		   // largest weight sum of a vertex, at least 1
	uint64_t content_hash = 0;

	/// Hashes everything that moves one vertex: vertices with different hashes must not be welded.
	/// Joints of weight 0, the order of joints, and repeated joints make no difference.
	uint64_t compute_vertex_hash(uint32_t p_vertex) const;
};

/// Checks a rig and computes its derived members. Unless keeps_weight_sums is set, it normalizes
/// the weights of each vertex to a sum of 1; if all of them are 0, the first joint gets 1.
/// A wrong count, a number that is not finite or a weight below 0 is an Error that begins with
/// p_name, the mesh's name.
std::shared_ptr<const MeshRig> make_mesh_rig(
		MeshRig p_rig, std::span<const glm::vec3> p_positions_node, const std::string &p_name);

/// The positions and normals of vertices in a pose.
struct DeformedVertices {
	std::vector<glm::vec3> positions; // metres
	std::vector<glm::vec3> normals;	  // unit
};

/// Deforms vertices in double, rounded to float once. p_joints: skinning matrices in the mesh's
/// space (joint times inverse bind matrix), at least MeshRig::joint_count of them; empty: no skin.
/// p_weights: morph target weights; missing ones are 0. p_mesh must have a rig.
DeformedVertices deform_vertices(
		const Mesh &p_mesh, std::span<const glm::dmat4> p_joints, std::span<const float> p_weights);
/// Returns bounds that enclose the posed vertices: the union of each joint's rest bounds, with what
/// morph targets add, transformed by that joint. Weight sums other than 1 scale them.
Bounds compute_deformed_bounds(
		const Mesh &p_mesh, std::span<const glm::dmat4> p_joints, std::span<const float> p_weights);

} // namespace gnomon
