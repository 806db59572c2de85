#pragma once

#include "modules/gltf_scene/gltf_buffers.h"
#include "modules/gltf_scene/gltf_container.h"
#include "modules/scene/nodes.h"

#include <tiny_gltf.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

// Names of glTF extensions.
inline constexpr char GLTF_PUNCTUAL[] = "KHR_lights_punctual";
inline constexpr char GLTF_AREA[] = "EXT_lights_area";
inline constexpr char GLTF_TRANSMISSION[] = "KHR_materials_transmission";
inline constexpr char GLTF_VOLUME[] = "KHR_materials_volume";
inline constexpr char GLTF_TEXTURE_TRANSFORM[] = "KHR_texture_transform";
inline constexpr char GLTF_EMISSIVE_STRENGTH[] = "KHR_materials_emissive_strength";

/// What a file states about a perspective camera.
struct GltfCamera {
	float vertical_fov_rad = Camera3D().vertical_fov_rad;
	float near_m = Camera3D().near_m;
};

/// A node's state at loading. Saving writes only what differs from it.
struct GltfNodeState {
	bool is_loaded = false; // false: the node is not part of the loaded scene
	std::string name;
	glm::dmat4 parent_from_node = glm::dmat4(1.0);
	bool casts_shadow = true;
	bool is_planar_receiver = false;
};

/// The file from which a scene was loaded, and what was read from it. The scene stores it. Saving
/// writes the scene's changes into the file's JSON, so that data unknown to the program is
/// preserved.
class GltfDocument : public SceneDocument {
public:
	/// Identifies the surfaces of a node by their mesh and material pointers.
	using SurfaceKey = std::vector<std::pair<const Mesh *, const Material *>>;

	std::string file; // path as given by the user
	GltfLocation location;
	GltfContainer container;		   // contents as read
	std::optional<size_t> scene_index; // none: the file has no scenes
	double scene_size_m = 0;
	std::vector<GltfNodeState> nodes; // by index in the file
	/// By node index: the names, in the scene, of lights and cameras that became children of their
	/// node, because the node also has a mesh or a light.
	std::map<size_t, std::set<std::string>> attachment_names;
	std::map<size_t, LightSettings> lights; // by node index
	std::map<size_t, GltfCamera> cameras;	// by node index
	/// By node index of a light: the index of its parent, if the parent's extras hold properties of
	/// the light (find_blender_owner).
	std::map<size_t, size_t> blender_owners;
	std::map<SurfaceKey, size_t> mesh_indices;
	std::map<const Skin *, size_t> skin_indices;
	/// Keeps alive the skins whose pointers are stored above.
	std::vector<std::shared_ptr<const Skin>> retained_skins;
	std::map<size_t, SurfaceKey> node_surfaces; // by node index
	std::map<const Material *, size_t> material_indices;
	/// For each loaded mesh, the index of its primitive in the file's mesh.
	std::map<const Mesh *, size_t> primitive_indices;
	/// Whether a node that is not loaded has a mesh, which may use the same materials. A changed
	/// material is then appended instead of replaced.
	bool shares_materials = false;
	/// Keeps alive the meshes whose pointers are stored above.
	std::vector<std::vector<MeshInstance3D::Surface>> retained_surfaces;

	static SurfaceKey make_key(const std::vector<MeshInstance3D::Surface> &p_surfaces) {
		SurfaceKey key;
		for (const MeshInstance3D::Surface &surface : p_surfaces) {
			key.emplace_back(surface.mesh.get(), surface.material.get());
		}
		return key;
	}
};

/// Parses the parts of a document that describe nodes, meshes and motion, after they have
/// passed check_gltf. Throws an Error if tinygltf rejects them. Changes nothing else in r_checked
/// than the extensions of primitives.
tinygltf::Model parse_gltf_model(Json &r_checked, const GltfMessages &p_messages);

} // namespace gnomon
