#pragma once

#include "modules/scene/scene_snapshot.h"

#include <glm/glm.hpp>

#include <vector>

namespace gnomon {

/// Where planar shadows fall. Relative to the camera, so that a scene far from the origin keeps its
/// precision.
struct ReceiverPlane {
	glm::dvec3 normal = glm::dvec3(0.0); // unit, towards the light; the world's axes
	double offset_m = 0;				 // dot(normal, p) + offset = 0
	double area_m2 = 0;
	uint32_t instance_index = 0;
};

struct ReceiverPlanes {
	std::vector<ReceiverPlane> planes; // largest first
	uint32_t declared_count = 0;	   // instances that are declared flat
	uint32_t unfit_count = 0;		   // of them: lit, but without a plane
	uint32_t skipped_count = 0;		   // planes beyond the most that are drawn
};

/// The planes of the instances whose `shadow_planar_receiver` is set, as far as they face
/// the light: faces in one plane that together have at least a twentieth of the instance's lit
/// area. At most 16 planes in all.
ReceiverPlanes find_receiver_planes(const SceneSnapshot &p_scene, const LightSnapshot &p_light);

/// The light's centre above the plane, metres; directional: the cosine of its angle to the normal.
double compute_light_height(
		const ReceiverPlane &p_plane, const LightSnapshot &p_light, const CameraSnapshot &p_camera);

} // namespace gnomon
