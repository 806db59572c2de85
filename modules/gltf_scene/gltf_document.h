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

inline constexpr char GLTF_PUNCTUAL[] = "KHR_lights_punctual";
inline constexpr char GLTF_AREA[] = "EXT_lights_area";
inline constexpr char GLTF_TRANSMISSION[] = "KHR_materials_transmission";
inline constexpr char GLTF_VOLUME[] = "KHR_materials_volume";
inline constexpr char GLTF_TEXTURE_TRANSFORM[] = "KHR_texture_transform";
inline constexpr char GLTF_EMISSIVE_STRENGTH[] = "KHR_materials_emissive_strength";

/// A node as it was loaded. What still equals it is not written.
struct GltfNodeState {
	bool is_loaded = false; // false: in no scene, or in another one
	std::string name;
	glm::dmat4 parent_from_node = glm::dmat4(1.0);
	bool casts_shadow = true;
	bool is_planar_receiver = false;
};

/// A file as it was read, which its scene holds: saving changes a copy of it.
class GltfDocument : public SceneDocument {
public:
	/// Meshes of one node, as pointers that name them.
	using SurfaceKey = std::vector<std::pair<const Mesh *, const Material *>>;

	std::string file; // as the user named it
	GltfLocation location;
	GltfContainer container; // as it was read
	/// The same as tinygltf holds it: without the bytes of buffers and images, refused values
	/// replaced by their defaults.
	tinygltf::Model model;
	std::optional<size_t> scene_index; // none: the file has no scenes
	double scene_size_m = 0;
	std::vector<GltfNodeState> nodes; // by index in the file
	/// By index of their node: what the scene named a light or camera that shares its node.
	std::map<size_t, std::set<std::string>> part_names;
	std::map<size_t, LightSettings> lights;			   // by index of their node
	std::map<size_t, std::pair<float, float>> cameras; // the same: field of view, near plane
	/// Where a light's properties are in addition to its node: see find_blender_owner.
	std::map<size_t, size_t> blender_owners;
	std::map<SurfaceKey, size_t> mesh_indices;
	std::map<const Skin *, size_t> skin_indices;
	/// Keep those alive.
	std::vector<std::shared_ptr<const Skin>> retained_skins;
	std::map<size_t, SurfaceKey> node_surfaces; // by index of their node
	std::map<const Material *, size_t> material_indices;
	/// Which primitive of its mesh in the file each is.
	std::map<const Mesh *, size_t> primitive_indices;
	/// Whether nodes that the scene does not have may show the file's materials too.
	bool shares_materials = false;
	/// Keep the meshes alive whose pointers are above.
	std::vector<std::vector<MeshInstance3D::Surface>> retained_surfaces;

	static SurfaceKey make_key(const std::vector<MeshInstance3D::Surface> &p_surfaces) {
		SurfaceKey key;
		for (const MeshInstance3D::Surface &surface : p_surfaces) {
			key.emplace_back(surface.mesh.get(), surface.material.get());
		}
		return key;
	}
};

/// tinygltf's model of a document that check_gltf let pass. What tinygltf refuses all the same: an
/// Error.
tinygltf::Model parse_gltf_model(Json p_checked, const GltfMessages &p_messages);

/// The document that tinygltf writes of a changed model. p_read, p_before: the document as it was
/// read, and tinygltf's model of it; all that the model does not hold, and all that did not change,
/// stays in it unchanged, in its order. Both null for a new document.
Json write_gltf_model(
		const tinygltf::Model &p_model, const Json *p_read, const tinygltf::Model *p_before);

} // namespace gnomon
