#pragma once

#include "modules/scene/mesh.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// A texture of the host engine that a vertex program samples at its finest level.
struct ProgramTexture {
	uint64_t id = 0;	  // the host engine's, see MeshStore::set_texture_source
	uint64_t version = 0; // counts changes of its texels
	bool is_nearest = false;
	bool repeats = true;
	bool is_srgb = false; // its colours are sRGB, and the program reads linear ones
	auto operator<=>(const ProgramTexture &) const = default;
};

/// A compute shader that moves the vertices of a mesh, made by a host engine while it runs. It
/// reads and writes the positions of a posed mesh in place, one vertex per invocation; its bindings
/// are PROGRAM_BINDING_* of shaders/shadows/shadows_shared.h, its push constants DeformPush.
struct VertexProgram {
	std::string shader; // unique; its entry point among the embedded shaders
	std::vector<uint32_t> spirv;
};

/// A vertex program with the values that it reads for one mesh at one moment.
struct VertexMove {
	std::shared_ptr<const VertexProgram> program; // null: the vertices are not moved
	std::vector<uint32_t> values;				  // as the program reads them; not empty
	std::vector<ProgramTexture> textures;
	/// Encloses the moved vertices, in the mesh's space: the program keeps them inside.
	Bounds bounds;

	bool operator==(const VertexMove &p_other) const {
		return program == p_other.program && values == p_other.values &&
				textures == p_other.textures;
	}
};

} // namespace gnomon
