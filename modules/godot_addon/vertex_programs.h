#pragma once

#include "modules/godot_addon/vertex_translation.h"
#include "modules/godot_addon/watched_resource.h"
#include "modules/scene/vertex_program.h"

#include <godot_api.gen.h>

#include <map>
#include <memory>

namespace gnomon {

/// vertex() of a Godot shader as a program that moves vertices.
struct VertexFunction {
	VertexTranslation translation;
	std::shared_ptr<const VertexProgram> program;
};

/// Translates and compiles vertex(). r_unknown_reason: why it cannot be; the result is then null.
std::shared_ptr<const VertexFunction> make_vertex_function(
		const ShaderText &p_shader, std::string &r_unknown_reason);

/// What a vertex function reads besides the material.
struct VertexSource {
	godot::GeometryInstance3D node; // for instance uniforms; may be empty
	glm::dmat4 world_from_mesh = glm::dmat4(1.0);
	double time_s = 0;	   // TIME; 0 if it is not used
	uint32_t instance = 0; // in a MultiMesh
	Bounds bounds;		   // see VertexMove
};

/// Reads the values of vertex functions from materials. Main thread only.
class VertexValues {
public:
	~VertexValues();
	VertexMove read(const std::shared_ptr<const VertexFunction> &p_function,
			const godot::ShaderMaterial &p_material, const VertexSource &p_source);
	/// Removes cached data of freed resources. Call once per frame.
	void forget_unused();

private:
	struct Watched {
		std::unique_ptr<WatchedResource> resource;
		uint64_t version = 0;
	};
	ProgramTexture read_texture(
			const VertexUniform &p_uniform, const godot::ShaderMaterial &p_material);
	godot::RID get_default_texture(const std::string &p_hint);

	std::map<uint64_t, Watched> textures; // by the resource's id
	std::map<std::string, godot::RID> default_textures;
	uint64_t frame = 0;
};

} // namespace gnomon
