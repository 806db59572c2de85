#pragma once

#include "modules/mesh_tools/topology.h"
#include "modules/shadow_edge_count/disc_lookup.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

// The technique edge_count in double precision, without lists or boxes: each receiver tests all
// faces and all edges. The shaders are tested against it, and probed receivers are compared with it
// (count_probe.h).

namespace gnomon {

/// A light and its space: metres, the light's centre at the origin (directional: its view's origin,
/// and the light shines along z).
struct CountSpace {
	bool is_directional = false;
	double disc_radius = 0;			// R in metres; directional: a tangent
	double nearer_tolerance = 2e-5; // see CountLightConstants
	double scene_size_m = 1;		// S

	/// Above 0 when the face with plane (n, c), n.r + c = 0, is light-facing.
	double get_light_side(const glm::dvec4 &p_plane) const {
		return is_directional ? -p_plane.z : p_plane.w;
	}
};

/// An edge that may be a silhouette from a point of the light.
struct CountEdge {
	glm::dvec3 a = glm::dvec3(0.0);
	glm::dvec3 b = glm::dvec3(0.0);
	/// Planes (n, c) of the two faces: n.r + c is 0 on the face and above 0 in front, n is unit.
	/// plane1 is 0 if the edge has one face, and negated if both faces wind a -> b.
	glm::dvec4 plane0 = glm::dvec4(0.0);
	glm::dvec4 plane1 = glm::dvec4(0.0);
	uint32_t face0 = 0; // index of the face with plane0
	bool has_face1 = false;
	bool is_double_sided = false; // it belongs to a mesh part that is not closed

	/// Signed weight as seen from a point: the change of the number of solids across the edge.
	int compute_weight(const glm::dvec3 &p_point) const;
};

/// A face in light space, in the winding order of its front.
struct CountFace {
	glm::dvec3 corners[3];
	glm::dvec4 plane = glm::dvec4(0.0);
	bool is_double_sided = false;
};

/// The faces and edges of a light's casters, in light space.
struct CountedCasters {
	std::vector<CountEdge> edges;
	std::vector<CountFace> faces;

	/// Adds the faces and edges of a mesh. Edges whose faces the whole light sees from the same
	/// side are skipped.
	void add_mesh(const MeshTopology &p_topology, const glm::dmat4 &p_light_from_node,
			const CountSpace &p_space);
};

/// An edge that changes how much of the light a receiver sees.
struct CountedEdge {
	size_t index = 0; // in the list of edges
	int weight = 0;	  // see CountEdge::compute_weight
	double area = 0;  // what it adds to the mean number of solids: a fraction of the disc's area
};

/// What led to a receiver's visibility.
struct CountDetails {
	std::vector<size_t>
			crossed_faces; // indices of those between the receiver and the light's centre
	int solid_count = 0;   // see count_solids_in_double
	std::vector<CountedEdge> edges;
	std::vector<size_t> cut_faces; // indices of faces that cut the disc
};

/// Number of solids between a receiver at p_receiver and the light's centre.
int count_solids_in_double(const CountSpace &p_space, const glm::dvec3 &p_receiver,
		std::span<const CountFace> p_faces);

/// The fraction of the light that a receiver sees, 0..1. p_receiver: its position, already moved
/// off its surface. p_edges: all edges that may matter to it. p_masks: one per set of 64 points of
/// the light. r_details: what led to it; may be null.
double compute_count_visibility(const CountSpace &p_space, const glm::dvec3 &p_receiver,
		std::span<const CountEdge> p_edges, std::span<const CountFace> p_faces,
		std::span<const DiscLookup> p_masks, CountDetails *r_details = nullptr);

/// The fraction of p_ray_count points of the light, 0..1, that no face hides from a receiver.
double trace_count_visibility(const CountSpace &p_space, const glm::dvec3 &p_receiver,
		std::span<const CountFace> p_faces, uint32_t p_ray_count);

} // namespace gnomon
