#pragma once

#include "modules/godot_addon/shader_text.h"

#include <string>
#include <vector>

namespace gnomon {

/// A uniform that vertex() reads.
struct VertexUniform {
	std::string name;
	std::string type; // GLSL: "float", "ivec2", "mat4", "sampler2D"
	size_t count = 1; // elements of an array
	bool is_array = false;
	bool is_instance = false;	 // its value belongs to the node
	bool is_color = false;		 // colours are converted from sRGB to linear
	bool is_nearest = false;	 // of a sampler
	bool repeats = true;		 // of a sampler
	std::string default_texture; // hint of a sampler, such as "hint_default_black"

	bool is_sampler() const { return type == "sampler2D"; }
	/// Words per element in the program's values.
	size_t count_words() const;
};

/// The function vertex() of a Godot shader as a compute shader, see VertexProgram.
struct VertexTranslation {
	/// Why it cannot be translated, after the material's name: "moves its vertices in vertex() by
	/// CAMERA_POSITION_WORLD". Empty: it can.
	std::string unknown_reason;
	std::string code;					 // GLSL
	std::vector<VertexUniform> uniforms; // the order of their values and of their textures
	bool uses_time = false;
	bool uses_node = false;		   // its transform, or the number of the instance
	bool uses_color = false;	   // of the vertex
	bool uses_normal = false;	   // normal or tangent of the vertex
	bool uses_coordinates = false; // UV or UV2
};

/// Words of VertexMove::values before those of the uniforms: TIME, INSTANCE_ID, MODEL_MATRIX,
/// minimum and maximum of the bounds.
inline constexpr size_t VERTEX_VALUE_WORDS = 24;

/// Translates vertex(), with the functions, constants, structures and varyings that it needs. It
/// may read vertex attributes, TIME, uniforms, the node's transform and textures of type sampler2D;
/// not the camera, bones, global uniforms, or custom attributes.
VertexTranslation translate_vertex(const ShaderText &p_shader);

} // namespace gnomon
