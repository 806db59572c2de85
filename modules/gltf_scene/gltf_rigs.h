#pragma once

#include "modules/gltf_scene/gltf_accessors.h"
#include "modules/gltf_scene/gltf_tree.h"
#include "modules/scene/mesh_rig.h"

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// Reads a primitive's joints and weights (sets 0 and 1, if p_has_skin) and its morph targets. The
/// rig must still be passed to make_mesh_rig. A primitive with neither gives an empty rig. p_path:
/// JSON path of the primitive. p_vertex_count: number of elements of POSITION.
MeshRig read_rig(const tinygltf::Primitive &p_primitive, const std::string &p_path, bool p_has_skin,
		size_t p_vertex_count, GltfAccessors &p_accessors, GltfMessages &r_messages);
/// Extracts the rig of a subset of the vertices.
MeshRig gather_rig(const MeshRig &p_rig, const std::vector<uint32_t> &p_vertices);

/// Reads a skin. If it has no inverse bind matrices, all are the identity. Throws an Error if there
/// are fewer than joints or if one is not finite.
std::shared_ptr<const Skin> read_skin(const tinygltf::Model &p_model, size_t p_index,
		const GltfTree &p_tree, GltfAccessors &p_accessors, const GltfMessages &p_messages);

} // namespace gnomon
