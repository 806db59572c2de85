#pragma once

#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_mesh_writer.h"

namespace gnomon {

/// Writes the scene's nodes, lights, cameras and size into the document's JSON: what differs from
/// p_document, or all when it is null.
void write_nodes(const Scene &p_scene, const GltfDocument *p_document, Json &r_json,
		GltfMeshWriter &r_meshes);

} // namespace gnomon
