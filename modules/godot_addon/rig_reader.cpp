#include "modules/godot_addon/rig_reader.h"

#include "modules/core/error.h"

namespace gnomon {

namespace {

void read_bones(const godot::Array &p_arrays, size_t p_vertex_count, const std::string &p_name,
		MeshRig &r_rig) {
	const godot::PackedInt32Array bones(p_arrays.get_value(godot::Mesh::ARRAY_BONES));
	const godot::PackedFloat32Array weights(p_arrays.get_value(godot::Mesh::ARRAY_WEIGHTS));
	if (bones.get_values().empty() || weights.get_values().empty() || p_vertex_count == 0) {
		return;
	}
	// Weights per vertex: 4, or 8 with ARRAY_FLAG_USE_8_BONE_WEIGHTS.
	r_rig.influence_count = static_cast<uint32_t>(bones.get_values().size() / p_vertex_count);
	for (const int32_t bone : bones.get_values()) {
		if (bone < 0) {
			fail("Mesh \"", p_name, "\" has the bone ", bone, ", must be at least 0.");
		}
		r_rig.joints.push_back(static_cast<uint32_t>(bone));
	}
	r_rig.keeps_weight_sums = true; // Godot rounds weights down to 16 bits and does not normalize
	r_rig.weights.assign(weights.get_values().begin(), weights.get_values().end());
}

MorphTarget read_blend_shape(
		const godot::Array &p_arrays, std::span<const glm::vec3> p_positions, bool p_is_relative) {
	const godot::PackedVector3Array values(p_arrays.get_value(godot::Mesh::ARRAY_VERTEX));
	MorphTarget target;
	target.positions.assign(values.get_values().begin(), values.get_values().end());
	if (!p_is_relative && target.positions.size() == p_positions.size()) {
		for (size_t vertex = 0; vertex < p_positions.size(); ++vertex) {
			target.positions[vertex] -= p_positions[vertex];
		}
	}
	return target;
}

} // namespace

std::shared_ptr<const MeshRig> read_rig(const godot::Mesh &p_mesh, int64_t p_surface,
		const godot::Array &p_arrays, std::span<const glm::vec3> p_positions,
		const std::string &p_name) {
	const auto array_mesh = godot::cast<godot::ArrayMesh>(p_mesh);
	MeshRig rig;
	read_bones(p_arrays, p_positions.size(), p_name, rig);
	if (array_mesh) {
		const bool is_relative =
				array_mesh.get_blend_shape_mode() == godot::Mesh::BLEND_SHAPE_MODE_RELATIVE;
		const godot::Array shapes = array_mesh.surface_get_blend_shape_arrays(p_surface);
		for (int64_t index = 0; index < shapes.get_size(); ++index) {
			rig.targets.push_back(read_blend_shape(
					godot::Array(shapes.get_value(index)), p_positions, is_relative));
		}
	}
	if (rig.influence_count == 0 && rig.targets.empty()) {
		return nullptr;
	}
	return make_mesh_rig(std::move(rig), p_positions, "Mesh \"" + p_name + "\"");
}

} // namespace gnomon
