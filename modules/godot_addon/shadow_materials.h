#pragma once

#include "modules/godot_addon/cut_out_materials.h"
#include "modules/godot_addon/shader_text.h"
#include "modules/godot_addon/watched_resource.h"

#include <map>
#include <string>

namespace gnomon {

/// How a surface's shadow follows from its material, as in Godot's own shadow passes.
enum class ShadowKind {
	OPAQUE,
	CUT_OUT, // by alpha: scissor, hash, or a depth prepass
	NONE,	 // blended, or without depth
};

/// What of a surface casts.
struct ShadowSurface {
	ShadowKind kind = ShadowKind::OPAQUE;
	/// Of a cut-out one: where it is there. Null: that cannot be read.
	std::shared_ptr<const Material> cut_out;
};

/// Reads materials of Godot. Main thread only.
class ShadowMaterials {
public:
	ShadowSurface read(const godot::Material &p_material);
	/// Drops what is known of shaders that are gone. Once a frame.
	void forget_unused();

private:
	struct Entry {
		std::unique_ptr<WatchedResource> watched;
		ShadowKind kind = ShadowKind::OPAQUE;
	};
	ShadowKind read_shader(const godot::Shader &p_shader);

	std::map<uint64_t, Entry> shaders; // by the resource's id
	CutOutMaterials cut_outs;
};

/// What a shader's code contains: the built-ins and render modes that decide it.
ShadowKind find_shadow_kind(const ShaderText &p_shader);

} // namespace gnomon
