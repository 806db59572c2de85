#pragma once

#include <string>

namespace gnomon {

/// How a material's shader uses Gnomon's masks.
enum class ReceiverKind {
	PATCHED, // reads them with ReceiverShader::code
	OWN,	 // has a light() that reads them through gnomon.gdshaderinc
	UNLIT,	 // receives no light or no shadow
	GODOT,	 // stays unchanged, with Godot's light and shadow
};

struct ReceiverShader {
	ReceiverKind kind = ReceiverKind::GODOT;
	std::string code;	// if PATCHED: the changed code
	std::string reason; // if GODOT: why, such as "is transparent"
};

/// Makes a shader read masks if possible. p_code: the shader's code as Godot's RenderingServer
/// returns it. p_is_generated: Godot generated it for a BaseMaterial3D, whose read_vertex_motion()
/// tells more about its vertices. With masks of 1 the light() that is added gives the same image as
/// Godot's own.
ReceiverShader make_receiver_shader(const std::string &p_code, bool p_is_generated = false);

} // namespace gnomon
