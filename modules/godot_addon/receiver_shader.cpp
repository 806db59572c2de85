#include "modules/godot_addon/receiver_shader.h"

#include "modules/core/text.h"
#include "modules/godot_addon/shader_text.h"
#include "modules/godot_addon/shadow_materials.h"

#include <receiver_text.gen.h>

namespace gnomon {

namespace {

struct UnsupportedFeature {
	const char *word; // identifier in the code
	const char *reason;
};

// Features that light() cannot reproduce: they have no published formula, or light() cannot read
// their values.
const UnsupportedFeature UNSUPPORTED_FEATURES[] = {
	{ "vertex_lighting", "is lit at its vertices" },
	{ "diffuse_toon", "has toon shading" },
	{ "specular_toon", "has toon shading" },
	{ "RIM", "has a rim" },
	{ "CLEARCOAT", "has a clear coat" },
	{ "ANISOTROPY", "is anisotropic" },
	{ "BACKLIGHT", "is lit from behind" },
	{ "SSS_STRENGTH", "has subsurface scattering" },
};

const char ATTENUATION[] = "gnomon_get_attenuation"; // function in gnomon.gdshaderinc

std::string find_unpatched_reason(const ShaderText &p_shader, bool p_is_generated) {
	if (p_shader.find_function("light")) {
		return "has a shader with a light() of its own, see addons/gnomon/gnomon.gdshaderinc";
	}
	if (p_shader.has_word(ATTENUATION)) {
		return "includes gnomon.gdshaderinc without a light() that uses it";
	}
	for (const UnsupportedFeature &feature : UNSUPPORTED_FEATURES) {
		if (p_shader.has_word(feature.word)) {
			return feature.reason;
		}
	}
	if (const VertexMotion motion = read_vertex_motion(p_shader);
			!p_is_generated && !motion.unknown_reason.empty()) {
		return motion.unknown_reason;
	}
	if (find_shadow_kind(p_shader) == ShadowKind::NONE) {
		return "is transparent or drawn without depth";
	}
	const ShaderFunction *fragment = p_shader.find_function("fragment");
	if (fragment && p_shader.has_word(*fragment, "return")) {
		return "has a shader whose fragment() returns early";
	}
	return {};
}

std::string make_constants(const ShaderText &p_shader) {
	const char *diffuse = p_shader.has_word("diffuse_lambert_wrap") ? "WRAP"
			: p_shader.has_word("diffuse_burley")					? "BURLEY"
																	: "LAMBERT";
	return text("const int GNOMON_DIFFUSE = GNOMON_DIFFUSE_", diffuse, ";\n",
			"const bool GNOMON_HAS_SPECULAR = ",
			p_shader.has_word("specular_disabled") ? "false" : "true", ";\n");
}

std::string patch(const ShaderText &p_shader) {
	// What fragment() and light() use must be declared before them.
	const std::string &code = p_shader.get_code();
	const size_t declaration_offset =
			p_shader.get_functions().empty() ? code.size() : p_shader.get_functions()[0].begin;
	const ShaderFunction *fragment = p_shader.find_function("fragment");
	const size_t fragment_end = fragment ? fragment->body_end : code.size();
	const std::string end = text("\t", RECEIVER_FRAGMENT);
	return text(code.substr(0, declaration_offset), RECEIVER_DECLARATIONS, make_constants(p_shader),
			RECEIVER_FUNCTIONS, code.substr(declaration_offset, fragment_end - declaration_offset),
			fragment ? end : text("\nvoid fragment() {\n", end, "}\n"), code.substr(fragment_end),
			"\n", RECEIVER_LIGHT);
}

} // namespace

ReceiverShader make_receiver_shader(const std::string &p_code, bool p_is_generated) {
	const ShaderText shader(p_code);
	ReceiverShader receiver;
	if (!shader.has_word("spatial") || shader.has_word("unshaded") ||
			shader.has_word("shadows_disabled")) {
		receiver.kind = ReceiverKind::UNLIT;
	} else if (const ShaderFunction *light = shader.find_function("light");
			   light && shader.has_word(*light, ATTENUATION)) {
		receiver.kind = ReceiverKind::OWN;
	} else {
		receiver.reason = find_unpatched_reason(shader, p_is_generated);
		if (receiver.reason.empty()) {
			receiver.kind = ReceiverKind::PATCHED;
			receiver.code = patch(shader);
		}
	}
	return receiver;
}

} // namespace gnomon
