#pragma once

#include "modules/godot_addon/cut_out_materials.h"
#include "modules/godot_addon/facing_casters.h"
#include "modules/godot_addon/shader_text.h"
#include "modules/godot_addon/vertex_motion.h"
#include "modules/godot_addon/watched_resource.h"

#include <map>
#include <string>

namespace gnomon {

/// How a surface casts, according to its material, as in Godot's own shadow passes.
enum class ShadowKind {
	OPAQUE,
	CUT_OUT, // by alpha scissor, alpha hash, depth prepass or discard
	NONE,	 // casts nothing: blended, or drawn without depth test or depth writes
};

/// How a surface casts, with its alpha mask. If that cannot be read, motion.unknown_reason is set.
struct ShadowSurface {
	ShadowKind kind = ShadowKind::OPAQUE;
	/// If CUT_OUT: the alpha mask; null: it cannot be read.
	std::shared_ptr<const Material> cut_out;
	VertexMotion motion;
	ShadowCulling culling = ShadowCulling::BACK;
};

/// Reads how Godot's materials cast. Main thread only.
class ShadowMaterials {
public:
	/// The reference is valid until forget_unused().
	const ShadowSurface &read(const godot::Material &p_material);
	/// Reads what motion.function of the surface's material moves vertices with.
	VertexMove read_move(const ShadowSurface &p_surface, const godot::Material &p_material,
			const VertexSource &p_source) {
		return values.read(p_surface.motion.function,
				godot::cast<godot::ShaderMaterial>(p_material), p_source);
	}
	/// Removes cached data of freed resources. Call once per frame.
	void forget_unused();

private:
	struct Entry {
		std::unique_ptr<WatchedResource> watched;
		ShaderText text{ "" };
		ShadowSurface surface; // without the alpha mask, which depends on the material
	};
	ShadowSurface read_now(const godot::Material &p_material);
	const Entry &read_shader(const godot::Shader &p_shader);

	std::map<uint64_t, Entry> shaders; // by the resource's id
	CutOutMaterials cut_outs;
	VertexValues values;
	std::map<uint64_t, ShadowSurface> of_frame; // by the material's id
};

/// Returns how a surface with this shader casts, by the built-ins and render modes in its code.
ShadowKind find_shadow_kind(const ShaderText &p_shader);

} // namespace gnomon
