#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

struct CameraSnapshot {
	std::string name;
	glm::dvec3 position_world = glm::dvec3(0.0);
	glm::dmat3 world_from_camera = glm::dmat3(1.0); // rotation only; looks along -Z
	float vertical_fov_rad = 0.785398163f;
	float near_m = 0.05f;
};

struct LightSnapshot {
	std::string name;
	LightType type = LightType::OMNI;
	glm::dvec3 position_world = glm::dvec3(0.0);   // the light's centre L; unused for directional
	glm::dmat3 world_from_light = glm::dmat3(1.0); // orthonormal; the light shines along -Z
	glm::vec3 color = glm::vec3(1.0f);
	float intensity = 1.0f;
	float range_m = 0.0f; // 0 = unlimited
	float inner_cone_rad = 0.0f;
	float outer_cone_rad = 0.785398163f;
	float light_size_m = 0.0f;				 // R: radius; spot and omni
	float light_angular_distance_deg = 0.0f; // apparent diameter; directional
	bool casts_shadow = true;
	std::string technique_id; // empty = the registry's default
	/// r and t of Sun et al. 2010, with -1 already replaced: by R for spot and omni; for
	/// directional, whose R is a tangent, by R times S, so that a scaled scene has a scaled
	/// penumbra.
	float penumbra_outer_width_m = 0.0f;
	float penumbra_inner_width_m = 0.0f;
	PropertyValues properties; // the technique's; only what was set
	std::string file_path;	   // for messages: "lights[0]"

	glm::dvec3 get_direction_world() const { return -world_from_light[2]; }
	/// R for spot and omni; the tangent of half the apparent diameter for directional.
	float get_disc_radius() const;
};

struct InstanceSnapshot {
	std::shared_ptr<const Mesh> mesh;
	std::shared_ptr<const Material> material;
	std::string node_name; // for messages
	glm::dmat4 world_from_node = glm::dmat4(1.0);
	Bounds bounds_world;
	bool casts_shadow = true;
	bool is_planar_receiver = false;

	/// True when the transform turns the mesh inside out, so that front faces wind the other way.
	bool is_mirrored() const;
	/// What it leaves of the light that meets it, see Material::compute_transmittance.
	glm::vec3 compute_transmittance() const;
};

/// Everything one frame needs of the scene, by value; never changes once built.
struct SceneSnapshot {
	CameraSnapshot camera;
	std::vector<LightSnapshot> lights;
	std::vector<InstanceSnapshot> instances;
	double scene_size_m = 0; // S; at least 1e-9

	/// Camera-relative space: the world's axes with the camera at the origin.
	glm::vec3 to_camera_relative(const glm::dvec3 &p_position_world) const {
		return glm::vec3(p_position_world - camera.position_world);
	}
	/// Node to camera-relative space, composed in double.
	glm::mat4 get_camera_relative_from_node(const InstanceSnapshot &p_instance) const;
	/// Null: no light has that name.
	const LightSnapshot *find_light(const std::string &p_name) const;
	/// Of all that casts a shadow; empty without casters.
	Bounds compute_caster_bounds() const;
};

/// Reads the tree. The camera is p_camera. Nodes with a transform that is not finite are an Error
/// that names them; singular transforms are allowed (they draw nothing).
std::shared_ptr<const SceneSnapshot> build_snapshot(const Scene &p_scene, const Camera3D &p_camera);
/// One light as build_snapshot reads it; only derived widths of a directional light stay -1.
LightSnapshot build_light_snapshot(const Light3D &p_light);

} // namespace gnomon
