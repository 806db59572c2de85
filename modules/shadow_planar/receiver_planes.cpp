#include "modules/shadow_planar/receiver_planes.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

// Minimum area of a plane, as a fraction of the instance's light-facing area.
const double MIN_AREA_FRACTION = 0.05;
const size_t MAX_PLANE_COUNT = 16;
// Maximum number of planes per instance, since a mesh with more is probably curved. Faces in
// further planes get none.
const size_t MAX_PLANES_PER_INSTANCE = 64;
// Maximum of 1 - cosine between normals of faces in one plane: an angle of 0.08 degrees.
const double MAX_NORMAL_DEVIATION = 1e-6;
// Maximum difference of their offsets, as a fraction of S.
const double MAX_OFFSET_DIFFERENCE = 1e-5;
// Minimum height of the light above a plane that faces it, as a fraction of S. Directional: minimum
// cosine of its angle to the normal.
const double MIN_LIGHT_HEIGHT = 1e-6;

/// Computes a face's plane. The normal of a double-sided face points towards the light. p_corners:
/// three vertex indices.
ReceiverPlane make_plane(const InstanceSnapshot &p_instance, const Mesh &p_mesh,
		const LightSnapshot &p_light, const CameraSnapshot &p_camera, const uint32_t *p_corners) {
	const auto get_corner = [&](int p_corner) {
		const glm::dvec3 position_node(p_mesh.positions_node[p_corners[p_corner]]);
		return glm::dvec3(p_instance.world_from_node * glm::dvec4(position_node, 1.0)) -
				p_camera.position_world;
	};
	const glm::dvec3 a = get_corner(0);
	const glm::dvec3 cross = glm::cross(get_corner(1) - a, get_corner(2) - a);
	const double length = glm::length(cross);
	ReceiverPlane plane;
	plane.area_m2 = 0.5 * length;
	if (!(length > 0)) {
		return plane;
	}
	plane.normal = cross / (p_instance.is_mirrored() ? -length : length);
	plane.offset_m = -glm::dot(plane.normal, a);
	if (p_instance.material->is_double_sided &&
			compute_light_height(plane, p_light, p_camera) < 0) {
		plane.normal = -plane.normal;
		plane.offset_m = -plane.offset_m;
	}
	return plane;
}

bool faces_light(
		const ReceiverPlane &p_plane, const LightSnapshot &p_light, const SceneSnapshot &p_scene) {
	const bool is_directional = p_light.type == LightType::DIRECTIONAL;
	const double min_height = MIN_LIGHT_HEIGHT * (is_directional ? 1.0 : p_scene.scene_size_m);
	return p_plane.area_m2 > 0 &&
			compute_light_height(p_plane, p_light, p_scene.camera) > min_height;
}

/// Groups the instance's light-facing faces by plane. Adds their area to r_facing_area_m2.
std::vector<ReceiverPlane> group_faces(const InstanceSnapshot &p_instance,
		const LightSnapshot &p_light, const SceneSnapshot &p_scene, double &r_facing_area_m2) {
	std::vector<ReceiverPlane> groups;
	const std::shared_ptr<const Mesh> mesh = p_instance.get_posed_mesh();
	const std::vector<uint32_t> &indices = mesh->indices;
	for (size_t first = 0; first + 2 < indices.size(); first += 3) {
		const ReceiverPlane face =
				make_plane(p_instance, *mesh, p_light, p_scene.camera, &indices[first]);
		if (!faces_light(face, p_light, p_scene)) {
			continue;
		}
		r_facing_area_m2 += face.area_m2;
		const auto same =
				std::find_if(groups.begin(), groups.end(), [&](const ReceiverPlane &p_group) {
					return glm::dot(p_group.normal, face.normal) > 1 - MAX_NORMAL_DEVIATION &&
							std::abs(p_group.offset_m - face.offset_m) <
							MAX_OFFSET_DIFFERENCE * p_scene.scene_size_m;
				});
		if (same != groups.end()) {
			same->area_m2 += face.area_m2;
		} else if (groups.size() < MAX_PLANES_PER_INSTANCE) {
			groups.push_back(face);
		}
	}
	return groups;
}

} // namespace

double compute_light_height(const ReceiverPlane &p_plane, const LightSnapshot &p_light,
		const CameraSnapshot &p_camera) {
	return p_light.type == LightType::DIRECTIONAL
			? -glm::dot(p_plane.normal, p_light.get_direction_world())
			: glm::dot(p_plane.normal, p_light.position_world - p_camera.position_world) +
					p_plane.offset_m;
}

ReceiverPlanes find_receiver_planes(const SceneSnapshot &p_scene, const LightSnapshot &p_light) {
	ReceiverPlanes result;
	for (uint32_t index = 0; index < p_scene.instances.size(); ++index) {
		const InstanceSnapshot &instance = p_scene.instances[index];
		if (!instance.is_planar_receiver) {
			continue;
		}
		++result.declared_count;
		double facing_area_m2 = 0;
		const size_t count_before = result.planes.size();
		for (ReceiverPlane &plane : group_faces(instance, p_light, p_scene, facing_area_m2)) {
			if (plane.area_m2 >= MIN_AREA_FRACTION * facing_area_m2) {
				result.planes.push_back(plane);
			}
		}
		result.curved_count += facing_area_m2 > 0 && result.planes.size() == count_before ? 1 : 0;
	}
	std::stable_sort(result.planes.begin(), result.planes.end(),
			[](const ReceiverPlane &p_left, const ReceiverPlane &p_right) {
				return p_left.area_m2 > p_right.area_m2;
			});
	if (result.planes.size() > MAX_PLANE_COUNT) {
		result.skipped_count = static_cast<uint32_t>(result.planes.size() - MAX_PLANE_COUNT);
		result.planes.resize(MAX_PLANE_COUNT);
	}
	return result;
}

} // namespace gnomon
