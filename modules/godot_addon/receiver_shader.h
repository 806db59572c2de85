#pragma once

#include <string>

namespace gnomon {

/// What a material's shader does with Gnomon's masks.
enum class ReceiverKind {
	PATCHED, // it reads them once it has the code below
	OWN,	 // it reads them by itself, with gnomon.gdshaderinc
	UNLIT,	 // it takes no light, or no shadow
	GODOT,	 // it stays as it is, in the light and the shadow of Godot
};

struct ReceiverShader {
	ReceiverKind kind = ReceiverKind::GODOT;
	std::string code;	// PATCHED
	std::string reason; // GODOT: "is transparent"
};

/// p_code: of a spatial shader, as Godot's RenderingServer has it. The light() that it gets gives
/// the same image where all masks are 1.
ReceiverShader make_receiver_shader(const std::string &p_code);

} // namespace gnomon
