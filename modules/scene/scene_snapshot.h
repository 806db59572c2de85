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
	/// Where the image's middle is off the axis, right and up, in halves of its width and height:
	/// antialiasing over time moves it by parts of a pixel.
	glm::vec2 shift = glm::vec2(0.0f);

	uint64_t compute_hash(uint64_t p_seed) const;
};

/// Its settings, its transform, and what the settings decide.
struct LightSnapshot : LightSettings {
	std::string name;
	glm::dvec3 position_world = glm::dvec3(0.0);   // the light's centre L; unused for directional
	glm::dmat3 world_from_light = glm::dmat3(1.0); // orthonormal; the light shines along -Z
	std::string file_path;						   // for messages: "lights[0]"
	/// Only instances on one of these layers cast its shadow.
	uint32_t caster_layers = ~0u;

	// Of the settings' properties, see decide_settings.
	float light_size_m = 0.0f;				 // R: radius; spot and omni
	float light_angular_distance_deg = 0.0f; // apparent diameter; directional
	bool casts_shadow = true;
	std::string technique_id; // empty = the registry's default
	/// r and t of Sun et al. 2010. Derived where they were not set: R for spot and omni; for
	/// directional, whose R is a tangent, R times S, so that a scaled scene has a scaled penumbra.
	float penumbra_outer_width_m = 0.0f;
	float penumbra_inner_width_m = 0.0f;
	bool is_outer_width_derived = true;
	bool is_inner_width_derived = true;

	glm::dvec3 get_direction_world() const { return -world_from_light[2]; }
	/// R for spot and omni; the tangent of half the apparent diameter for directional.
	float get_disc_radius() const;
	/// Reads the properties that every light has. A value out of range is an Error that names the
	/// light. p_scene_size_m: S.
	void decide_settings(double p_scene_size_m);
	/// Radius of the widest image of the light's disc, in metres, that a receiver within p_scene
	/// sees on a caster within p_caster: half as wide as its penumbra, there.
	double compute_widest_image(const Bounds &p_caster, const Bounds &p_scene) const;
	/// Of all that the light's exact shadow depends on: type, transform, range, cone and size.
	uint64_t compute_hash(uint64_t p_seed) const;
};

class CutLevels;
class MeshPose;
class PoseSlot;

struct InstanceSnapshot {
	std::shared_ptr<const Mesh> mesh;
	/// What casts its shadow: the mesh, or what a cut-out material leaves of it (cut_mesh.h).
	std::shared_ptr<const Mesh> caster_mesh;
	std::shared_ptr<const CutLevels> caster_levels; // see CutMesh::levels
	std::shared_ptr<const Material> material;
	/// Where the vertices of a mesh with a rig are, and the slot whose meshes those two are then.
	/// Null: at rest.
	std::shared_ptr<const MeshPose> pose;
	std::shared_ptr<PoseSlot> pose_slot;
	std::string node_name; // for messages
	glm::dmat4 world_from_node = glm::dmat4(1.0);
	Bounds bounds_world;
	Bounds caster_bounds_node;			// of caster_mesh, as posed
	uint32_t outline_block_size_px = 0; // see CutMesh
	uint64_t outline_hash = 0;			// see CutMesh::content_hash
	bool casts_shadow = true;
	bool is_planar_receiver = false;
	uint32_t layers = 1; // see LightSnapshot::caster_layers

	/// Gives a mesh at rest its pose. The slot is that of the mesh.
	void set_pose(std::shared_ptr<PoseSlot> p_slot, std::shared_ptr<const MeshPose> p_pose);
	/// The two meshes with their vertices as posed, for what runs on the CPU.
	std::shared_ptr<const Mesh> get_posed_mesh() const;
	std::shared_ptr<const Mesh> get_posed_caster_mesh() const;
	/// Of the pose; 0 where there is none.
	uint64_t get_pose_hash() const;
	/// True when the transform turns the mesh inside out, so that front faces wind the other way.
	bool is_mirrored() const;
	/// What it leaves of the light that meets it, see Material::compute_transmittance.
	glm::vec3 compute_transmittance() const;
	/// Of all that its shadow depends on: its mesh's content, its pose and transform, and what it
	/// leaves of light.
	uint64_t compute_hash(uint64_t p_seed) const;
};
/// One that casts a shadow, as build_snapshot makes it. A transform that presses the mesh flat gets
/// a least thickness. Vertices that are not finite in the world are an Error that names the node.
/// p_material: null = the plain one. The mesh must have triangles.
InstanceSnapshot make_instance(std::shared_ptr<const Mesh> p_mesh,
		std::shared_ptr<const Material> p_material, const glm::dmat4 &p_world_from_node,
		const std::string &p_node_name);

/// Rotation of a transform: the axis that is looked or shone along is preserved exactly, as a scale
/// that is not uniform bends the others. Right-handed even when the transform mirrors. One without
/// orientation is an Error that begins with the kind and the name: "Light", "Camera".
glm::dmat3 compute_orientation(
		const glm::dmat4 &p_world_from_node, const char *p_kind, const std::string &p_name);

/// Everything one frame needs of the scene, by value; never changes once built.
struct SceneSnapshot {
	CameraSnapshot camera;
	std::vector<LightSnapshot> lights;
	std::vector<InstanceSnapshot> instances;
	double scene_size_m = 0; // S; at least 1e-9; that of the scene which no animation poses

	/// Camera-relative space: the world's axes with the camera at the origin.
	glm::vec3 to_camera_relative(const glm::dvec3 &p_position_world) const {
		return glm::vec3(p_position_world - camera.position_world);
	}
	/// Node to camera-relative space, composed in double.
	glm::mat4 get_camera_relative_from_node(const InstanceSnapshot &p_instance) const;
	/// The same scene, in which only those cast a shadow that are on the light's layers, and what
	/// is cut out does so with the outlines that suit the light's penumbrae; null where that is
	/// this scene.
	std::shared_ptr<const SceneSnapshot> select_casters(const LightSnapshot &p_light) const;
	/// Null: no light has that name.
	const LightSnapshot *find_light(const std::string &p_name) const;
	/// Of all that casts a shadow; empty without casters.
	Bounds compute_caster_bounds() const;
	/// Of all instances; empty without any.
	Bounds compute_bounds() const;
};

/// Reads the tree. The camera is p_camera. Nodes with a transform that is not finite are an Error
/// that names them; singular transforms are allowed (they draw nothing).
std::shared_ptr<const SceneSnapshot> build_snapshot(const Scene &p_scene, const Camera3D &p_camera);

} // namespace gnomon
