#pragma once

#include "modules/core/property.h"
#include "modules/core/shared_vector.h"
#include "modules/scene/nodes.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// A camera of a frame.
struct CameraSnapshot {
	std::string name;
	glm::dvec3 position_world = glm::dvec3(0.0);
	glm::dmat3 world_from_camera = glm::dmat3(1.0); // rotation only; looks along -Z
	float vertical_fov_rad = 0.785398163f;
	float near_m = 0.05f;
	/// Offset of the image's centre from the optical axis, right and up, as a fraction of half its
	/// width and height; temporal antialiasing jitters it by less than a pixel.
	glm::vec2 shift = glm::vec2(0.0f);

	uint64_t compute_hash(uint64_t p_seed) const;
};

/// The penumbra widths of a light that sets none, as multiples of its size.
struct DerivedWidths {
	float outer_per_size = 1.0f;
	float inner_per_size = 1.0f;
};

/// A light's settings, its transform, and values derived from the settings.
struct LightSnapshot : LightSettings {
	std::string name;
	glm::dvec3 position_world = glm::dvec3(0.0);   // the light's centre L; unused for directional
	glm::dmat3 world_from_light = glm::dmat3(1.0); // orthonormal; the light shines along -Z
	std::string file_path;						   // for messages: "lights[0]"
	/// Bit mask: only instances on one of these layers cast a shadow of this light.
	uint32_t caster_layers = ~0u;

	// Values that decide_settings derives from the properties.
	float light_size_m = 0.0f;				 // R: radius; spot and omni
	float light_angular_distance_deg = 0.0f; // apparent diameter; directional
	bool casts_shadow = true;
	std::string technique_id; // empty = the registry's default
	/// R for spot and omni; for directional, whose R is a tangent, R times S, so that a scaled
	/// scene has a scaled penumbra.
	float size_m = 0.0f;
	/// Outer (r) and inner (t) penumbra widths of Sun et al. 2010. If unset, they are size_m, or
	/// multiples of it, see derive_widths.
	float penumbra_outer_width_m = 0.0f;
	float penumbra_inner_width_m = 0.0f;
	bool is_outer_width_derived = true;
	bool is_inner_width_derived = true;

	glm::dvec3 get_direction_world() const { return -world_from_light[2]; }
	/// R for spot and omni; the tangent of half the apparent diameter for directional.
	float get_disc_radius() const;
	/// Sets the members above from the properties. A value out of range is an Error that names the
	/// light. p_scene_size_m: S.
	void decide_settings(double p_scene_size_m);
	/// Sets those penumbra widths that the light's properties leave unset. Called for the technique
	/// that runs, whose widths replace those of any earlier call.
	void derive_widths(const DerivedWidths &p_widths);
	/// Computes half the width, in metres, of the widest penumbra that a caster within p_caster
	/// casts on receivers within p_scene, measured at the caster: the radius of the light's disc as
	/// it is projected onto the caster from the receiver.
	double compute_max_penumbra_half_width(const Bounds &p_caster, const Bounds &p_scene) const;
	/// Hashes everything that the light's exact shadow depends on: type, transform, range, cone and
	/// size.
	uint64_t compute_hash(uint64_t p_seed) const;
};

class CutLevels;
class MeshPose;
class PoseSlot;

/// One surface of a MeshInstance3D: a mesh with its material, transform and pose.
struct InstanceSnapshot {
	std::shared_ptr<const Mesh> mesh;
	/// The mesh that casts the shadow: the mesh itself, or what the alpha test leaves of it
	/// (cut_mesh.h).
	std::shared_ptr<const Mesh> caster_mesh;
	std::shared_ptr<const CutLevels> caster_levels; // see CutMesh::levels
	std::shared_ptr<const Material> material;
	/// The pose of a mesh with a rig, and the slot that its deformed meshes belong to. Null: at
	/// rest.
	std::shared_ptr<const MeshPose> pose;
	std::shared_ptr<PoseSlot> pose_slot;
	std::string node_name; // for messages
	glm::dmat4 world_from_node = glm::dmat4(1.0);
	Bounds bounds_world;
	Bounds caster_bounds_node;		// enclose caster_mesh, as posed
	uint32_t cut_block_size_px = 0; // see CutMesh::block_size_px
	uint64_t cut_hash = 0;			// see CutMesh::content_hash
	bool casts_shadow = true;
	/// Meshes that cast the shadows of single lights instead of caster_mesh, by the light's name;
	/// null: it casts none of that light.
	std::map<std::string, std::shared_ptr<const Mesh>> caster_meshes_of_lights;
	bool is_planar_receiver = false;
	uint32_t layers = 1; // see LightSnapshot::caster_layers

	/// Moves an instance whose mesh is at rest. A transform that flattens the mesh gets a minimum
	/// thickness.
	void set_transform(const glm::dmat4 &p_world_from_node);
	/// Applies a pose to an instance whose mesh is at rest. The slot must be that of the mesh.
	void set_pose(std::shared_ptr<PoseSlot> p_slot, std::shared_ptr<const MeshPose> p_pose);
	/// Return mesh and caster_mesh with posed vertices, for CPU code.
	std::shared_ptr<const Mesh> get_posed_mesh() const;
	std::shared_ptr<const Mesh> get_posed_caster_mesh() const;
	/// Hash of the pose; 0 if there is none.
	uint64_t get_pose_hash() const;
	/// True when the transform turns the mesh inside out, so that front faces wind the other way.
	bool is_mirrored() const;
	/// The fraction of light that passes through it, see Material::compute_transmittance.
	glm::vec3 compute_transmittance() const;
	/// Half the width of the widest penumbra that it casts in the scene, in metres of the node's
	/// space, see LightSnapshot::compute_max_penumbra_half_width.
	double compute_max_penumbra_half_width(
			const LightSnapshot &p_light, const Bounds &p_scene_bounds) const;
	/// Hashes everything that its shadow depends on: mesh content, pose, alpha test, transform,
	/// casts_shadow and transmittance.
	uint64_t compute_hash(uint64_t p_seed) const;
};
/// Makes an instance as build_snapshot does. It casts a shadow unless the alpha test removes all of
/// it. A transform that flattens the mesh gets a minimum thickness. Vertices that are not finite in
/// the world are an Error that names the node. p_material: null = the default material. The mesh
/// must have triangles.
InstanceSnapshot make_instance(std::shared_ptr<const Mesh> p_mesh,
		std::shared_ptr<const Material> p_material, const glm::dmat4 &p_world_from_node,
		const std::string &p_node_name);

/// Extracts the rotation of a transform. The viewing or shining axis is preserved exactly; a
/// non-uniform scale bends the others. The result is right-handed even if the transform mirrors. A
/// transform without orientation is an Error that begins with the kind and the name: "Light",
/// "Camera".
glm::dmat3 compute_orientation(
		const glm::dmat4 &p_world_from_node, const char *p_kind, const std::string &p_name);

/// Everything one frame needs of the scene, by value; never changes once built.
struct SceneSnapshot {
	CameraSnapshot camera;
	SharedVector<LightSnapshot> lights;
	SharedVector<InstanceSnapshot> instances;
	/// True: the host lights with normals that are not those of the faces, so that a face turned
	/// away from a light may be lit. It is a receiver too, on its far side; see RECEIVER_FAR_SIDE
	/// in frame_shared.h.
	bool has_far_sides = false;
	double scene_size_m = 0; // the scene size S, at least 1e-9: from the file or measured at rest

	/// Camera-relative space: the world's axes with the camera at the origin.
	glm::vec3 to_camera_relative(const glm::dvec3 &p_position_world) const {
		return glm::vec3(p_position_world - camera.position_world);
	}
	/// Returns the matrix from node to camera-relative space, composed in double.
	glm::mat4 get_camera_relative_from_node(const InstanceSnapshot &p_instance) const;
	/// Returns the scene in which only instances on the light's layers cast shadows, with the
	/// meshes of caster_meshes_of_lights, and cut-out instances cast them with the level of detail
	/// that suits the light's penumbra. Null if that equals this scene.
	std::shared_ptr<const SceneSnapshot> select_casters(const LightSnapshot &p_light) const;
	/// Returns null if there is no light of that name.
	const LightSnapshot *find_light(const std::string &p_name) const;
	/// Names the casters with one mesh that have the most triangles together, for messages about
	/// too many: 'Of 3200 triangles, 3000 are of "Tree" and 9 other nodes with its mesh.' Empty
	/// without casters.
	std::string describe_largest_caster() const;
	/// Computes the bounds of all shadow casters; empty without casters.
	Bounds compute_caster_bounds() const;
	/// Computes the bounds of all instances; empty without instances.
	Bounds compute_bounds() const;
};

/// Builds a snapshot of the whole tree, with p_camera as its camera. A transform that is not finite
/// is an Error that names the node. A mesh that its transform flattens gets a minimum thickness;
/// one that it collapses to a line or a point is invisible. A light or camera with a singular
/// transform is an Error (compute_orientation).
std::shared_ptr<const SceneSnapshot> build_snapshot(const Scene &p_scene, const Camera3D &p_camera);

} // namespace gnomon
