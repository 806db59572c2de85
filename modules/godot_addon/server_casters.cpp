#include "modules/godot_addon/server_casters.h"

#include "modules/core/error.h"
#include "modules/godot_addon/cut_out_materials.h"

#include <cmath>

namespace gnomon {

namespace {

void check_transform(const godot::Transform3D &p_transform, const char *p_method) {
	const glm::dmat4 matrix = p_transform.to_matrix();
	for (int column = 0; column < 4; ++column) {
		for (int row = 0; row < 3; ++row) {
			if (!std::isfinite(matrix[column][row])) {
				fail(CASTER_SERVER_NAME, ".", p_method, ": the transform has the value ",
						matrix[column][row], ", must be finite.");
			}
		}
	}
}

} // namespace

const ServerCasters::SharedMesh &ServerCasters::share_mesh(godot::RID p_mesh) {
	SharedMesh &shared = meshes[p_mesh];
	if (shared.use_count == 0) {
		shared.surfaces = read_server_mesh(p_mesh, shared.materials);
	}
	++shared.use_count;
	return shared;
}

void ServerCasters::release_mesh(godot::RID p_mesh) {
	const auto found = meshes.find(p_mesh);
	if (found != meshes.end() && --found->second.use_count == 0) {
		meshes.erase(found);
	}
}

void ServerCasters::add(godot::RID p_instance, godot::RID p_mesh,
		const godot::Transform3D &p_world_from_mesh, int64_t p_layers, godot::RID p_material) {
	if (!p_instance.id || !p_mesh.id) {
		fail(CASTER_SERVER_NAME, ".add_caster: the ", p_instance.id ? "mesh" : "instance",
				" is an empty RID. Pass those of RenderingServer.instance_create2().");
	}
	check_transform(p_world_from_mesh, "add_caster");
	if (p_layers < 1 || p_layers > int64_t(~0u)) {
		fail(CASTER_SERVER_NAME, ".add_caster: layers is ", p_layers, ", must be 1 to ", ~0u,
				": a bit for each render layer.");
	}
	if (casters.contains(p_instance)) {
		remove(p_instance);
	}
	const SharedMesh &shared = share_mesh(p_mesh);
	if (shared.surfaces.empty()) {
		release_mesh(p_mesh);
		fail(CASTER_SERVER_NAME, ".add_caster: RID(", p_mesh.id,
				") is no mesh with triangles. Add the caster after its mesh has surfaces, and "
				"before the mesh is freed.");
	}
	ServerCaster caster = { p_mesh, p_material, shared.surfaces, {}, p_world_from_mesh,
		static_cast<uint32_t>(p_layers) };
	for (size_t surface = 0; surface < shared.surfaces.size(); ++surface) {
		caster.cut_outs.push_back(
				read_server_cut_out(p_material.id ? p_material : shared.materials[surface]));
	}
	casters[p_instance] = std::move(caster);
}

ServerCaster &ServerCasters::find(godot::RID p_instance, const char *p_method) {
	const auto found = casters.find(p_instance);
	if (found == casters.end()) {
		fail(CASTER_SERVER_NAME, ".", p_method, ": RID(", p_instance.id,
				") is no caster. Add it with add_caster first.");
	}
	return found->second;
}

void ServerCasters::move(godot::RID p_instance, const godot::Transform3D &p_world_from_mesh) {
	ServerCaster &caster = find(p_instance, "move_caster");
	check_transform(p_world_from_mesh, "move_caster");
	caster.world_from_mesh = p_world_from_mesh;
}

void ServerCasters::remove(godot::RID p_instance) {
	const godot::RID mesh = find(p_instance, "remove_caster").mesh;
	casters.erase(p_instance);
	release_mesh(mesh);
}

} // namespace gnomon
