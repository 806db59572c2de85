#include "modules/shadow_planar/receiver_planes.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const double LEAST_AREA_SHARE = 0.05;
const size_t MOST_PLANES = 16;
// A mesh of more orientations than this is curved, whatever it is declared to be.
const size_t MOST_GROUPS = 64;
const double SAME_NORMAL = 1e-6; // 1 less the cosine
const double SAME_OFFSET = 1e-5; // of S
const double GRAZING = 1e-6; // a height in parts of S, or a cosine: a lower light lights nothing

/// A face's plane, its normal towards the light where the mesh has two sides.
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

bool is_lit(
		const ReceiverPlane &p_plane, const LightSnapshot &p_light, const SceneSnapshot &p_scene) {
	const bool is_directional = p_light.type == LightType::DIRECTIONAL;
	const double least = GRAZING * (is_directional ? 1.0 : p_scene.scene_size_m);
	return p_plane.area_m2 > 0 && compute_light_height(p_plane, p_light, p_scene.camera) > least;
}

/// The instance's lit planes; none where it is curved.
std::vector<ReceiverPlane> group_faces(const InstanceSnapshot &p_instance,
		const LightSnapshot &p_light, const SceneSnapshot &p_scene, double &r_lit_area_m2) {
	std::vector<ReceiverPlane> groups;
	const std::shared_ptr<const Mesh> mesh = p_instance.get_posed_mesh();
	const std::vector<uint32_t> &indices = mesh->indices;
	for (size_t first = 0; first + 2 < indices.size(); first += 3) {
		const ReceiverPlane face =
				make_plane(p_instance, *mesh, p_light, p_scene.camera, &indices[first]);
		if (!is_lit(face, p_light, p_scene)) {
			continue;
		}
		r_lit_area_m2 += face.area_m2;
		const auto same =
				std::find_if(groups.begin(), groups.end(), [&](const ReceiverPlane &p_group) {
					return glm::dot(p_group.normal, face.normal) > 1 - SAME_NORMAL &&
							std::abs(p_group.offset_m - face.offset_m) <
							SAME_OFFSET * p_scene.scene_size_m;
				});
		if (same != groups.end()) {
			same->area_m2 += face.area_m2;
		} else if (groups.size() < MOST_GROUPS) {
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
		double lit_area_m2 = 0;
		const size_t count_before = result.planes.size();
		for (ReceiverPlane &plane : group_faces(instance, p_light, p_scene, lit_area_m2)) {
			if (plane.area_m2 >= LEAST_AREA_SHARE * lit_area_m2) {
				plane.instance_index = index;
				result.planes.push_back(plane);
			}
		}
		result.unfit_count += lit_area_m2 > 0 && result.planes.size() == count_before ? 1 : 0;
	}
	std::stable_sort(result.planes.begin(), result.planes.end(),
			[](const ReceiverPlane &p_left, const ReceiverPlane &p_right) {
				return p_left.area_m2 > p_right.area_m2;
			});
	if (result.planes.size() > MOST_PLANES) {
		result.skipped_count = static_cast<uint32_t>(result.planes.size() - MOST_PLANES);
		result.planes.resize(MOST_PLANES);
	}
	return result;
}

} // namespace gnomon
