#include "modules/godot_addon/shadow_materials.h"

#include <cctype>
#include <set>

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

/// Its identifiers, without comments.
std::set<std::string> find_words(const std::string &p_code) {
	std::set<std::string> words;
	std::string word;
	for (size_t index = 0; index <= p_code.size(); ++index) {
		if (p_code.compare(index, 2, "//") == 0) {
			index = std::min(p_code.find('\n', index), p_code.size());
		} else if (p_code.compare(index, 2, "/*") == 0) {
			const size_t end = p_code.find("*/", index + 2);
			index = end == std::string::npos ? p_code.size() : end + 1;
		} else if (index < p_code.size() &&
				(std::isalnum(static_cast<unsigned char>(p_code[index])) != 0 ||
						p_code[index] == '_')) {
			word += p_code[index];
			continue;
		}
		words.insert(std::exchange(word, {}));
	}
	return words;
}

} // namespace

ShadowKind find_shadow_kind(const std::string &p_shader_code) {
	const std::set<std::string> words = find_words(p_shader_code);
	for (const char *word : { "depth_draw_never", "depth_test_disabled", "blend_add", "blend_sub",
				 "blend_mul", "blend_premul_alpha" }) {
		if (words.contains(word)) {
			return ShadowKind::NONE;
		}
	}
	if (words.contains("ALPHA_SCISSOR_THRESHOLD") || words.contains("ALPHA_HASH_SCALE") ||
			(words.contains("ALPHA") && words.contains("depth_prepass_alpha"))) {
		return ShadowKind::CUT_OUT;
	}
	return words.contains("ALPHA") ? ShadowKind::NONE : ShadowKind::OPAQUE;
}

ShadowKind ShadowMaterials::read(const godot::Material &p_material) {
	if (const auto base = godot::cast<godot::BaseMaterial3D>(p_material)) {
		return read_base_material(base);
	}
	if (const auto custom = godot::cast<godot::ShaderMaterial>(p_material)) {
		const godot::Ref<godot::Shader> shader = custom.get_shader();
		return shader ? read_shader(shader) : ShadowKind::OPAQUE;
	}
	return ShadowKind::OPAQUE;
}

ShadowKind ShadowMaterials::read_shader(const godot::Shader &p_shader) {
	Entry &entry = shaders[godot::get_instance_id(p_shader.get_owner())];
	const bool is_new = !entry.watched;
	if (is_new) {
		entry.watched = std::make_unique<WatchedResource>(p_shader);
	}
	if (entry.watched->take_change() || is_new) {
		entry.kind = find_shadow_kind(p_shader.get_code().to_utf8());
	}
	return entry.kind;
}

void ShadowMaterials::forget_unused() {
	std::erase_if(shaders, [](const auto &p_entry) { return !p_entry.second.watched->is_alive(); });
}

} // namespace gnomon
