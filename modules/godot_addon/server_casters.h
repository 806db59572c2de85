#pragma once

#include "modules/godot_addon/mesh_reader.h"

#include <map>
#include <mutex>

namespace gnomon {

/// The class and the singleton that scripts call.
inline const char CASTER_SERVER_NAME[] = "GnomonServer";

/// A caster that exists only on the RenderingServer, such as a tile of a terrain.
struct ServerCaster {
	godot::RID mesh;
	godot::RID material;								   // empty: those of the mesh's surfaces
	std::vector<ReadSurface> surfaces;					   // of the mesh
	std::vector<std::shared_ptr<const Material>> cut_outs; // by surface; null: opaque
	godot::Transform3D world_from_mesh;
	uint32_t layers = 1;
};

/// The casters that scripts hand over to the singleton GnomonServer, by the instance's RID. They
/// cast in the world of the main window. The meshes are copied, so that RIDs may be freed at any
/// time. Main thread only.
class ServerCasters {
public:
	/// Adds a caster, or replaces that of the same instance. Throws an Error if the instance is
	/// empty, the mesh has no triangles, or the transform is not finite.
	void add(godot::RID p_instance, godot::RID p_mesh, const godot::Transform3D &p_world_from_mesh,
			int64_t p_layers, godot::RID p_material);
	/// Throws an Error if the instance was not added or the transform is not finite.
	void move(godot::RID p_instance, const godot::Transform3D &p_world_from_mesh);
	/// Throws an Error if the instance was not added.
	void remove(godot::RID p_instance);
	const std::map<godot::RID, ServerCaster> &get() const { return casters; }

private:
	ServerCaster &find(godot::RID p_instance, const char *p_method);

	std::map<godot::RID, ServerCaster> casters; // by instance
	/// Surfaces of meshes that several instances share, with the number of these instances.
	struct SharedMesh {
		std::vector<ReadSurface> surfaces;
		std::vector<godot::RID> materials; // of the surfaces
		size_t use_count = 0;
	};
	const SharedMesh &share_mesh(godot::RID p_mesh);
	void release_mesh(godot::RID p_mesh);
	std::map<godot::RID, SharedMesh> meshes;
};

/// Returns the casters of the singleton GnomonServer.
ServerCasters &get_server_casters();

/// Returns the class documentation of GnomonServer, as XML for Godot's editor.
std::string write_server_documentation();
/// Register and unregister the class and singleton GnomonServer.
void register_caster_server();
void unregister_caster_server();

} // namespace gnomon
