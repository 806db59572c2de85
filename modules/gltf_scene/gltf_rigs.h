#pragma once

#include "modules/gltf_scene/gltf_accessors.h"
#include "modules/gltf_scene/gltf_tree.h"
#include "modules/scene/mesh_rig.h"

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// Joints and weights (JOINTS_0 and 1, where p_has_skin) and morph targets of a primitive, before
/// make_mesh_rig; without both: a rig with neither. p_path: where the primitive is.
/// p_vertex_count: of its POSITION.
MeshRig read_rig(const tinygltf::Primitive &p_primitive, const std::string &p_path, bool p_has_skin,
		size_t p_vertex_count, GltfAccessors &p_accessors, GltfMessages &r_messages);
/// The rig of some of its vertices.
MeshRig gather_rig(const MeshRig &p_rig, const std::vector<uint32_t> &p_vertices);

std::shared_ptr<const Skin> read_skin(const tinygltf::Model &p_model, size_t p_index,
		const GltfTree &p_tree, GltfAccessors &p_accessors, const GltfMessages &p_messages);

} // namespace gnomon
