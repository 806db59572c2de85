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

ShadowCulling read_culling(const godot::BaseMaterial3D &p_material) {
	switch (p_material.get_cull_mode()) {
		case godot::BaseMaterial3D::CULL_BACK:
			return ShadowCulling::BACK;
		case godot::BaseMaterial3D::CULL_FRONT:
			return ShadowCulling::FRONT;
		default:
			return ShadowCulling::NONE;
	}
}

ShadowCulling read_culling(const ShaderText &p_shader) {
	return p_shader.has_word("cull_disabled") ? ShadowCulling::NONE
			: p_shader.has_word("cull_front") ? ShadowCulling::FRONT
											  : ShadowCulling::BACK;
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
	return p_shader.has_word("ALPHA")	   ? ShadowKind::NONE
			: p_shader.has_word("discard") ? ShadowKind::CUT_OUT
										   : ShadowKind::OPAQUE;
}

/// A material is read once per frame, however many instances it is on.
const ShadowSurface &ShadowMaterials::read(const godot::Material &p_material) {
	const auto [found, is_new] =
			of_frame.try_emplace(godot::get_instance_id(p_material.get_object()));
	if (is_new) {
		found->second = read_now(p_material);
	}
	return found->second;
}

ShadowSurface ShadowMaterials::read_now(const godot::Material &p_material) {
	ShadowSurface surface;
	if (const auto base = godot::cast<godot::BaseMaterial3D>(p_material)) {
		surface.kind = read_base_material(base);
		surface.cut_out = surface.kind == ShadowKind::CUT_OUT ? cut_outs.read(base) : nullptr;
		surface.motion = read_vertex_motion(base);
		surface.culling = read_culling(base);
	} else if (const auto custom = godot::cast<godot::ShaderMaterial>(p_material)) {
		if (const godot::Ref<godot::Shader> shader = custom.get_shader()) {
			const Entry &entry = read_shader(shader);
			surface = entry.surface;
			if (surface.kind == ShadowKind::CUT_OUT) {
				surface.cut_out = cut_outs.read(custom, entry.text);
			}
		}
	}
	if (surface.kind == ShadowKind::CUT_OUT && !surface.cut_out &&
			surface.motion.unknown_reason.empty()) {
		surface.motion.unknown_reason = "is cut out by alpha in a way that is not read";
	}
	return surface;
}

const ShadowMaterials::Entry &ShadowMaterials::read_shader(const godot::Shader &p_shader) {
	Entry &entry = shaders[godot::get_instance_id(p_shader.get_object())];
	const bool is_new = !entry.watched;
	if (is_new) {
		entry.watched = std::make_unique<WatchedResource>(p_shader);
	}
	if (entry.watched->take_change() || is_new) {
		// The RenderingServer's code has the text of #includes.
		const godot::RenderingServer server(godot::find_singleton("RenderingServer"));
		entry.text = ShaderText(server.shader_get_code(p_shader.get_rid()).to_utf8());
		entry.surface = { find_shadow_kind(entry.text), /*cut_out=*/nullptr,
			read_vertex_motion(entry.text), read_culling(entry.text) };
	}
	return entry;
}

void ShadowMaterials::forget_unused() {
	of_frame.clear();
	cut_outs.forget_unused();
	values.forget_unused();
	std::erase_if(shaders, [](const auto &p_entry) { return !p_entry.second.watched->is_alive(); });
}

} // namespace gnomon
