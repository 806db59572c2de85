#include "modules/godot_addon/facing_casters.h"

#include "modules/mesh_tools/topology.h"

#include <algorithm>

namespace gnomon {

namespace {

/// Whether the light is in the mesh's box.
bool is_inside(const Mesh &p_mesh, const glm::dvec4 &p_light_mesh) {
	return p_light_mesh.w != 0 &&
			p_mesh.bounds_node.compute_distance(glm::dvec3(p_light_mesh)) == 0;
}

/// Returns which faces cast.
std::vector<bool> find_casting_faces(const Mesh &p_mesh, const MeshTopology &p_topology,
		const glm::dvec4 &p_light_mesh, ShadowCulling p_culling) {
	std::vector<bool> casts(p_topology.get_face_count());
	const bool keeps_solids = !is_inside(p_mesh, p_light_mesh);
	for (uint32_t face = 0; face < p_topology.get_face_count(); ++face) {
		if (keeps_solids && p_topology.get_part(face).is_solid()) {
			casts[face] = true;
			continue;
		}
		glm::dvec3 corners[3];
		for (uint32_t corner = 0; corner < 3; ++corner) {
			const size_t index = size_t(3) * p_topology.source_triangles[face] + corner;
			corners[corner] = p_mesh.positions_node[p_mesh.indices[index]];
		}
		const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
		const glm::dvec3 to_light = glm::dvec3(p_light_mesh) - p_light_mesh.w * corners[0];
		const double facing = glm::dot(normal, to_light);
		casts[face] = p_culling == ShadowCulling::BACK ? facing > 0 : facing < 0;
	}
	return casts;
}

/// Makes a mesh of the faces that cast, with the vertices that they use.
std::shared_ptr<const Mesh> make_casting_mesh(
		const Mesh &p_mesh, const MeshTopology &p_topology, const std::vector<bool> &p_casts) {
	std::vector<uint32_t> new_vertices(p_mesh.positions_node.size(), NO_VERTEX);
	std::vector<glm::vec3> positions;
	std::vector<glm::vec3> normals;
	std::vector<uint32_t> indices;
	for (uint32_t face = 0; face < p_casts.size(); ++face) {
		for (uint32_t corner = 0; p_casts[face] && corner < 3; ++corner) {
			const uint32_t vertex =
					p_mesh.indices[size_t(3) * p_topology.source_triangles[face] + corner];
			if (new_vertices[vertex] == NO_VERTEX) {
				new_vertices[vertex] = static_cast<uint32_t>(positions.size());
				positions.push_back(p_mesh.positions_node[vertex]);
				normals.push_back(p_mesh.normals_node[vertex]);
			}
			indices.push_back(new_vertices[vertex]);
		}
	}
	return make_mesh(p_mesh.name, std::move(positions), std::move(normals), std::move(indices));
}

} // namespace

bool FacingCasters::is_solid(const std::shared_ptr<const Mesh> &p_mesh) {
	const auto [found, is_new] =
			solid_meshes.try_emplace(p_mesh->id, std::pair(std::weak_ptr(p_mesh), false));
	if (is_new) {
		const std::vector<MeshPart> &parts = get_topology(p_mesh)->parts;
		found->second.second = std::all_of(parts.begin(), parts.end(),
				[](const MeshPart &p_part) { return p_part.is_solid(); });
	}
	return found->second.second;
}

std::shared_ptr<const Mesh> FacingCasters::select(const std::shared_ptr<const Mesh> &p_mesh,
		const Slot &p_slot, const glm::dvec4 &p_light_mesh, ShadowCulling p_culling) {
	if (p_culling == ShadowCulling::NONE ||
			(is_solid(p_mesh) && !is_inside(*p_mesh, p_light_mesh))) {
		return p_mesh;
	}
	Entry &entry = entries[p_slot];
	entry.is_used = true;
	const bool is_same_mesh = entry.source.lock() == p_mesh && entry.culling == p_culling;
	if (!is_same_mesh || entry.light_mesh != p_light_mesh) {
		const std::shared_ptr<const MeshTopology> topology = get_topology(p_mesh);
		std::vector<bool> casts = find_casting_faces(*p_mesh, *topology, p_light_mesh, p_culling);
		if (!is_same_mesh || casts != entry.casts) {
			const size_t count = size_t(std::count(casts.begin(), casts.end(), true));
			entry.next = count == 0			? nullptr
					: count == casts.size() ? p_mesh
											: make_casting_mesh(*p_mesh, *topology, casts);
			if (entry.next && entry.next != p_mesh) {
				meshes.prepare(entry.next);
			}
			entry.casts = std::move(casts);
			if (!is_same_mesh) {
				entry.mesh = entry.next;
			}
		}
		entry.source = p_mesh;
		entry.culling = p_culling;
		entry.light_mesh = p_light_mesh;
	}
	if (!entry.next || meshes.is_ready(entry.next)) {
		entry.mesh = entry.next;
	}
	return entry.mesh && meshes.is_ready(entry.mesh) ? entry.mesh : nullptr;
}

void FacingCasters::forget_unused() {
	std::erase_if(entries, [](const auto &p_entry) { return !p_entry.second.is_used; });
	for (auto &[slot, entry] : entries) {
		entry.is_used = false;
	}
	std::erase_if(solid_meshes, [](const auto &p_entry) { return p_entry.second.first.expired(); });
}

} // namespace gnomon
