#include "modules/godot_addon/shadow_materials.h"

namespace gnomon {

namespace {

ShadowKind read_base_material(const godot::BaseMaterial3D &p_material) {
	using godot::BaseMaterial3D;
	if (p_material.get_depth_draw_mode() == BaseMaterial3D::DEPTH_DRAW_DISABLED ||
			p_material.get_flag(BaseMaterial3D::FLAG_DISABLE_DEPTH_TEST) ||
			p_material.get_blend_mode() != BaseMaterial3D::BLEND_MODE_MIX) {
		return ShadowKind::NONE;
	}
	switch (p_material.get_transparency()) {
		case BaseMaterial3D::TRANSPARENCY_DISABLED:
			return ShadowKind::OPAQUE;
		case BaseMaterial3D::TRANSPARENCY_ALPHA:
			return ShadowKind::NONE;
		default:
			return ShadowKind::CUT_OUT;
	}
}

} // namespace

ShadowKind find_shadow_kind(const ShaderText &p_shader) {
	for (const char *word : { "depth_draw_never", "depth_test_disabled", "blend_add", "blend_sub",
				 "blend_mul", "blend_premul_alpha" }) {
		if (p_shader.has_word(word)) {
			return ShadowKind::NONE;
		}
	}
	if (p_shader.has_word("ALPHA_SCISSOR_THRESHOLD") || p_shader.has_word("ALPHA_HASH_SCALE") ||
			(p_shader.has_word("ALPHA") && p_shader.has_word("depth_prepass_alpha"))) {
		return ShadowKind::CUT_OUT;
	}
	return p_shader.has_word("ALPHA") ? ShadowKind::NONE : ShadowKind::OPAQUE;
}

ShadowSurface ShadowMaterials::read(const godot::Material &p_material) {
	ShadowSurface surface;
	if (const auto base = godot::cast<godot::BaseMaterial3D>(p_material)) {
		surface.kind = read_base_material(base);
		surface.cut_out = surface.kind == ShadowKind::CUT_OUT ? cut_outs.read(base) : nullptr;
		surface.motion = read_vertex_motion(base);
	} else if (const auto custom = godot::cast<godot::ShaderMaterial>(p_material)) {
		if (const godot::Ref<godot::Shader> shader = custom.get_shader()) {
			surface = read_shader(shader);
		}
	}
	return surface;
}

const ShadowSurface &ShadowMaterials::read_shader(const godot::Shader &p_shader) {
	Entry &entry = shaders[godot::get_instance_id(p_shader.get_object())];
	const bool is_new = !entry.watched;
	if (is_new) {
		entry.watched = std::make_unique<WatchedResource>(p_shader);
	}
	if (entry.watched->take_change() || is_new) {
		// The RenderingServer's code has the text of #includes.
		const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
		const ShaderText text(server.shader_get_code(p_shader.get_rid()).to_utf8());
		// The alpha that a shader computes cannot be read.
		entry.surface = { find_shadow_kind(text), /*cut_out=*/nullptr, read_vertex_motion(text) };
	}
	return entry.surface;
}

void ShadowMaterials::forget_unused() {
	cut_outs.forget_unused();
	std::erase_if(shaders, [](const auto &p_entry) { return !p_entry.second.watched->is_alive(); });
}

} // namespace gnomon
