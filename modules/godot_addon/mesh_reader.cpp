#include "modules/godot_addon/mesh_reader.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/godot_addon/rig_reader.h"

#include <cstring>

namespace gnomon {

namespace {

const uint64_t MAX_UNUSED_MESH_FRAMES = 600; // 10 s at 60 frames per second

/// Returns the primitive type of a surface. ArrayMesh and PrimitiveMesh need no copy from the GPU
/// for it.
int64_t find_primitive(const godot::Mesh &p_mesh, int64_t p_surface) {
	if (const auto array_mesh = godot::cast<godot::ArrayMesh>(p_mesh)) {
		return array_mesh.surface_get_primitive_type(p_surface);
	}
	if (godot::cast<godot::PrimitiveMesh>(p_mesh)) {
		return godot::Mesh::PRIMITIVE_TRIANGLES;
	}
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	return server.mesh_get_surface(p_mesh.get_rid(), p_surface)
			.to_variant()
			.get_keyed("primitive")
			.to_int();
}

/// Returns counterclockwise triangles of Godot's clockwise ones. p_order: vertex of each corner.
/// The corners of a triangle are reordered as in Godot's glTF export, so that the add-on and Gnomon
/// with the exported file give bitwise equal masks.
std::vector<uint32_t> make_triangles(std::span<const uint32_t> p_order, bool p_is_strip) {
	std::vector<uint32_t> triangles;
	const size_t step = p_is_strip ? 1 : 3;
	for (size_t first = 0; first + 2 < p_order.size(); first += step) {
		const bool is_odd = p_is_strip && first % 2 == 1;
		triangles.push_back(p_order[first + (is_odd ? 0 : 2)]);
		triangles.push_back(p_order[first + 1]);
		triangles.push_back(p_order[first + (is_odd ? 2 : 0)]);
	}
	return triangles;
}

/// Reads indices as Godot stores them: 16 bits for up to 65536 vertices, else 32 bits.
std::vector<uint32_t> read_indices(std::span<const uint8_t> p_bytes, size_t p_vertex_count) {
	const size_t size = p_vertex_count <= 65536 ? sizeof(uint16_t) : sizeof(uint32_t);
	std::vector<uint32_t> indices(p_bytes.size() / size);
	for (size_t index = 0; index < indices.size(); ++index) {
		std::memcpy(&indices[index], &p_bytes[index * size], size);
	}
	return indices;
}

/// Reads the levels of detail of a surface; null: it has none. They use the vertices of the full
/// mesh.
std::shared_ptr<const DetailLevels> read_levels(
		const godot::Mesh &p_mesh, int64_t p_surface, const Mesh &p_full, bool p_is_strip) {
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	const godot::Array levels(
			server.mesh_get_surface(p_mesh.get_rid(), p_surface).to_variant().get_keyed("lods"));
	auto read = std::make_shared<DetailLevels>();
	for (int64_t index = 0; index < levels.get_size(); ++index) {
		const godot::Variant level = levels.get_value(index);
		const godot::PackedByteArray bytes(level.get_keyed("index_data"));
		std::vector<uint32_t> triangles = make_triangles(
				read_indices(bytes.get_values(), p_full.positions_node.size()), p_is_strip);
		if (!triangles.empty()) {
			read->push_back({ static_cast<float>(level.get_keyed("edge_length").to_float()),
					make_mesh(p_full.name, p_full.positions_node, p_full.normals_node,
							std::move(triangles)) });
		}
	}
	return read->empty() ? nullptr : read;
}

/// Makes the mesh of a surface's arrays. p_attributes: its rig. Null: it has no triangles.
std::shared_ptr<const Mesh> make_surface_mesh(const godot::Array &p_arrays, bool p_is_strip,
		const std::string &p_name, MeshAttributes p_attributes) {
	const godot::PackedVector3Array positions(p_arrays.get_value(godot::Mesh::ARRAY_VERTEX));
	const godot::PackedVector3Array normals(p_arrays.get_value(godot::Mesh::ARRAY_NORMAL));
	const godot::PackedVector2Array uvs(p_arrays.get_value(godot::Mesh::ARRAY_TEX_UV));
	const godot::PackedInt32Array indices(p_arrays.get_value(godot::Mesh::ARRAY_INDEX));
	const std::span<const glm::vec3> points = positions.get_values();
	std::vector<uint32_t> order(indices.get_values().begin(), indices.get_values().end());
	if (order.empty()) {
		for (uint32_t vertex = 0; vertex < points.size(); ++vertex) {
			order.push_back(vertex);
		}
	}
	std::vector<uint32_t> triangles = make_triangles(order, p_is_strip);
	if (triangles.empty()) {
		return nullptr;
	}
	if (uvs.get_values().size() == points.size()) { // for alpha masks, see CutOutMaterials
		p_attributes.uvs[0].assign(uvs.get_values().begin(), uvs.get_values().end());
	}
	return make_mesh(p_name, { points.begin(), points.end() },
			{ normals.get_values().begin(), normals.get_values().end() }, std::move(triangles),
			std::move(p_attributes));
}

ReadSurface read_surface(const godot::Mesh &p_mesh, int64_t p_surface, const std::string &p_name) {
	ReadSurface surface;
	surface.index = p_surface;
	const int64_t primitive = find_primitive(p_mesh, p_surface);
	const bool is_strip = primitive == godot::Mesh::PRIMITIVE_TRIANGLE_STRIP;
	if (primitive != godot::Mesh::PRIMITIVE_TRIANGLES && !is_strip) {
		return surface; // points and lines
	}
	const godot::Array arrays = p_mesh.surface_get_arrays(p_surface);
	if (arrays.get_size() <= godot::Mesh::ARRAY_INDEX) {
		return surface;
	}
	const godot::PackedVector3Array positions(arrays.get_value(godot::Mesh::ARRAY_VERTEX));
	MeshAttributes attributes;
	attributes.rig = read_rig(p_mesh, p_surface, arrays, positions.get_values(), p_name);
	surface.mesh = make_surface_mesh(arrays, is_strip, p_name, std::move(attributes));
	if (!surface.mesh) {
		return surface;
	}
	if (godot::cast<godot::ArrayMesh>(p_mesh)) { // others have no levels of detail
		surface.levels = read_levels(p_mesh, p_surface, *surface.mesh, is_strip);
	}
	return surface;
}

/// Reads what vertex() may read besides positions and normals.
void read_attributes(const godot::Array &p_arrays, MeshAttributes &r_attributes) {
	const godot::PackedVector2Array uvs(p_arrays.get_value(godot::Mesh::ARRAY_TEX_UV2));
	const godot::PackedColorArray colors(p_arrays.get_value(godot::Mesh::ARRAY_COLOR));
	const godot::PackedFloat32Array tangents(p_arrays.get_value(godot::Mesh::ARRAY_TANGENT));
	r_attributes.uvs[1].assign(uvs.get_values().begin(), uvs.get_values().end());
	r_attributes.colors.assign(colors.get_values().begin(), colors.get_values().end());
	r_attributes.tangents.clear();
	for (size_t first = 0; first + 4 <= tangents.get_values().size(); first += 4) {
		const float *tangent = &tangents.get_values()[first];
		r_attributes.tangents.emplace_back(tangent[0], tangent[1], tangent[2], tangent[3]);
	}
}

/// Hashes what vertex() reads of each vertex besides its position: vertices that differ in it may
/// move apart.
std::vector<uint64_t> hash_inputs(const Mesh &p_mesh, const MeshAttributes &p_attributes,
		const VertexTranslation &p_translation) {
	std::vector<uint64_t> hashes(p_mesh.positions_node.size(), 1);
	const auto add = [&](bool p_is_used, const auto &p_values) {
		for (size_t vertex = 0; p_is_used && vertex < std::min(hashes.size(), p_values.size());
				++vertex) {
			hashes[vertex] = compute_value_hash(p_values[vertex] + 0.0f, hashes[vertex]);
		}
	};
	add(p_translation.uses_normal, p_mesh.normals_node);
	add(p_translation.uses_normal, p_attributes.tangents);
	add(p_translation.uses_coordinates, p_attributes.uvs[0]);
	add(p_translation.uses_coordinates, p_attributes.uvs[1]);
	add(p_translation.uses_color, p_attributes.colors);
	return hashes;
}

} // namespace

std::vector<ReadSurface> read_server_mesh(godot::RID p_mesh, std::vector<godot::RID> &r_materials) {
	const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
	std::vector<ReadSurface> surfaces;
	for (int64_t index = 0; index < server.mesh_get_surface_count(p_mesh); ++index) {
		const int64_t primitive =
				server.mesh_get_surface(p_mesh, index).to_variant().get_keyed("primitive").to_int();
		const bool is_strip = primitive == godot::Mesh::PRIMITIVE_TRIANGLE_STRIP;
		const godot::Array arrays = server.mesh_surface_get_arrays(p_mesh, index);
		if ((primitive != godot::Mesh::PRIMITIVE_TRIANGLES && !is_strip) ||
				arrays.get_size() <= godot::Mesh::ARRAY_INDEX) {
			continue;
		}
		if (std::shared_ptr<const Mesh> mesh =
						make_surface_mesh(arrays, is_strip, "mesh of GnomonServer", {})) {
			surfaces.push_back({ std::move(mesh), index });
			r_materials.push_back(server.mesh_surface_get_material(p_mesh, index));
		}
	}
	return surfaces;
}

const std::vector<ReadSurface> &MeshReader::read(
		const godot::Mesh &p_mesh, const std::string &p_name) {
	Entry &entry = entries[godot::get_instance_id(p_mesh.get_object())];
	entry.last_use = frame;
	const int64_t surface_count = p_mesh.get_surface_count();
	const bool is_new = !entry.watched;
	if (is_new) {
		entry.watched = std::make_unique<WatchedResource>(p_mesh);
	}
	if (!is_new && !entry.watched->take_change() && entry.surface_count == surface_count) {
		return entry.surfaces;
	}
	entry.surface_count = surface_count;
	entry.surfaces.clear();
	for (int64_t index = 0; index < surface_count; ++index) {
		ReadSurface surface;
		surface.index = index;
		try {
			surface = read_surface(p_mesh, index, p_name);
		} catch (const Error &error) {
			log_warning(error.what(), " Surface ", index, " of \"", p_name,
					"\" casts no shadow of Gnomon until its mesh changes.");
		}
		if (surface.mesh) {
			worker.prepare(surface.mesh);
		}
		entry.surfaces.push_back(surface);
	}
	return entry.surfaces;
}

bool MeshReader::is_cut_ready(const std::shared_ptr<const Mesh> &p_cut) {
	prepare(p_cut);
	return worker.is_ready(p_cut);
}

void MeshReader::prepare(const std::shared_ptr<const Mesh> &p_mesh) {
	if (prepared.try_emplace(p_mesh->id, p_mesh).second) {
		worker.prepare(p_mesh);
	}
}

std::shared_ptr<const Mesh> MeshReader::grow(const ReadSurface &p_surface, float p_grow_m) {
	ChangedMesh &cached = grown[{ p_surface.mesh->id, p_grow_m }];
	cached.last_use = frame;
	if (!cached.mesh) {
		const Mesh &mesh = *p_surface.mesh;
		std::vector<glm::vec3> positions = mesh.positions_node;
		for (size_t vertex = 0; vertex < positions.size(); ++vertex) {
			positions[vertex] += p_grow_m * mesh.normals_node[vertex];
		}
		cached.mesh = make_mesh(mesh.name, std::move(positions), mesh.normals_node, mesh.indices,
				MeshAttributes(mesh.attributes));
		worker.prepare(cached.mesh);
	}
	return cached.mesh;
}

std::shared_ptr<const Mesh> MeshReader::make_movable(const ReadSurface &p_surface,
		const godot::Mesh &p_mesh, const VertexTranslation &p_translation) {
	const uint32_t used = uint32_t(p_translation.uses_normal) |
			uint32_t(p_translation.uses_coordinates) << 1 | uint32_t(p_translation.uses_color) << 2;
	ChangedMesh &cached = movable[{ p_surface.mesh->id, used }];
	cached.last_use = frame;
	if (!cached.mesh) {
		const Mesh &mesh = *p_surface.mesh;
		MeshAttributes attributes = mesh.attributes;
		if (used != 0) {
			read_attributes(p_mesh.surface_get_arrays(p_surface.index), attributes);
		}
		MeshRig rig = attributes.rig ? *attributes.rig : MeshRig();
		rig.program_inputs = hash_inputs(mesh, attributes, p_translation);
		attributes.rig = make_mesh_rig(std::move(rig), mesh.positions_node, mesh.name);
		cached.mesh = make_mesh(mesh.name, mesh.positions_node, mesh.normals_node, mesh.indices,
				std::move(attributes));
		worker.prepare(cached.mesh);
	}
	return cached.mesh;
}

void MeshReader::forget_unused() {
	++frame;
	const auto is_unused = [&](const auto &p_entry) {
		return frame - p_entry.second.last_use > MAX_UNUSED_MESH_FRAMES;
	};
	std::erase_if(grown, is_unused);
	std::erase_if(movable, is_unused);
	std::erase_if(entries, [&](const auto &p_entry) {
		return !p_entry.second.watched->is_alive() ||
				frame - p_entry.second.last_use > MAX_UNUSED_MESH_FRAMES;
	});
	std::erase_if(prepared, [](const auto &p_entry) { return p_entry.second.expired(); });
	worker.forget_unused();
}

} // namespace gnomon
