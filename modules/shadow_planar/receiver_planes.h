#pragma once

#include "modules/scene/scene_snapshot.h"

#include <glm/glm.hpp>

#include <vector>

namespace gnomon {

/// A plane that receives planar shadows. Camera-relative, so that a scene far from the origin keeps
/// its precision.
struct ReceiverPlane {
	glm::dvec3 normal = glm::dvec3(0.0); // unit, on the light's side, along the world's axes
	double offset_m = 0;				 // dot(normal, p) + offset_m = 0
	double area_m2 = 0;					 // of the faces in this plane
};

/// The receiver planes of a scene for one light, and statistics for the frame plan.
struct ReceiverPlanes {
	std::vector<ReceiverPlane> planes; // largest first
	uint32_t declared_count = 0;	   // instances that are declared planar
	uint32_t curved_count = 0;		   // of these: light-facing, but no plane is large enough
	uint32_t skipped_count = 0;		   // planes beyond the maximum of 16, the smallest ones
};

/// Finds the light-facing planes of the instances whose `shadow_planar_receiver` is set. The faces
/// of a plane must together have at least a twentieth of the instance's light-facing area.
/// Returns at most the 16 largest planes.
ReceiverPlanes find_receiver_planes(const SceneSnapshot &p_scene, const LightSnapshot &p_light);

/// Height of the light's centre above the plane in metres. Directional: cosine of the angle between
/// the direction to the light and the normal.
double compute_light_height(
		const ReceiverPlane &p_plane, const LightSnapshot &p_light, const CameraSnapshot &p_camera);

} // namespace gnomon
